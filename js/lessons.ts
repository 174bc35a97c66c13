/** Single parts of the method, for inspection; the lessons use them. */
import { type Check, array, flag, numbers, object, ranged } from "./check.js";
import { across } from "./border.js";
import { bindings } from "./engine.js";
import { BimodalError } from "./errors.js";
import { checkNormals } from "./inputs.js";
import type { BasRelief, PixelLandscape, PixelLandscapeRequest, StripsRequest } from "./types/index.js";

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

/** Largest slope and stretch of a depth; beyond them no shape is visible. */
const factor = ranged({ kind: "number", min: -1e3, max: 1e3 });
const values = array(Float32Array);
const strips = object(
  {
    intensity: values,
    width: side,
    height: side,
    lamp: three,
    centre: numbers(2),
    dent: flag,
    count: ranged({ kind: "side", min: 0, max: 360 }),
  },
  ["intensity", "width", "height", "lamp", "centre"],
);

/** From x, y, z of each normal to all x, then all y, then all z, which is the order of the numerics. */
function planes(interleaved: Float32Array): Float32Array {
  normals(interleaved, "normals");
  const count = Math.floor(interleaved.length / 3);
  return new Float32Array(3 * count).map((_, at) => interleaved[3 * (at % count) + Math.floor(at / count)] ?? NaN);
}

/**
 * Depth, in pixels, of the surface with these normals (3*w*h interleaved, NaN where missing), seen by an orthographic camera. It is the
 * least-squares solution; `robust` ignores slopes across discontinuities. Each connected part has mean zero.
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

/**
 * Intensity of a matte surface of albedo 1 under one distant lamp, for each unit normal (x, y, z in turn). It is the cosine between the
 * normal and the direction to the lamp, times the length of `lamp`, and zero where the surface faces away. Toward the camera is -z.
 */
export function shadeLamp(lamp: ArrayLike<number>, unitNormals: Float32Array): Float32Array {
  three(lamp, "lamp");
  checkNormals(unitNormals);
  return across(() => bindings().shadeLamp(Float64Array.from(lamp), unitNormals));
}

/**
 * The generalised bas-relief transformation: the depth z becomes `stretch` z + `right` x + `down` y. Returns the new normals, the factor of
 * each albedo and the lamp with which the new surface has the intensity of the old one.
 */
export function basRelief(
  unitNormals: Float32Array,
  lamp: ArrayLike<number>,
  stretch: number,
  right = 0,
  down = 0,
): BasRelief {
  checkNormals(unitNormals);
  three(lamp, "lamp");
  for (const [name, value] of Object.entries({ stretch, right, down })) factor(value, name);
  if (stretch === 0) throw new BimodalError("range", "stretch: must not be zero, which leaves no shape", "stretch");
  const [normals, albedo, moved] = across(() =>
    bindings().basRelief(stretch, right, down, Float64Array.from(lamp), unitNormals),
  );
  return { normals, albedo, lamp: moved };
}

/**
 * The approximation by harmonics of orders 0 to 2 of an intensity that depends on one component of the normal only, by least squares over
 * the sphere. Values and result belong to the middles of equal intervals of that component from -1 to 1.
 */
export function secondOrder(intensity: Float32Array): Float32Array {
  values(intensity, "intensity");
  return across(() => bindings().secondOrder(intensity));
}

/**
 * Characteristic strips of a picture of albedo 1 under one lamp of length 1 (Horn 1970), from a bright spot outward: column, row and depth of
 * each point in pixels, with three NaN after each strip.
 */
export function characteristicStrips(request: StripsRequest): Float32Array {
  strips(request, "strips");
  const { intensity, width, height, lamp, centre, dent = false, count = 24 } = request;
  const [toward, spot] = [lamp, centre].map((numbers) => Float64Array.from(numbers)) as [Float64Array, Float64Array];
  return across(() => bindings().characteristicStrips(intensity, width, height, toward, spot, dent, count));
}
