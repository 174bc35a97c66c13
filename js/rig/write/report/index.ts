/**
 * The report of a check of a rig as one self-contained HTML file that can be stored, mailed and printed on one page. It contains no script,
 * its content security policy allows none, and text from files is escaped.
 */
import { type Example, like } from "../built.js";
import type { Checked, Picture, ReportOptions } from "./contents.js";
import { details } from "./details.js";
import { html } from "./markup.js";
import { overlayPair } from "./overlay.js";
import { dateOf, reportPage } from "./page.js";
import { inputTable, pictureSection, section } from "./parts.js";
import { extrinsicsSection, shellSection, summary, verdictHeader, warningList } from "./sections.js";

export { type ShellCheck, shellCheck } from "./command.js";
export type { Checked, Overlay, Picture, ReportEntry, ReportInput, ReportOptions } from "./contents.js";

/** The members that the sections read; a missing word or an invalid number is shown as "not known". */
const REPORT: Example = {
  warnings: [{}],
  estimate: { rotation: [], translation: [], angles: {} },
  covariance: [],
  health: { interval: [] },
  candidates: { "*": { interval: [] } },
  cues: { "*": {} },
  frames: [{}],
  sensitivity: [{ offsets: [], values: [] }],
};
const OPTIONS: Example = {
  inputs: [{}],
  calibrations: { "*": { rotation: [], translation: [], angles: {} } },
  overlays: [{}],
  shell: {},
  settings: [[]],
  versions: [[]],
};

const LEGEND = html`<p class="soft"><svg class="key" viewBox="0 0 24 8" aria-hidden="true"><path class="edge" d="M0 4H24"/></svg> depth edges; they should coincide with the silhouettes in the image</p>`;

/** Largest number of lines in the lists of a printed page at which its pictures may be large. */
const FEW_LINES = 14;

/** Number of lines of the lists, each limited to the length of a full page. */
function linesOf({ warnings, candidates }: Checked, { inputs = [], shell }: ReportOptions): number {
  const command = String(shell?.command ?? "").split("\n");
  return (
    Math.min(warnings.length, 4) +
    Math.min(Object.keys(candidates).length, 4) +
    Math.min(inputs.length, 10) +
    command.length
  );
}

/** The report of a check as one HTML file without scripts. `pictures` are shown with the details. */
export function reportHtml(report: Checked, pictures: readonly Picture[] = [], options: ReportOptions = {}): string {
  like(REPORT, report, "report");
  like([{}], pictures, "pictures");
  like({}, options, "options");
  const { title = "Check of a calibration", made, inputs = [], overlays = [], isEstimate } = options;
  for (const [name, example] of Object.entries(OPTIONS)) {
    const value = options[name as keyof ReportOptions];
    if (value !== undefined) like(example, value, `options.${name}`);
  }
  const [first, ...others] = overlays.map(overlayPair);
  return reportPage(title, verdictHeader(report, title, dateOf(made, "options.made"), isEstimate), [
    ...[summary(report, options), warningList(report)],
    first &&
      section(
        "Depth edges on the image",
        html`<div class="${linesOf(report, options) > FEW_LINES ? "small" : "large"}">${first}</div>`,
        LEGEND,
      ),
    ...[extrinsicsSection(report, options), shellSection(options), inputTable(inputs)],
    details(
      report,
      html`${others.length > 0 ? section("Other frames", others, LEGEND) : undefined}${pictureSection(pictures)}`,
    ),
  ]);
}
