/** Sharing: a link that restores the experiment, and the report as a file. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { byId } from "../dom";
import { saveJson } from "../save";
import { toLink, type Origin, type Settings } from "./settings";
import { angleBetween } from "./verdict";

/** Choices that affect only the display, by their ids, with their initial values. */
const looks = { "clouds-style": "surfaces", "clouds-texture": "view", pace: "1" } as const;

const selects = () =>
  Object.entries(looks).map(([id, initial]) => ({ id, initial, select: byId(id, HTMLSelectElement) }));

/** Applies the choices in an address; the others stay unchanged. */
export function showLooks(hash: string): void {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  for (const { id, select } of selects()) {
    const value = given.get(id);
    if (value === null || value === select.value || ![...select.options].some((option) => option.value === value))
      continue;
    select.value = value;
    select.dispatchEvent(new Event("change"));
  }
}

export function onLook(act: () => void): void {
  for (const { select } of selects()) select.addEventListener("change", act);
}

/** Settings and display choices; none of the visitor's files. */
export function linkTo(settings: Settings): string {
  const url = new URL(location.href);
  const other = selects().filter(({ initial, select }) => select.value !== initial);
  url.hash = [toLink(settings), new URLSearchParams(other.map(({ id, select }) => [id, select.value])).toString()]
    .filter(Boolean)
    .join("&");
  return url.href;
}

/** Updates the address with the settings without filling the browser's history. */
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

/** Saves the full report of a run as JSON. */
export function download({ source, settings, truth, report, history }: Experiment): void {
  const rotationErrorDegrees = truth ? angleBetween(report.pose.rotation, truth.rotation) : null;
  saveJson("bimodal-stereo-report.json", "settings, poses and all iterations of this run", {
    format: "bimodal-stereo report",
    version: 1,
    source,
    settings,
    truth,
    rotationErrorDegrees,
    report,
    history,
  });
}
