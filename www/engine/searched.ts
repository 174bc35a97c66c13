/** The progress of a search, in percent. */

import type { StepReport } from "../../pkg/index.js";

/** Empty if the report does not contain the progress. */
export function searched({ reason }: Pick<StepReport, "reason">): string {
  if (reason?.code === "search-done") return "100 %";
  return reason?.code === "searching" && typeof reason.percent === "number" ? `${Math.round(reason.percent)} %` : "";
}
