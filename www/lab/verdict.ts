/** What a run has come to, in words that do not claim more than it is. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";

export interface Verdict {
  /** Whether the outcome may be built on: "open" where nothing says so or against it. */
  tone: "good" | "open" | "wrong";
  status: string;
  words: string;
}

/** Degrees within which a pose counts as found, and beyond which it counts as missed. */
const FOUND = 1;
const MISSED = 5;

/** Degrees below which the pose has not left its start. */
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

/** How a finished loop is to be taken; nothing while it runs. */
export function verdict({ status, message, pose }: StepReport, start: Pose | undefined, truth: Pose | null): Verdict | undefined {
  if (status === "running") return undefined;
  const said = message ? [sentence(message)] : [];
  if (truth) {
    const off = angleBetween(pose.rotation, truth.rotation);
    const tone = off > MISSED ? "wrong" : status === "converged" && off <= FOUND ? "good" : "open";
    const missed = off > MISSED ? ["The true pose was not found."] : [];
    return { tone, status: `${ends[status]}, ${decimals(off, off < 10 ? 2 : 1)}° off`, words: [...said, ...missed].join(" ") };
  }
  if (status === "converged") {
    return { tone: "good", status: ends[status], words: [...said, "The pose has settled; there is no true one to compare it with."].join(" ") };
  }
  const stayed = start !== undefined && angleBetween(pose.rotation, start.rotation) < STAYED;
  const caution = stayed ? "The rotation is still that of the start, which does not confirm it." : "The pose has not settled: do not build on it.";
  return { tone: "wrong", status: stayed ? "start kept" : ends[status], words: [...said, caution].join(" ") };
}

const sentence = (words: string): string => `${words.charAt(0).toUpperCase()}${words.slice(1)}${/[.!?]$/.test(words) ? "" : "."}`;
