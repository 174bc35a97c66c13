// Checks LiDAR frames with two kinds of candidates, the data set's calibration and poses with a known error, each with and without the
// intensities. The data set's calibration counts as true. All draws but the first keep three fifths of the range image's columns,
// starting at a random one.
import { mahalanobis, offset, chance, poseOf, quantile, sizes, wrong } from "../rigs/draws.mjs";
import { seedOf } from "../captures/draws.mjs";
import { say } from "../shell.mjs";

const ERRORS = {
  right: { degrees: 0, millimetres: 0 },
  "1 deg + 100 mm": { degrees: 1, millimetres: 100 },
  "5 deg": { degrees: 5, millimetres: 0 },
};
const KEPT = 0.6;
/** The 95 % quantile of chi-squared with six degrees of freedom. */
const INSIDE = 12.59;

/** The points of some columns of a range image; the others become empty. */
function cut({ points, width }, share) {
  const first = Math.floor(share * (1 - KEPT) * width);
  return points.map((value, at) => {
    const column = Math.floor(at / 3) % width;
    return column >= first && column < first + KEPT * width ? value : NaN;
  });
}

/** Rows of all draws of one frame, each once for every set of intensities. */
export async function drawn(check, { frame, image, range }, count) {
  const truth = poseOf(frame.rotation, frame.translation);
  const rows = [];
  for (const [error, size] of Object.entries(ERRORS))
    for (let draw = 0; draw < count; draw++) {
      const random = chance(seedOf(`${frame.name} ${error}`, draw));
      const told = error === "right" ? truth : wrong(truth, size, random.direction);
      const points = draw === 0 ? range.points : cut(range, random.uniform());
      for (const intensity of [undefined, range.intensity]) {
        const depth = { width: range.width, height: range.height, points, ...(intensity && { intensity }) };
        const report = await check([{ image: { ...image, camera: frame.camera }, depth }], { told });
        const off = offset(report.estimate, truth, report.middle);
        rows.push({
          frame: frame.name,
          error,
          draw,
          intensity: intensity !== undefined,
          verdict: report.verdict,
          ...sizes(off),
          isInside: mahalanobis(report.covariance, off) < INSIDE,
        });
      }
    }
  return rows;
}

/** The shares of candidates that were "off" and of calibrations inside 95 %, and the error of the estimates. */
export function printDrawn(rows) {
  for (const error of Object.keys(ERRORS))
    for (const intensity of [false, true]) {
      const some = rows.filter((row) => row.error === error && row.intensity === intensity);
      if (some.length === 0) continue;
      const counted = (is) => `${some.filter(is).length} of ${some.length}`;
      const at = (name) =>
        quantile(
          some.map((row) => row[name]),
          0.5,
        );
      say(
        `${error}, ${intensity ? "with" : "without"} intensities: "off" in ${counted(({ verdict }) => verdict === "off")}, inside 95 % in ${counted(({ isInside }) => isInside)}, error ${at("degrees").toFixed(2)} degrees and ${at("millimetres").toFixed(0)} mm`,
      );
    }
}
