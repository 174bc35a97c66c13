/** The status of a run in English, and its parts for other languages. */

import type { StepReport } from "../../../pkg/index.js";
import { filled, type Details } from "../../words";
import type { Drawing, Said } from "../protocol";

/** The texts of a run's states, by the names that a catalogue uses. */
export const STATUSES = {
  held: "fixed where you set it",
  search: "search",
  iteration: "iteration {iteration}",
  converged: "converged",
  ambiguous: "ambiguous",
  lost: "lost",
  "max-iterations": "max-iterations",
} as const;

export interface Status {
  english: string;
  said: Said[];
}

export const statusOf = (name: keyof typeof STATUSES, details: Details = {}): Status => ({
  english: filled(STATUSES[name], details),
  said: [{ id: `statuses.${name}`, details }],
});

/** The progress of a run, or how and why it ended. */
export function statusIn({ status, stage, iteration, message, reason }: StepReport): Status {
  const isSearching = status === "running" && stage === "search";
  const name = status !== "running" ? status : isSearching ? "search" : "iteration";
  const { english, said } = statusOf(name, { iteration });
  const isTold = name !== "iteration";
  const why = isTold && reason ? [{ id: `runs.${reason.code}`, details: detailsOf(reason) }] : [];
  const words = isTold && message ? [message] : [];
  return { english: [english, ...words].join(isSearching ? ", " : ": "), said: [...said, ...why] };
}

/** The numbers and words of a reason. */
const detailsOf = (reason: object): Details =>
  Object.fromEntries(
    Object.entries(reason).filter(([, detail]) => typeof detail === "number" || typeof detail === "string"),
  );

export const wordsOf = ({ english, said }: Status): Required<Pick<Drawing, "words" | "said">> => ({
  words: { status: english },
  said: { status: said },
});
