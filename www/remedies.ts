/** What may help a run that ended, by its code: the table of the documentation, in the page's words where it has its own. */

import type { ReasonCode } from "../pkg/index.js";
import { runs } from "../src/codes.json";

const RUNS: Readonly<Record<ReasonCode, { remedy: string; lab?: string }>> = runs;

/** Where a run has no reason to give. */
const GENERAL = "Another initial pose may find it: Settings, Start, near.";

export function remedyOf(code: ReasonCode | undefined): string {
  if (code === undefined) return GENERAL;
  const { lab, remedy } = RUNS[code];
  return lab ?? remedy;
}
