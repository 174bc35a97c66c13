// Verdicts on the makers' calibrations of registered captures, and on calibrations with a known error.
import { chance, mahalanobis, offset, sizes, wrong } from "../rigs/draws.mjs";
import { restarts } from "../rigs/restarts.mjs";
import { hidden, seedOf } from "./draws.mjs";
import { checkFrame, nyu, registered } from "./read.mjs";

const OFF = [
  { degrees: 5, millimetres: 0 },
  { degrees: 0, millimetres: 20 },
  { degrees: 1, millimetres: 0 },
];
/** A candidate that comes first, so that the prior is not centred on the truth. */
const FIRST = { degrees: 3, millimetres: 20 };
/** The 95 % quantile of chi-squared with six degrees of freedom. */
const INSIDE = 12.59;
const nameOf = ({ degrees, millimetres }) => (degrees > 0 ? `${degrees} deg` : `${millimetres} mm`);
const count = (rows, test) => `${rows.filter(test).length} of ${rows.length}`;
/** Constants were chosen on every second capture, not on the others. */
const halfOf = (index) => (index % 2 === 0 ? "tuning" : "held-out");
const captures = (files) => [nyu(files), ...registered(files)].map((frame, index) => ({ frame, half: halfOf(index) }));

async function judged(check, behind, random, first) {
  const { truth } = behind;
  const rivals = Object.fromEntries(OFF.map((error) => [nameOf(error), wrong(truth, error, random.direction)]));
  const report = await check([checkFrame(behind)], { ...(first && { first }), truth, ...rivals });
  const off = offset(report.estimate, truth, report.middle);
  const verdicts = Object.entries(report.candidates).map(([name, { verdict }]) => [name, verdict]);
  return {
    ...sizes(off),
    isInside: mahalanobis(report.covariance, off) <= INSIDE,
    isLikely: report.candidates.truth.probability >= 0.05,
    verdicts: Object.fromEntries(verdicts),
  };
}

/** Each capture behind hidden motions. The makers' calibration is once the candidate that is checked and once another one. */
export async function truths({ check, files, number, progress }) {
  const rows = [];
  for (const { frame, half } of captures(files)) {
    for (let draw = 0; draw < Math.ceil(number / 10); draw++) {
      const random = chance(seedOf(`${frame.name} truth`, draw));
      const [behind] = hidden([frame], random).frames;
      const first = wrong(behind.truth, FIRST, random.direction);
      const row = { name: frame.name, half, draw };
      rows.push({ ...row, about: "checked", ...(await judged(check, behind, random)) });
      rows.push({
        ...row,
        about: "beside a first one off by 3 deg, 20 mm",
        ...(await judged(check, behind, random, first)),
      });
    }
    progress(frame.name);
  }
  return rows;
}

export function printTruths(rows) {
  console.log("\nregistered captures and nyu_raw_pair, the makers' calibration hidden behind 10 degrees and 100 mm");
  for (const about of new Set(rows.map((row) => row.about))) {
    for (const half of ["tuning", "held-out"]) {
      const some = rows.filter((row) => row.about === about && row.half === half);
      const said = (name, verdict) => count(some, ({ verdicts }) => verdicts[name] === verdict);
      console.log(
        `  ${about}, ${half} half: "off" in ${said("truth", "off")}, "consistent" in ${said("truth", "consistent")}; inside 95 % in ${count(some, ({ isInside }) => isInside)} by the covariance, in ${count(some, ({ isLikely }) => isLikely)} by the distribution`,
      );
      console.log(
        `  .. calibrations that are off, called so: ${OFF.map(nameOf)
          .map((name) => `${name} ${said(name, "off")}`)
          .join(", ")}`,
      );
    }
  }
}

/** Each capture checked from ten candidates, half as many as `number`. */
export async function capturesAnew({ check, files, number, progress }) {
  const scenes = [];
  for (const { frame, half } of captures(files)) {
    const random = chance(seedOf(`${frame.name} restarts`, 0));
    const [behind] = hidden([frame], random).frames;
    const options = { number: Math.ceil(number / 2), random };
    scenes.push({
      name: `${frame.name} (${half})`,
      runs: await restarts(check, [checkFrame(behind)], behind.truth, options),
    });
    progress(`${frame.name}: restarts`);
  }
  return scenes;
}
