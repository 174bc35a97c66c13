/** The outcome of a run, in words that do not overstate it. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";
import { remedyOf } from "../remedies";

export interface Verdict {
  /** Whether the outcome can be relied on; "open" if nothing supports or contradicts it. */
  tone: "good" | "open" | "wrong";
  status: string;
  words: string;
  /** Advice; empty if none is needed. */
  next: string;
}

/** Whether poses are still being tried. */
export const isSearching = ({ status, stage, iteration }: StepReport): boolean =>
  status === "running" && stage === "search" && iteration === 0;

/** Whether a step of this kind continues after this report. A stage ends with the search, an iteration after it. */
export const isWithinSearch = (report: StepReport, by: "step" | "stage"): boolean =>
  isSearching(report) && !(by === "stage" && report.reason?.code === "search-done");

/** The words for pose and light at this moment; before the first step nothing has been found. */
export const standing = (report: StepReport): string =>
  isSearching(report) ? "candidate" : report.status === "running" && report.iteration === 0 ? "start" : "found";

/** How a pose is called once the settings have changed. An initial pose is not renamed, because no run found it. */
export const BEFORE = "last run";
export const dated = (standing: string, isBefore: boolean): string =>
  isBefore && standing !== "start" ? BEFORE : standing;

/** The progress of a run, in a few words. */
export function wordsOf({ status, iteration, pose }: StepReport, truth: Pose | null): string {
  const off = truth ? `, ${decimals(angleBetween(pose.rotation, truth.rotation), 2)}° off` : "";
  return `${status === "running" ? `iteration ${iteration}` : ends[status]}${off}`;
}

/** Degrees of error up to which a pose counts as found, and above which it counts as missed. */
const FOUND = 1;
const MISSED = 5;

/** Degrees of difference below which the pose counts as still the initial pose. */
const STAYED = 0.5;

/** The angle of a bᵀ in degrees, from |a − b| because the trace loses the small angles that matter here. */
export function angleBetween(a: readonly number[], b: readonly number[]): number {
  const distance = Math.hypot(...a.map((value, i) => value - (b[i] ?? NaN)));
  return (2 * Math.asin(Math.min(1, distance / Math.SQRT2 / 2)) * 180) / Math.PI;
}

const ends: Record<Exclude<StepReport["status"], "running">, string> = {
  converged: "converged",
  "max-iterations": "stopped",
  ambiguous: "ambiguous",
  lost: "lost",
};

/** Suggestions after a successful run. */
const HARDER = "Rotate the surfaces, drag the light, or try “Too hard”, where no pose can be recovered.";
/** The same for files, whose light cannot be dragged. */
const KEEP = "Rotate the surfaces, or download pose, clouds and refined depth below.";
/** The right pose, up to noise. */
const FINER = "Less noise or larger views would bring it closer.";

/** For runs that do not estimate the pose. */
const HELD = "The pose stayed at its initial value, as set under Registration.";
const FREE = "To let it move, choose Settings, Registration, joint.";

/** The interpretation of a finished loop; undefined while it runs. */
export function verdict(
  { status, message, reason, pose }: StepReport,
  start: Pose | undefined,
  truth: Pose | null,
  isHeld = false,
  isOwn = false,
): Verdict | undefined {
  if (status === "running") return undefined;
  const said = message ? [sentence(message)] : isHeld ? [HELD] : [];
  const help = isHeld ? FREE : remedyOf(reason?.code);
  if (truth) {
    const off = angleBetween(pose.rotation, truth.rotation);
    const tone =
      off > MISSED && status !== "ambiguous" ? "wrong" : status === "converged" && off <= FOUND ? "good" : "open";
    const isNear = status === "converged" && !message && !isHeld && off > FOUND && off <= MISSED;
    const missed =
      off > MISSED
        ? ["The true pose was not found."]
        : tone === "good" && !message
          ? ["The true pose was found."]
          : isNear
            ? ["The true pose was found, but not to within one degree."]
            : [];
    const next =
      tone === "good"
        ? isOwn
          ? KEEP
          : HARDER
        : isNear
          ? FINER
          : off <= FOUND && (status === "lost" || status === "ambiguous")
            ? `The pose is nevertheless right. ${help}`
            : help;
    return {
      tone,
      status: `${ends[status]}, ${decimals(off, 2)}° off`,
      words: [...said, ...missed].join(" "),
      next,
    };
  }
  if (status === "converged") {
    return {
      tone: "good",
      status: ends[status],
      words: [...said, "The pose has converged. There is no ground truth to compare it with."].join(" "),
      next: "",
    };
  }
  if (status === "ambiguous") return { tone: "open", status: ends[status], words: said.join(" "), next: help };
  const stayed = start !== undefined && angleBetween(pose.rotation, start.rotation) < STAYED;
  const caution = stayed
    ? "The rotation did not move from its initial value, which does not confirm it."
    : "The pose has not converged; don't rely on it.";
  return {
    tone: "wrong",
    status: stayed ? "start kept" : ends[status],
    words: [...said, caution].join(" "),
    next: help,
  };
}

/** Capitalises a sentence; the name of a file stays unchanged. */
export function sentence(words: string): string {
  const first = /^[^:]*\.\w+: /.test(words) ? words.charAt(0) : words.charAt(0).toUpperCase();
  return `${first}${words.slice(1)}${/[.!?]$/.test(words) ? "" : "."}`;
}
