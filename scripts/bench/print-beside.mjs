// The comparison of `npm run bench -- --beside` as text.
import { columns, fixed } from "../tables/columns.mjs";

export const time = (milliseconds) => fixed(milliseconds, milliseconds < 10 ? 2 : milliseconds < 100 ? 1 : 0);
/** Their time, or the limit at which it was given up. */
export const theirTime = ({ theirs, over }) => (over ? `over ${over / 1000} s` : time(theirs));
export const ratioOf = ({ ratio, over }) => `${over ? "> " : ""}${fixed(ratio, ratio < 10 ? 2 : 0)}`;

/** Lines of the report. */
export const besideReport = ({ rows, random, limit, surface, lightName, machine }) => [
  `Scene: ${surface}, light ${lightName}, beta = 20; ours: the package in Node, one thread; theirs: numpy, scipy and Open3D, one thread. ${machine}`,
  `A measurement of theirs ends after ${limit} s. A ratio over one says that theirs takes longer.`,
  "\nStages, an iteration and an answer with nothing known: medians",
  ...columns([
    ["stage", "size", "samples", "ours, ms", "theirs, ms", "ratio", "ours, degrees", "theirs, degrees"],
    ...rows.map((row) => [
      ...[row.stage, row.size, row.samples, time(row.ours), theirTime(row), ratioOf(row)],
      ...[row.ourDegrees, row.theirDegrees].map((degrees) => (degrees === null ? "" : fixed(degrees))),
    ]),
  ]),
  "\nAnswers on random scenes, nothing known",
  ...columns([
    ["size", "scenes", "", "found", "median degrees of those", "median, s"],
    ...random.flatMap(({ size, scenes, ...sides }) =>
      ["ours", "theirs"].map((side) => {
        const { found, medianDegrees, milliseconds } = sides[side];
        return [size, scenes, side, found, fixed(medianDegrees), fixed(milliseconds / 1000, 2)];
      }),
    ),
  ]),
];
