// npm run answers: checks whether a refactoring gives the same answers as the code that it replaces.
//   --against FOLDER  compares every pixel with the package in the pkg/ of another checkout; by default with the committed figures
//   --write           writes new figures; empty scripts/answers/reasons.mjs afterwards
//   --scalar          uses the .wasm without SIMD, only with --against: it sums in another order, so the committed figures do not apply
//   --only WORDS      only scenes whose names contain these words
//   --built           uses pkg/ as it is, without building
//   --processes N     two by default; the answers do not depend on it
//
// Pairs and rigs (scripts/answers/scenes.mjs) go through the package's public contract: sizes 32 to 160, every surface, light, option,
// kind of input and way to drive the loop, one albedo and several, lost runs, every registration that a run can end with, and the check
// of a calibration. Two packages side by side are identical where no sum was reordered. They must agree on status, iterations, missing
// values and correspondences, on the pose within 1e-6 degrees, and on heights (pixels), normals, light and residuals within 1e-5
// (scripts/answers/compare.mjs has all limits). A reordered sum that moves a result further has a line in scripts/answers/reasons.mjs,
// up to 1e-3 degrees. The wording of a message may change, its numbers may not. For each raster, the committed figures keep the pixels
// that have values, the mean, the spread and some samples. They were computed by the .wasm with SIMD, which gives the same result on any
// processor with SIMD; on other processors use --against. The same holds where another version of Node rounds Math.exp, log, sin, cos
// or ** differently (the figures are from Node 20): the scenes are rendered partly in JavaScript, and "the pair itself" differs.
// The order of sums alone can do this much: between the two .wasm files rotations differ by 1e-8 to 1e-4 degrees, heights by up to
// 1e-2 pixels, and one run of the paper's loop ends after 4 iterations instead of 8.
// The command computes for minutes for each package, which is why `npm test` leaves it out.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { parseArgs } from "node:util";
import { compareChecks } from "./answers/checks.mjs";
import { EXCUSED, LIMITS, compare } from "./answers/compare.mjs";
import { ENGINES, neglected } from "./answers/contract.mjs";
import { SAMPLED } from "./answers/figures.mjs";
import { REASONS } from "./answers/reasons.mjs";
import { SCENES } from "./answers/scenes.mjs";
import { build } from "./build.mjs";
import { setup } from "./setup.mjs";
import { Failure, inRoot, root, say, script, seconds } from "./shell.mjs";
import { runCells } from "./tables/pool.mjs";
import { columns } from "./tables/columns.mjs";

const FIGURES = inRoot("scripts/answers/figures.json");
/** Number of scenes between two progress reports. */
const TOLD_EVERY = 10;

function parsed() {
  const [flag, text] = [{ type: "boolean", default: false }, { type: "string" }];
  const options = {
    against: text,
    write: flag,
    scalar: flag,
    only: text,
    built: flag,
    processes: { ...text, default: "2" },
  };
  let given;
  try {
    given = parseArgs({ options }).values;
  } catch (error) {
    throw new Failure(error.message);
  }
  const { against, write, only = "", processes } = given;
  const count = Number(processes);
  const scenes = SCENES.filter(({ name }) => name.includes(only));
  const unknown = REASONS.find(({ scene }) => !SCENES.some(({ name }) => name === scene));
  if (scenes.length === 0) throw new Failure(`No scene's name contains "${only}".`);
  if (write && (only || against))
    throw new Failure("--write needs all scenes of this package: leave out --only and --against.");
  if (given.scalar && against === undefined)
    throw new Failure("--scalar needs --against: the committed figures are those of the .wasm with SIMD.");
  if (!(Number.isInteger(count) && count > 0))
    throw new Failure(`--processes must be a whole number above zero, not "${processes}".`);
  if (unknown) throw new Failure(`scripts/answers/reasons.mjs: there is no scene "${unknown.scene}".`);
  const other = against === undefined ? undefined : resolve(against);
  if (other && !existsSync(join(other, "pkg/package.json")))
    throw new Failure(`${other} has no pkg/: run "npm run build" there.`);
  return { ...given, scenes, processes: count, against: other };
}

/** Results of all scenes by name. */
async function answers({ scenes, against, scalar, processes }) {
  const results = new Map();
  await runCells(
    scenes.map(({ name }) => ({ id: name, folder: root, against, scalar })),
    {
      workers: processes,
      signal: new AbortController().signal,
      program: inRoot("scripts/answers/worker.mjs"),
      onResult(id, result) {
        results.set(id, result);
        if (results.size % TOLD_EVERY === 0) say(`${results.size} of ${scenes.length} scenes`);
      },
    },
  );
  const failed = scenes.filter(({ name }) => results.get(name).failure);
  if (failed.length === 0) return results;
  const lines = failed.map(({ name }) => `  ${name}: ${results.get(name).failure.message}`);
  throw new Failure(`${failed.length} scenes failed:\n${lines.join("\n")}`);
}

