/** The verdict and the place of a camera in words, for the report and for the page beside it. */
import type { CandidateReport, CheckReport, CheckVerdict } from "../../../types/index.js";
import { degreesOf, isOfScan } from "../../formats/poses.js";
import type { Checked } from "./contents.js";

import { isBackwards, isOfCarrier } from "../../formats/frames.js";

export { isBackwards, isOfCarrier, isOfScan };

const WORDS: Readonly<Record<CheckVerdict, string>> = { consistent: "Consistent", off: "Off", undecided: "Undecided" };

export const verdictOf = (verdict: CheckVerdict): CheckVerdict =>
  Object.hasOwn(WORDS, verdict) ? verdict : "undecided";

export const wordOf = (verdict: CheckVerdict): string => WORDS[verdictOf(verdict)];

const firstOf = ({ candidates }: Pick<Checked, "candidates">) => Object.values(candidates)[0];

/** Whether only a warning keeps the verdict from "consistent". */
const isCapped = (report: Checked): boolean =>
  report.verdict === "undecided" && firstOf(report)?.verdict === "consistent";

/** The candidates by name for tables: warnings cap the verdict on the first one, so that its row says the same as the line above. */
export const resultsOf = (report: Checked): [name: string, found: CandidateReport][] =>
  Object.entries(report.candidates).map(([name, found], index) =>
    index === 0 && isCapped(report)
      ? [name, { ...found, verdict: report.verdict, reason: verdictReason(report) }]
      : [name, found],
  );

/** The verdict in a few words; without a calibration in question there is only an estimate. */
export function verdictWords(report: Checked, isEstimate = false): string {
  if (isEstimate) return "Estimated";
  const isWarned = isCapped(report) || (report.verdict === "off" && report.warnings.length > 0);
  return wordOf(report.verdict) + (isWarned ? ", see warnings" : "");
}

/**
 * The reason in a sentence. If warnings cap the verdict, the candidate's own reason is given, because the warnings are listed beside it.
 */
export function verdictReason(report: Checked): string {
  const own = isCapped(report) ? firstOf(report)?.reason : undefined;
  return own === undefined ? report.reason : `It would be consistent without the warnings. ${own}`;
}

const SIDES = [
  ["to the right of", "to the left of"],
  ["below", "above"],
  ["in front of", "behind"],
] as const;
/** Millimetres and degrees below which a difference is shown as zero. */
const [LEAST_SHIFT, LEAST_TURN] = [0.05, 0.005];

type Motion = Pick<CheckReport["estimate"], "rotation" | "translation">;

/** Rotations of cameras that look along an axis of a LiDAR with z up. */
const AHEAD: readonly [axis: string, rotation: readonly number[]][] = [
  ["x", [0, -1, 0, 0, 0, -1, 1, 0, 0]],
  ["y", [1, 0, 0, 0, 0, -1, 0, 1, 0]],
  ["−x", [0, 1, 0, 0, 0, -1, -1, 0, 0]],
  ["−y", [-1, 0, 0, 0, 0, -1, 0, -1, 0]],
];

/** The axis along which the colour camera looks from a LiDAR, and the angle between them. */
function heading({ rotation }: Motion): string {
  const trace = (ahead: readonly number[]) => rotation.reduce((sum, value, k) => sum + value * (ahead[k] ?? 0), 0);
  const traces = AHEAD.map(([axis, ahead]) => [axis, trace(ahead)] as const);
  const [axis, most] = traces.reduce((a, b) => (a[1] >= b[1] ? a : b));
  const degrees = (180 / Math.PI) * Math.acos(Math.min(1, Math.max(-1, (most - 1) / 2)));
  return `which looks along the LiDAR's ${axis} axis with z up, except for a rotation by ${degrees.toFixed(2)}°`;
}

/** The place of the depth camera or LiDAR relative to the colour camera, in words that can be compared with the rig. */
export function placeInWords({ rotation, translation }: Motion, isLidar = false): string {
  const parts = translation
    .map((metres, axis) => ({ mm: 1000 * metres, words: SIDES[axis]?.[metres < 0 ? 1 : 0] ?? "" }))
    .filter(({ mm }) => Math.abs(mm) >= LEAST_SHIFT)
    .sort((a, b) => Math.abs(b.mm) - Math.abs(a.mm))
    .map(({ mm, words }) => `${Math.abs(mm).toFixed(1)} mm ${words}`);
  const degrees = degreesOf(rotation);
  const isScan = isLidar && isOfScan({ rotation });
  if (!isScan && degrees < LEAST_TURN && parts.length === 0) return "The two cameras coincide: no offset, no rotation.";
  const last = parts.pop();
  const place = last === undefined ? "in the same position as" : [parts.join(", "), last].filter(Boolean).join(" and ");
  if (isScan) return `The LiDAR sits ${place} the colour camera, ${heading({ rotation, translation })}.`;
  return `The depth camera sits ${place} the colour camera, rotated by ${degrees.toFixed(2)}°.`;
}
