// The regions of docs that commands fill: `npm run tables -- --docs`, `npm run bench -- --docs` (with `--beside` another one) and
// `npm run ablation -- --docs`.
//
// A region lies between two comments and is replaced as a whole. Its figures come from one run, which its first line describes.
import { readFileSync, writeFileSync } from "node:fs";
import { Failure, inRoot, say } from "./shell.mjs";
import { ratioOf, theirTime, time } from "./bench/print-beside.mjs";
import { fixed } from "./tables/columns.mjs";

/** Commands of the regions whose name is not that of their command. */
const COMMANDS = { beside: "npm run bench -- --beside --docs" };
const begin = (name) => `<!-- begin: ${name} (written by ${COMMANDS[name] ?? `npm run ${name} -- --docs`}) -->`;
const end = (name) => `<!-- end: ${name} -->`;

/** A text with its region filled in. */
export function filled(text, name, lines) {
  const [from, to] = [text.indexOf(begin(name)), text.indexOf(end(name))];
  if (from < 0 || to < from) throw new Failure(`There is no region between "${begin(name)}" and "${end(name)}".`);
  return `${text.slice(0, from)}${[begin(name), "", ...lines, "", ""].join("\n")}${text.slice(to)}`;
}

export function fill(path, name, lines) {
  writeFileSync(inRoot(path), filled(readFileSync(inRoot(path), "utf8"), name, lines));
  say(`wrote the region "${name}" of ${path}`);
}

/** Rows of a Markdown table; numbers are aligned to the right. */
function table(head, alignments, rows) {
  const line = (cells) => `| ${cells.map((cell) => String(cell).replaceAll("|", "\\|")).join(" | ")} |`;
  return [line(head), `|${alignments.map((right) => (right ? "---:" : "---")).join("|")}|`, ...rows.map(line)];
}

const version = () => /^version = "(.+)"$/m.exec(readFileSync(inRoot("Cargo.toml"), "utf8"))[1];
const small = (value) => (value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(1) : fixed(value));
const verdict = (ok) => (ok === null ? "not measured" : ok ? "ok" : "missed");

/** The aims of the tables, from their JSON. */
export function tablesLines({ aims, quick, data }) {
  const from = `Version ${version()}, ${quick ? "the quick selection of cells (`--quick`), too few rows to judge the aims" : "all cells"}${data ? "" : "; built-in surfaces and lights, without the data beside the project"}.`;
  const rows = aims.map(({ table: name, what, rows, measured, sense, limit, ok }) => [
    name,
    what,
    rows,
    measured === null ? "-" : small(measured),
    `${sense} ${limit}`,
    verdict(ok),
  ]);
  return [
    from,
    "",
    ...table(["table", "what", "rows", "measured", "aim", ""], [false, false, true, true, true, false], rows),
  ];
}

const milliseconds = (value) => fixed(value, value < 10 ? 2 : value < 100 ? 1 : 0);
const unique = (values) => [...new Set(values)];

/** Medians of the stages, one cell for browser and native, and the aims, from the JSON of the bench. */
export function benchLines({ rows, aims, machine, surface, lightName, quick }) {
  const places = unique(rows.map(({ where }) => where.split(", ")[0]));
  const from = `Version ${version()}${quick ? ", the quick selection (`--quick`)" : ""}; ${surface}, light ${lightName}; ${machine}. Milliseconds, medians: ${places.join(" / ")}.`;
  const sizes = unique(rows.map(({ size }) => size));
  // What follows the place is the number of workers, as in "browser, 2 workers".
  const workers = (where) => where.slice(where.split(", ")[0].length);
  const names = unique(rows.map(({ stage, where }) => stage + workers(where)));
  const cell = (name, size) => {
    const of = (place) =>
      rows.find((row) => row.stage + workers(row.where) === name && row.where.startsWith(place) && row.size === size);
    return places.map((place) => milliseconds(of(place)?.milliseconds.median)).join(" / ");
  };
  const times = names.map((name) => [name, ...sizes.map((size) => cell(name, size))]);
  const judged = aims.map(({ what, value, unit, limit, met }) => [
    what,
    value === null ? "-" : `${milliseconds(value)} ${unit}`.trim(),
    `${Number(limit.toFixed(1))} ${unit}`.trim(),
    verdict(met),
  ]);
  return [
    ...[from, "", ...table(["stage", ...sizes], [false, ...sizes.map(() => true)], times)],
    ...["", ...table(["aim", "measured", "at most", ""], [false, true, true, false], judged)],
  ];
}

/** Times of both sides and their ratios, from the JSON of `npm run bench -- --beside`. */
export function besideLines({ rows, random, surface, lightName, machine, quick }) {
  const from = `Version ${version()}${quick ? ", the quick selection (`--quick`)" : ""}; ${surface}, light ${lightName}; ${machine}. Ours / theirs in milliseconds, medians; **theirs / ours**.`;
  const sizes = unique(rows.map(({ size }) => size));
  const at = (stage, size) => rows.find((row) => row.stage === stage && row.size === size);
  const pair = (row) => (row ? `${time(row.ours)} / ${theirTime(row)}` : "-");
  const cells = (stage) => sizes.flatMap((size) => [pair(at(stage, size)), `**${ratioOf(at(stage, size) ?? {})}**`]);
  const off = (size, key) => fixed(at("answer", size)?.[key]);
  const errors = sizes.map((size) => `${off(size, "ourDegrees")} and ${off(size, "theirDegrees")} at ${size}`);
  const finds = ({ found, medianDegrees, milliseconds: time }) =>
    `${found} (medians: ${fixed(medianDegrees)} degrees, ${fixed(time / 1000, 2)} s)`;
  const found = random.map(
    ({ size, scenes, ours, theirs }) =>
      `Of ${scenes} random scenes of ${size}, ours finds ${finds(ours)} and theirs ${finds(theirs)}.`,
  );
  return [
    ...[from, ""],
    ...table(
      ["stage", ...sizes.flatMap((size) => [size, ""])],
      [false, ...sizes.flatMap(() => [true, true])],
      unique(rows.map(({ stage }) => stage)).map((stage) => [stage, ...cells(stage)]),
    ),
    ...["", `The answers are ${errors.join(", ")} degrees off, ours first.`],
    ...found,
  ];
}
