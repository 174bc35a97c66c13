// The share of wrong candidates that rank worse than the data set's calibration: by the check's distance from its estimate, and by the costs
// of other tools (scripts/captures/costs.mjs), here with the LiDAR's intensities as in the paper of the information distance.
import { costs } from "../captures/costs.mjs";
import { beats, seedOf } from "../captures/draws.mjs";
import { chance, mahalanobis, offset, poseOf, wrong } from "../rigs/draws.mjs";
import { IDENTITY } from "../../protocols/rotations.mjs";
import { say } from "../shell.mjs";

/** Initial pose of the check, on which its prior is centred. */
const START = { degrees: 2, millimetres: 100 };
const RIVALS = [
  { degrees: 0.5, millimetres: 0 },
  { degrees: 1, millimetres: 0 },
  { degrees: 2, millimetres: 0 },
  { degrees: 5, millimetres: 0 },
  { degrees: 0, millimetres: 50 },
  { degrees: 0, millimetres: 100 },
  { degrees: 0, millimetres: 200 },
];
const MEASURES = {
  distance: "the check, distance from the estimate",
  information: "normalised information distance (Koide et al. 2023)",
  edges: "edge alignment (Levinson and Thrun 2013, Canny)",
};
const called = ({ degrees, millimetres }) => (degrees > 0 ? `${degrees} deg` : `${millimetres} mm`);

/** One row for each of `count` wrong candidates of each size. A measure is 1 if it ranks the wrong candidate worse, and 0.5 for a tie. */
export async function ranked(check, { frame, image, range }, count) {
  if (count === 0) return [];
  const random = chance(seedOf(`${frame.name} ranks`, 0));
  const truth = poseOf(frame.rotation, frame.translation);
  const { width, height, points, intensity } = range;
  const view = {
    image: { ...image, camera: frame.camera },
    depth: { width, height, points, ...(intensity && { intensity }) },
  };
  const report = await check([view], { told: wrong(truth, START, random.direction) });
  // The points are in the scanner's frame, so that the scanner is at its origin.
  const theirs = costs({ image: view.image, grid: { width, height }, points, intensity }, poseOf(IDENTITY, [0, 0, 0]));
  const measures = {
    distance: (pose) => mahalanobis(report.covariance, offset(report.estimate, pose, report.middle)),
    information: theirs.information,
    edges: theirs.edges,
  };
  const right = Object.fromEntries(Object.entries(measures).map(([name, of]) => [name, of(truth)]));
  return RIVALS.flatMap((error) =>
    Array.from({ length: count }, () => {
      const pose = wrong(truth, error, random.direction);
      const of = Object.entries(measures).map(([name, value]) => [name, beats(right[name], value(pose))]);
      return { frame: frame.name, error: called(error), ...Object.fromEntries(of) };
    }),
  );
}

/** The shares, one line for each measure. */
export function printRanked(rows) {
  if (rows.length === 0) return;
  const columns = RIVALS.map(called);
  say(`Wrong candidates that rank worse than the data set's calibration, per cent: ${columns.join(", ")}`);
  for (const [name, words] of Object.entries(MEASURES)) {
    const shares = columns.map((error) => {
      const some = rows.filter((row) => row.error === error);
      return Math.round((100 * some.reduce((sum, row) => sum + row[name], 0)) / some.length);
    });
    say(`  ${words}: ${shares.join(", ")}`);
  }
}
