/** What can be taken away: a link that brings the same experiment back, and the report as a file. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { saveJson } from "../save";
import { toLink, type Origin, type Settings } from "./settings";
import { angleBetween } from "./verdict";

export function linkTo(settings: Settings): string {
  const url = new URL(location.href);
  url.hash = toLink(settings);
  return url.href;
}

/** Keeps the address in step with the settings without filling the browser's history. */
export function writeAddress(settings: Settings): void {
  history.replaceState(null, "", linkTo(settings));
}

export interface Experiment {
  source: Origin;
  settings: Settings;
  truth: Pose | null;
  report: StepReport;
  history: readonly StepReport[];
}

/** Saves everything there is to say about a run as JSON. */
export function download({ source, settings, truth, report, history }: Experiment): void {
  const rotationErrorDegrees = truth ? angleBetween(report.pose.rotation, truth.rotation) : null;
  saveJson("bimodal-stereo-report.json", { format: "bimodal-stereo report", version: 1, source, settings, truth, rotationErrorDegrees, report, history });
}
