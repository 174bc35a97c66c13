/** Single parts of the method, for inspection; the lessons use them. */
import { type Check, array, flag, numbers, object, ranged } from "./check.js";
import { across } from "./border.js";
import { bindings } from "./engine.js";
import type { PixelLandscape, PixelLandscapeRequest } from "./types/index.js";

const light = numbers(27);
/** The largest logarithm of a colour or coordinate of a normal; the squares of larger numbers carry no information. */
const part = ranged({ kind: "number", min: -1e6, max: 1e6 });
const three: Check = (value, field) => {
  numbers(3)(value, field);
  for (const [index, one] of Array.from(value as ArrayLike<number>).entries()) part(one, `${field}[${index}]`);
};
const side = ranged({ kind: "side", min: 1, max: 4096 });
const weight = ranged({ kind: "number", min: 0 });
const normals = array(Float32Array);
const landscape = object(
  {
    log: three,
    light,
    prior: three,
    weight,
    robust: flag,
    start: three,
    side: ranged({ kind: "side", min: 0, max: 512 }),
  },
  ["log", "light"],
);

/** From x, y, z of each normal to all x, then all y, then all z, which is the order of the numerics. */
function planes(interleaved: Float32Array): Float32Array {
  normals(interleaved, "normals");
  const count = Math.floor(interleaved.length / 3);
  return new Float32Array(3 * count).map((_, at) => interleaved[3 * (at % count) + Math.floor(at / count)] ?? NaN);
}

/**
 * Depth, in pixels, of the surface with these normals (3*w*h interleaved, NaN where missing) seen by an orthographic camera: the
 * least-squares solution, or with `robust` one in which slopes across a discontinuity are ignored. Mean zero in each connected part.
 */
export function integrateNormals(
  unitNormals: Float32Array,
  width: number,
  height: number,
  robust = true,
): Float32Array {
  side(width, "width");
  side(height, "height");
  flag(robust, "robust");
  return across(() => bindings().integrateNormals(planes(unitNormals), width, height, robust));
}

const NONE = [NaN, NaN, NaN];
const FACING = [0, 0, -1];

/** The objective of one pixel over all normals that a camera can see, its minima, and the steps of one descent. */
export function pixelLandscape(request: PixelLandscapeRequest): PixelLandscape {
  landscape(request, "landscape");
  const { log, prior = NONE, start = FACING, weight = 0, robust = true, side = 96 } = request;
  const row = Float64Array.of(...[log, prior, start].flatMap((vector) => Array.from(vector)), weight);
  const [objective, minima, path] = across(() =>
    bindings().pixelLandscape(Float64Array.from(request.light), row, robust, side),
  );
  return { objective, minima, path };
}
