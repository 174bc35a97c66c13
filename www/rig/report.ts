/** The package's report of a check, with the package's declared types. Loaded when a report is saved. */

import * as report from "../../pkg/rig-report.js";
import type * as Report from "../../pkg/rig/write/report/index.js";

export type { Overlay, ReportInput, ReportOptions } from "../../pkg/rig/write/report/index.js";

export const reportHtml = report.reportHtml as typeof Report.reportHtml;
export const shellCheck = report.shellCheck as typeof Report.shellCheck;
