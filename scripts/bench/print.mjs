// The measurements as text.
import { columns, fixed } from "../tables/columns.mjs";
import { pixelsOf } from "./summary.mjs";

const time = (milliseconds) => fixed(milliseconds, milliseconds < 10 ? 2 : milliseconds < 100 ? 1 : 0);
const spread = ({ median, p10, p90 }) => `${time(median)} (${time(p10)} .. ${time(p90)})`;
const unique = (values) => [...new Set(values)];

function stageTable({ rows, wasmAgainstNative, growth }) {
  const sizes = unique(rows.map(({ size }) => size)).sort((a, b) => pixelsOf(a) - pixelsOf(b));
  const stages = unique(rows.map(({ stage }) => stage));
  const places = unique(rows.map(({ where }) => where));
  const cell = (where, stage, size) => {
    const row = rows.find((each) => each.where === where && each.stage === stage && each.size === size);
    return row ? spread(row.milliseconds) : "";
  };
  const ratio = (stage, size) =>
    fixed(wasmAgainstNative.find((row) => row.stage === stage && row.size === size)?.ratio, 2);
  const slopes = { browser: growth, native: growth.native };
  const exponent = (where, stage) => (slopes[where] ? fixed(slopes[where][stage], 2) : "");
  const timed = (stage) => places.filter((where) => rows.some((row) => row.where === where && row.stage === stage));
  return columns([
    ["stage", "where", ...sizes, "growth"],
    ...stages.flatMap((stage) => [
      ...timed(stage).map((where) => [
        stage,
        where,
        ...sizes.map((size) => cell(where, stage, size)),
        exponent(where, stage),
      ]),
      ...(places.length > 1 ? [["", "ratio", ...sizes.map((size) => ratio(stage, size)), ""]] : []),
    ]),
  ]);
}

const convergedTable = ({ timeToConverged }) =>
  columns([
    ["size", "where", "start", "seconds", "iterations", "degrees", "status"],
    ...timeToConverged.map((row) => [
      row.size,
      row.where,
      row.start,
      fixed(row.milliseconds / 1000, 2),
      row.iterations,
      fixed(row.degrees),
      row.status,
    ]),
  ]);

const searchTable = ({ search }) =>
  columns([
    ["size", "where", "scenes", "whole run, s", "of which search, s", "longest slice, ms", "found", "median degrees"],
    ...search.map((row) => [
      ...[
        row.size,
        row.where,
        row.scenes,
        fixed(row.milliseconds.median / 1000, 2),
        fixed(row.searching.median / 1000, 2),
      ],
      ...[time(row.longestSlice), `${(100 * row.foundRate).toFixed(0)} %`, fixed(row.medianDegrees)],
    ]),
  ]);

function otherTable({ startUp, transfer, drawing, playing, memory }) {
  const lines = [];
  if (startUp) lines.push(["init to first report", startUp.size, spread(startUp.milliseconds)]);
  if (transfer) lines.push(["transfer: copying out, every array", transfer.size, spread(transfer.copying)]);
  if (transfer?.painting)
    lines.push(["transfer: four views painted by the module instead", transfer.size, spread(transfer.painting)]);
  if (transfer) lines.push(["transfer: from worker to page", transfer.size, spread(transfer.travelling)]);
  if (drawing) lines.push(["page: cutting, copying, sending", drawing.size, spread(drawing.delivery)]);
  if (drawing) lines.push(["page: drawing", drawing.size, spread(drawing.drawing)]);
  if (playing) lines.push(["page: frames a second while it plays", playing.size, fixed(playing.framesPerSecond, 1)]);
  if (playing)
    lines.push(["page: its longest tasks over 50 ms", playing.size, playing.longTasks.map(time).join(", ") || "none"]);
  if (memory) lines.push(["memory after a run, MB", memory.size, fixed(memory.bytes / 1e6, 1)]);
  return lines.length === 0 ? ["  not measured"] : columns([["what", "size", "ms"], ...lines]);
}

const aimTable = (list) =>
  columns([
    ["aim", "measured", "at most", "unit", ""],
    ...list.map(({ what, value, unit, limit, met }) => [
      ...[what, value === null ? "-" : fixed(value, value < 10 ? 2 : 1), Number(limit.toFixed(1)), unit],
      met === null ? "not measured" : met ? "ok" : "MISSED",
    ]),
  ]);

/** Lines of the report. */
export const report = (result, list) => [
  `Scene: ${result.surface}, light ${result.lightName}, beta = 20; the object covers ${fixed(100 * result.covered, 0)} % of the frame. ${result.machine}`,
  "\nStages, milliseconds: median (10 % .. 90 %)",
  ...stageTable(result),
  "\nTime to the end of the loop, from a search and from the true pose",
  ...convergedTable(result),
  "\nRandom scenes, nothing known",
  ...searchTable(result),
  "\nAround the loop",
  ...otherTable(result),
  "\nAims, in the browser",
  ...aimTable(list),
];
