// Defines poses that are found, flagged or confidently wrong, and counts them.
import { mean, median, share } from "./numbers.mjs";

/** A pose within this many degrees counts as found. */
export const FOUND_WITHIN = 3;

export const isFound = ({ degrees }) => typeof degrees === "number" && degrees < FOUND_WITHIN;
/** Whether the report flags the pose as uncertain, by the status or by rivals of a pose that did not converge. */
export const isFlagged = ({ status, rivals }) =>
  status === "ambiguous" || status === "lost" || (status === "max-iterations" && rivals > 0);
export const isConfidentlyWrong = (row) => !isFound(row) && !isFlagged(row);
/** Found or flagged. */
export const isFoundOrFlagged = (row) => isFound(row) || isFlagged(row);

const AXES = [0, 1, 2];

/** Whether the error about each axis lies within `count` sigmas of that axis; undefined without sigmas. */
const within = ({ rotationOff, sigmas }, count) =>
  sigmas && AXES.map((axis) => Math.abs(rotationOff[axis]) <= count * sigmas[axis]);

/** Share of the found poses whose rotation is within three sigma on all axes; a pose without sigmas counts as outside. */
export const coverage3 = (rows) =>
  share(rows.filter(isFound), (row) => Boolean(row.sigmas) && within(row, 3).every(Boolean));

/** The row of random scenes: counts; coverages are shares of the found poses. */
export function randomRow(rows) {
  const found = rows.filter(isFound);
  const measured = found.filter((row) => row.sigmas);
  const within1 = measured.map((row) => within(row, 1));
  return {
    cases: rows.length,
    found: found.length,
    ambiguousOrLost: rows.filter(isFlagged).length,
    confidentlyWrong: rows.filter(isConfidentlyWrong).length,
    flaggedThoughFound: found.filter(isFlagged).length,
    medianDegrees: median(found.map(({ degrees }) => degrees)),
    /** Share of single axes within one sigma, over all axes and for each. */
    coverage1: share(within1.flat(), Boolean),
    coverage1PerAxis: AXES.map((axis) => share(within1, (axes) => axes[axis])),
    coverage3: coverage3(rows),
    withoutSigmas: found.length - measured.length,
    meanMilliseconds: mean(rows.map(({ milliseconds }) => milliseconds)),
    scenes: rows,
  };
}

/** The rows of the results: each cell's own keys, and the measured values. */
export const measuredRows = (results) => results.map(({ cell, result }) => ({ ...cell.row, ...result }));

/** The row of random scenes, with the median error of all, found or not, and a row for each value of a key. */
export function rowByKind(rows, groups) {
  const kinds = groups.flatMap(({ key, values }) =>
    values.map((kind) => ({ ...randomRow(rows.filter((row) => row[key] === kind)), kind, scenes: undefined })),
  );
  return { ...randomRow(rows), medianOfAll: median(rows.map(({ degrees }) => degrees)), kinds };
}