/** "same", "within", "moved" if a reason explains the change, or "OVER". */
function verdict(name, { columns: measured, disagreements }) {
  if (disagreements.length > 0) return "OVER";
  const moved = REASONS.filter(({ scene }) => scene === name).flatMap((reason) => reason.moved);
  const over = Object.keys(LIMITS).filter((column) => !(measured[column] <= LIMITS[column]));
  if (over.some((column) => !(moved.includes(column) && measured[column] <= EXCUSED * LIMITS[column]))) return "OVER";
  if (over.length > 0) return "moved";
  return Object.values(measured).every((value) => value === 0) ? "same" : "within";
}

const shown = (value) => (value === 0 ? "0" : Number.isFinite(value) ? value.toExponential(1) : "missing");

/** Prints a line for each scene, with remarks on some; returns how many exceed the limits. */
function report(rows) {
  const names = Object.keys(LIMITS);
  const line = (name, status, values, found) => [name, status, ...names.map((column) => shown(values[column])), found];
  const lines = rows.map(({ name, status, verdict: found, comparison }) =>
    line(name, status, comparison.columns, found),
  );
  console.log(
    `\n${columns([["scene", "status", ...names, ""], line("at most", "", LIMITS, ""), ...lines]).join("\n")}\n`,
  );
  for (const { name, comparison } of rows) {
    for (const line of comparison.disagreements) console.log(`  ${name}: ${line}`);
    if (comparison.reworded)
      console.log(`  ${name}: reworded: ${comparison.reworded.map((text) => text ?? "nothing").join(" -> ")}`);
  }
  for (const { scene, moved, sum } of REASONS) console.log(`  ${scene}: ${moved.join(", ")}: ${sum}`);
  const worst = names.map(
    (column) => `${column} ${shown(Math.max(...rows.map(({ comparison }) => comparison.columns[column])))}`,
  );
  const count = (word) => rows.filter((row) => row.verdict === word).length;
  say(`largest: ${worst.join(", ")}`);
  const kinds = [
    ["same", "the same"],
    ["within", "within the limits"],
    ["moved", "moved with a reason"],
    ["OVER", "over"],
  ];
  say(`${rows.length} scenes: ${kinds.map(([word, words]) => `${count(word)} ${words}`).join(", ")}`);
  return count("OVER");
}

function checkCoverage(results) {
  const rare = neglected([...results.values()].map(({ uses }) => uses));
  const list = rare.map(({ member, count }) => `${member} (${count})`).join(", ");
  if (rare.length > 0) throw new Failure(`Too few scenes make use of ${list}.`);
}

/** Reports how many scenes there were and which registrations determined their poses. */
function coverage(scenes, results) {
  const rigs = scenes.filter(({ rig }) => rig).length;
  const ends = [...results.values()].map(({ endedBy }) => endedBy);
  const counts = ENGINES.map((engine) => `${engine} ${ends.filter((end) => end === engine).length}`);
  return `${scenes.length - rigs} pairs, ${rigs} rigs; ended by: ${counts.join(", ")}`;
}

/** One scene a line, so that a diff shows which scene changed. */
const written = (figures) =>
  `{\n${figures.map(([name, figure]) => `${JSON.stringify(name)}: ${JSON.stringify(figure)}`).join(",\n")}\n}\n`;

/** Figures as they are after being written and read back. */
const asWritten = (figure) => JSON.parse(JSON.stringify(figure));

function againstFigures(scenes, results) {
  const figures = JSON.parse(readFileSync(FIGURES, "utf8"));
  const missing = scenes.find(({ name }) => !figures[name]);
  if (missing) throw new Failure(`There are no figures of "${missing.name}": run it with --write.`);
  return scenes.map(({ name, rig }) => {
    const figure = asWritten(results.get(name).figure);
    const comparison = rig ? compareChecks(figures[name], figure) : compare(figures[name], figure, SAMPLED);
    return { name, status: figure.report.status ?? figure.report.verdict, comparison };
  });
}

await script(async () => {
  const given = parsed();
  const start = performance.now();
  if (!given.built) {
    await setup();
    await build();
  }
  const results = await answers(given);
  if (given.scenes.length === SCENES.length) checkCoverage(results);
  say(coverage(given.scenes, results));
  if (given.write) {
    const text = written(given.scenes.map(({ name }) => [name, results.get(name).figure]));
    writeFileSync(FIGURES, text);
    return say(`wrote ${FIGURES} (${(text.length / 1000).toFixed(0)} kB, ${seconds(start)})`);
  }
  const rows = given.against
    ? given.scenes.map(({ name }) => ({ name, ...results.get(name) }))
    : againstFigures(given.scenes, results);
  const over = report(rows.map((row) => ({ ...row, verdict: verdict(row.name, row.comparison) })));
  say(seconds(start));
  if (over > 0) throw new Failure(`${over} scenes give other answers.`);
});
