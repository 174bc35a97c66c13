/** The check's sentences as the page says them. */

import type { CheckReport } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";

/**
 * Says where a shift is measured. A turn about a camera moves the scene as far as the scene is away: without the place, two
 * degrees read as a shift that is longer than the whole baseline.
 */
export function withPlace(report: CheckReport): CheckReport {
  const place = `at the middle of the scene, ${decimals(Math.hypot(...report.middle), 2)} m away`;
  const said = (reason: string) => reason.replace(/( and [\d.]+ mm)(, most of it along )/, `$1 ${place}$2`);
  const candidates = Object.entries(report.candidates).map(([name, candidate]) => [name, { ...candidate, reason: said(candidate.reason) }] as const);
  return { ...report, reason: said(report.reason), candidates: Object.fromEntries(candidates) };
}
