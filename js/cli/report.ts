/** The report with the additions of the readers, and its text for a terminal. */
import type { ReaderWarning } from "../rig/warnings.js";
import { resultsOf, verdictReason } from "../rig/write/report/words.js";
import type { CheckReport } from "../types/index.js";

/** Warnings in the form of the contract. */
export interface Warning {
  code: string;
  message: string;
  /** The file or input that the warning is about. */
  field?: string;
}

/** Warnings that do not affect the values leave the verdict unchanged. */
export type Judged = Warning & { isDoubt?: boolean };

export const ofReader = ({ code, message, isDoubt, file }: ReaderWarning): Judged => ({
  code,
  message,
  ...(file !== undefined && { field: file }),
  isDoubt,
});

export type Whole = Omit<CheckReport, "warnings"> & { warnings: Warning[] };

/** The report with all warnings. Guesses of the readers prevent the verdict "consistent", as the check's warnings do. */
export function capped(report: CheckReport, all: Judged[]): Whole {
  const distinct = [...new Map(all.map((each) => [each.message, each])).values()];
  const doubt = distinct.find(({ isDoubt }) => isDoubt !== false);
  const warnings = distinct.map(({ isDoubt: _, ...plain }) => plain);
  if (report.verdict !== "consistent" || doubt === undefined) return { ...report, warnings };
  const reason = `It would be consistent without this warning: ${doubt.message} ${report.reason}`;
  return { ...report, warnings, verdict: "undecided", code: "doubtful", reason };
}

const short = (value: number): string => (Number.isFinite(value) ? String(Number(value.toPrecision(3))) : "?");
const percent = (share: number): string => `${(100 * share).toFixed(0)} %`;
const pixels = ({ pixels: value, interval: [low, high] }: CheckReport["health"]): string =>
  `${short(value)} (${short(low)} to ${short(high)})`;

/** Columns as wide as their widest cell. */
function table(rows: string[][]): string[] {
  const widths = (rows[0] ?? []).map((_, column) => Math.max(...rows.map((row) => row[column]?.length ?? 0)));
  return rows.map((row) =>
    row
      .map((cell, column) => cell.padEnd(widths[column] ?? 0))
      .join("  ")
      .trimEnd(),
  );
}

/** The verdict with its reason. */
const headline = (report: Whole): string => `${report.verdict.toUpperCase()}: ${verdictReason(report)}`;

/** The report for a terminal. */
export function textOf(report: Whole): string {
  const { rotation: r, translation: t } = report.estimate;
  const candidates = resultsOf(report).map(([name, found]) => [
    ...[name, found.verdict, `${short(found.offDegrees)} deg`, `${short(found.offMillimetres)} mm`],
    ...[pixels(found), short(found.probability)],
  ]);
  const cues = Object.entries(report.cues).map(([name, { share }]) => `${name} ${percent(share)}`);
  const frames = report.frames.map(({ name, share, note }) => `${name} ${percent(share)}${note ? ` (${note})` : ""}`);
  return [
    headline(report),
    "",
    ...table([
      ["calibration", "verdict", "rotation", "shift", "error, pixels (95 %)", "probability"],
      ...candidates,
      ["best fit", "", "", "", pixels(report.health), ""],
    ]),
    "",
    "best fit, P_colour = R P_depth + t, metres:",
    ...[0, 1, 2].map((i) => `  ${[...r.slice(3 * i, 3 * i + 3), t[i]].join(" ")}`),
    "  0 0 0 1",
    "",
    `depth points on the image: ${percent(report.overlap)}`,
    `cues: ${cues.join(", ")}`,
    `frames: ${frames.join(", ")}`,
    ...(report.next ? [`next frame: ${report.next.message}`] : []),
    ...report.warnings.map(({ message }) => `warning: ${message}`),
    "",
  ].join("\n");
}
