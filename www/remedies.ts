/** What may help after a run has ended, by its code: the table of the documentation, with other words where the page needs them. */

import type { ReasonCode } from "../pkg/index.js";
import { runs } from "../src/codes.json";

const RUNS: Readonly<Record<ReasonCode, { remedy: string; lab?: string }>> = runs;

/** For runs that ended without a reason. */
const GENERAL = "Another initial pose may find it: Settings, Start, near.";

export function remedyOf(code: ReasonCode | undefined): string {
  if (code === undefined) return GENERAL;
  const { lab, remedy } = RUNS[code];
  return lab ?? remedy;
}
