/** A depth map from elsewhere: the paper's Figure 5, with the share of given normals as a slider. */

import type { Options } from "../../../pkg/index.js";
import type { Drawing, Values } from "../protocol";
import { alongRow, normalsOf, plot, scalarOf } from "./draw";
import { chosenPixels, depthRmse, meanOf, normalDegrees } from "./measure";
import { after, numberOf, scene } from "./scenes";

const SIZE = 64;
/** Larger than any distance in a view, so that a given prior counts however wrong the surface still is. */
const ANYWHERE = 1e6;
const SHARES = [0, 5, 10, 20, 35, 50, 75, 100];

function solved(values: Values, share: number) {
  const made = scene({
    surface: "bust",
    light: String(values.light),
    size: SIZE,
    angles: { beta: 0 },
    noise: 0.02,
    seed: 5,
  });
  // A depth map without a pixel is refused, so for no given pixels the weight of the prior is zero.
  const none = share === 0;
  const mask = none
    ? (made.depth.mask ?? new Uint8Array())
    : chosenPixels(made.depth.mask ?? new Uint8Array(), share / 100, 5);
  const depth = { ...made.depth, mask, normals: made.truth.depthNormals };
  const options: Options = {
    light: made.light,
    start: made.pose,
    registration: "fixed",
    shading: "pixel",
    lambda: { prior: none ? 0 : numberOf(values, "weight") },
    correspondenceDistance: ANYWHERE,
    trim: false,
  };
  const [normals, found] = after(
    { image: made.image, depth },
    options,
    2,
    (estimator) => [estimator.imageNormals(), estimator.imageDepth()] as const,
  );
  return {
    made,
    mask,
    none,
    normals,
    found,
    degrees: normalDegrees(normals, made.truth.imageNormals),
    others: normalDegrees(normals, made.truth.imageNormals, (index) => none || !mask[index]),
    depth: depthRmse(found, made.truth.imageDepth),
  };
}

export function* prior(values: Values): Generator<Drawing> {
  const share = numberOf(values, "share");
  const { made, mask, none, normals, found, degrees, others, depth } = solved(values, share);
  const grid = made.image;
  const given = made.truth.depthNormals.map((value, index) => (!none && mask[Math.floor(index / 3)] ? value : NaN));
  const centred = (map: Float32Array) => map.map((value) => value - meanOf(map));
  const row = Math.round(0.45 * grid.height);
  const curve: number[] = [];
  const drawing = (): Drawing => ({
    panels: [
      normalsOf(
        {
          key: "given",
          title: "Normals from the depth map",
          alt: "The prior: {share} percent of the pixels are given a normal.",
          details: { share },
          legend: "hatched: no normal given",
        },
        grid,
        given,
      ),
      normalsOf(
        { key: "found", title: "Estimated normals", alt: "Normals estimated from colours and prior." },
        grid,
        normals,
      ),
      scalarOf(
        {
          key: "depth",
          title: "Depth from these normals",
          alt: "The surface obtained by integrating them.",
          legend: "dark near, bright far",
        },
        grid,
        centred(found),
        { min: -14, max: 14 },
      ),
      plot(
        { key: "profile", title: "A section through the face", alt: "Heights along one row: true and estimated." },
        "column, px",
        "height, px",
        [
          { name: "true", ink: "truth", points: alongRow(centred(made.truth.imageDepth), grid, row, -1) },
          { name: "found", ink: "normal", points: alongRow(centred(found), grid, row, -1) },
        ],
      ),
      plot(
        {
          key: "figure5",
          title: "Error against the share given (Figure 5)",
          alt: "Mean error of the normals against the share of pixels with a prior.",
        },
        "share, %",
        "error, °",
        [{ name: "normals", ink: "prior", points: [...curve], dots: true }],
        { at: share, domain: [0, 100], range: [0, 40] },
      ),
    ],
    numbers: { degrees, others, depth, pixels: none ? 0 : mask.filter(Boolean).length },
  });
  yield drawing();
  // Until a share is given, the rest of the curve would answer the question of the lesson.
  for (const each of share === 0 ? [0] : SHARES) {
    curve.push(each, each === share ? degrees : solved(values, each).degrees);
    yield drawing();
  }
}
