/** Both surfaces of an estimator as a panel. */

import type { Estimator } from "../../../pkg/index.js";
import type { CloudPanel } from "../protocol";

/** Largest number of points that are drawn of each surface. */
const MOST_POINTS = 2500;

function thinned(points: Float32Array): Float32Array {
  const every = Math.max(1, Math.ceil(points.length / 3 / MOST_POINTS));
  return every === 1 ? points : points.filter((_, index) => Math.floor(index / 3) % every === 0);
}

export const cloudsOf = (estimator: Estimator): CloudPanel => ({
  kind: "cloud",
  key: "clouds",
  title: "Both surfaces",
  alt: "Points of the depth map in the estimated pose, and points of the surface recovered from the picture. Under the right pose they coincide.",
  sets: [
    { name: "picture", ink: "normal", points: thinned(estimator.points("image")) },
    { name: "depth map", ink: "pose", points: thinned(estimator.points("depth")) },
  ],
});
