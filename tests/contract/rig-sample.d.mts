import type { CheckReport } from "../../pkg/index.js";

export function report(): CheckReport;
