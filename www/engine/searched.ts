/** How far a search is, in percent. */

import type { StepReport } from "../../pkg/index.js";

/** Empty where the report does not say. */
export function searched({ reason }: Pick<StepReport, "reason">): string {
  if (reason?.code === "search-done") return "100 %";
  return reason?.code === "searching" && typeof reason.percent === "number" ? `${Math.round(reason.percent)} %` : "";
}
