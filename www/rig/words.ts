/** The verdict and a camera's place in the words of the report, with the package's declared types. */

import * as words from "../../pkg/rig-words.js";
import type * as Words from "../../pkg/rig/write/report/words.js";
import type { WholeReport } from "./protocol";
import type { Run } from "./state";

export const placeInWords = words.placeInWords as typeof Words.placeInWords;
export const isBackwards = words.isBackwards as typeof Words.isBackwards;
export const isOfCarrier = words.isOfCarrier as typeof Words.isOfCarrier;
export const isOfScan = words.isOfScan as typeof Words.isOfScan;
export const resultsOf = words.resultsOf as typeof Words.resultsOf;
export const verdictReason = words.verdictReason as typeof Words.verdictReason;
export const verdictWords = words.verdictWords as typeof Words.verdictWords;

/** The report with the page's guesses and warnings, which cap a verdict as the warnings of the check do. */
export function whole({ report, guessed, doubts }: Run): WholeReport {
  const own = [...guessed.map((what) => ({ code: "unit-guessed", message: `Guessed: ${what}.` })), ...doubts];
  const isCapped = own.length > 0 && report.verdict === "consistent";
  return {
    ...report,
    ...(isCapped ? { verdict: "undecided", code: "doubtful" } : {}),
    warnings: [...own, ...report.warnings],
  };
}
