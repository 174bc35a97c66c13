/** The best fit in words, and whether it may be offered for use. */

import { decimals } from "../draw/numbers";
import { degreesOf, inverse, poseOf, times } from "./poses";
import type { Run } from "./rig";
import { placeInWords } from "./words";

/** The place of the depth camera in the best fit, the overlap, and the distance of the checked calibration's camera from that place. */
export function placement({ report: { estimate, overlap }, candidates, estimateOnly, isLidar }: Run): string {
  const found = `Best fit: ${placeInWords(estimate, isLidar)} It puts ${(100 * overlap).toFixed(0)} % of the depth points onto the image.`;
  const [[name, given] = []] = Object.entries(candidates);
  if (estimateOnly || !given) return found;
  const shift = given.translation.map((metres, axis) => metres - (estimate.translation[axis] ?? 0));
  const turn = degreesOf(poseOf(times(given.rotation, inverse(estimate).rotation), shift));
  return `${found} “${name}” puts it ${decimals(1000 * Math.hypot(...shift), 1)} mm from there, rotated by ${decimals(turn, 2)}°.`;
}

/** Candidates' codes for which the best fit covers too little of the depth map to be reliable. */
const UNFIT: readonly string[] = ["little-overlap", "no-pose-on-image"];

export const isUsable = ({ report }: Run): boolean =>
  !Object.values(report.candidates).some(({ code }) => UNFIT.includes(code));

/** Whether the error of the best fit may exceed the largest one that passes, so that it may be no better than what it would replace. */
export const isUncertain = ({ report }: Run): boolean => report.health.interval[1] > report.tolerance;

/** Whether the best fit may be saved. Beside a calibration it would be taken for a better one. */
export const isSaved = (run: Run): boolean => isUsable(run) && (run.estimateOnly || !isUncertain(run));
