// Compares normals and depth with the truth of a rendered scene.
import { chance, mean, median, rms } from "./numbers.mjs";
import { angleBetween, degreesBetween } from "./rotations.mjs";
import { requestOf } from "./scenes.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";

/** A distance beyond any in a view, so that a given prior applies however wrong the surface still is. */
const ANYWHERE = 1e6;

/** Root mean square depth error, up to a constant that parallel rays do not determine. */
export function depthRmse(found, truth) {
  const off = [...truth.keys()].map((index) => found[index] - truth[index]).filter(Number.isFinite);
  const middle = median(off);
  return rms(off.map((value) => value - middle));
}

/** Mean angle between two fields of normals where both have one. */
export function normalDegrees(found, truth, counts = () => true) {
  const angles = [];
  for (let index = 0; index < truth.length / 3; index++) {
    if (!counts(index)) continue;
    const [a, b] = [found, truth].map((normals) => normals.subarray(3 * index, 3 * index + 3));
    if (Number.isFinite(a[2]) && Number.isFinite(b[2])) angles.push(angleBetween(a, b));
  }
  return mean(angles);
}

export async function measureIterations(cell, { sample, Estimator }, library) {
  const made = sample(requestOf(cell.scene, library));
  const estimator = new Estimator(made.image, made.depth, optionsOf(cell.options, made));
  const iterations = [];
  try {
    let { report } = estimator;
    while (report.status === "running") {
      report = estimator.step();
      // Only iterations count, not slices of the search.
      if (report.iteration === (iterations.at(-1)?.iteration ?? 0)) continue;
      iterations.push({
        iteration: report.iteration,
        depthRmse: depthRmse(estimator.imageDepth(), made.truth.imageDepth),
        degrees: degreesBetween(report.pose.rotation, made.pose.rotation),
      });
    }
    return { iterations, status: report.status };
  } finally {
    estimator.free();
  }
}

/** Chooses pixels at random in an order that does not depend on the share, so that a larger share contains a smaller one. */
export function chosenPixels(mask, share, seed) {
  const dice = chance(seed);
  const order = [...mask.keys()].filter((index) => mask[index]).map((index) => [dice.uniform(), index]);
  order.sort(([a], [b]) => a - b);
  const chosen = new Uint8Array(mask.length);
  for (const [, index] of order.slice(0, Math.round(share * order.length))) chosen[index] = 255;
  return chosen;
}

/** Figure 5: the depth view gets the true normals in some pixels; the pose is known and fixed. */
export async function measureShading(cell, api, library) {
  const made = api.sample(requestOf(cell.scene, library));
  // A depth map without pixels is refused; with a share of zero, the prior's weight is zero instead.
  const none = cell.fraction === 0;
  const mask = none ? made.depth.mask : chosenPixels(made.depth.mask, cell.fraction, cell.scene.seed);
  const depth = { ...made.depth, mask, normals: made.truth.depthNormals };
  const options = {
    ...optionsOf({ ...cell.options, start: "truth" }, made),
    ...(none ? { lambda: { prior: 0 } } : {}),
    correspondenceDistance: ANYWHERE,
    // Trimming is off, because it would remove single pixels.
    trim: false,
  };
  return withRun(api, { image: made.image, depth }, options, (report, estimator, milliseconds) => ({
    degrees: normalDegrees(estimator.imageNormals(), made.truth.imageNormals),
    depthRmse: depthRmse(estimator.imageDepth(), made.truth.imageDepth),
    iterations: report.iteration,
    status: report.status,
    milliseconds,
  }));
}

export async function measureRefinement(cell, api, library) {
  const made = api.sample(requestOf(cell.scene, library));
  const given = made.depth.data;
  const inside = [...made.depth.mask.keys()].filter((index) => made.depth.mask[index]);
  const measured = inside.filter((index) => Number.isFinite(given[index]));
  const lost = inside.filter((index) => !Number.isFinite(given[index]));
  const error = (depth, pixels) =>
    rms(pixels.map((index) => depth[index] - made.truth.depth[index]).filter(Number.isFinite));
  return withRun(api, made, optionsOf(cell.options, made), (report, estimator, milliseconds) => {
    const refined = estimator.refinedDepth();
    return {
      before: error(given, measured),
      after: error(refined, measured),
      holes: error(refined, lost),
      unfilled: lost.filter((index) => !Number.isFinite(refined[index])).length,
      ...judged(report, made.pose, milliseconds),
    };
  });
}
