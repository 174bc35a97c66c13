// Checks the same frames from several first candidates. All decided verdicts have to agree.
import { mahalanobis, offset, percent, sizes, wrong } from "./draws.mjs";

/** Largest errors of the candidates. */
const WITHIN = { degrees: 10, millimetres: 100 };
/** The 95 % quantile of chi-squared with six degrees of freedom. */
const INSIDE = 12.59;

/** Whether a report states an estimate: one that found no pose which puts points onto the image states none. */
const isSure = ({ verdict, code }) => verdict !== "undecided" && code !== "no-pose-on-image";

/** Checks frames from candidates at random distances of their true pose; one row for each. */
export async function restarts(check, frames, truth, { number, random }) {
  const reports = [];
  for (let run = 0; run < number; run++) {
    const [degrees, millimetres] = [WITHIN.degrees, WITHIN.millimetres].map((most) => most * random.uniform());
    const candidate = wrong(truth, { degrees, millimetres }, random.direction);
    reports.push({ start: { degrees, millimetres }, ...(await check(frames, { candidate })) });
  }
  const sure = reports.filter(isSure);
  const holds = (one) => (other) =>
    mahalanobis(one.covariance, offset(other.estimate, one.estimate, one.middle)) <= INSIDE;
  return reports.map((report) => ({
    start: report.start,
    verdict: report.verdict,
    code: report.code,
    ...sizes(offset(report.estimate, truth, report.middle)),
    agrees: !isSure(report) || sure.every(holds(report)),
  }));
}

/** The share of runs, and of scenes, in which all estimates of decided verdicts agree within their 95 %. */
export function printRestarts(scenes) {
  const rows = scenes.flatMap(({ runs }) => runs);
  const agreeing = ({ runs }) => runs.every(({ agrees }) => agrees);
  for (const { name, runs } of scenes.filter((scene) => !agreeing(scene))) {
    const ends = runs
      .filter(isSure)
      .map(({ degrees, millimetres }) => `${degrees.toFixed(2)} deg ${millimetres.toFixed(1)} mm`);
    console.log(`  ${name}: decided verdicts end ${ends.join(", ")} from the truth`);
  }
  const is = (verdict) => rows.filter((row) => row.verdict === verdict).length;
  console.log(
    `Restarts: ${rows.length} runs in ${scenes.length} scenes; decided ${is("off") + is("consistent")}, undecided ${is("undecided")}`,
  );
  console.log(
    `  all estimates of decided verdicts within their 95 %: ${percent(rows.filter(({ agrees }) => agrees).length, rows.length)} of runs, ${percent(scenes.filter(agreeing).length, scenes.length)} of scenes (aim: 98 %)`,
  );
}
