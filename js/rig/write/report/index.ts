/**
 * The report of a check of a rig as one self-contained HTML file that can be kept, mailed and printed. It contains no script, its content
 * security policy allows none, and text from files is escaped.
 */
import { type Example, like } from "../built.js";
import type { Checked, Picture, ReportOptions } from "./contents.js";
import { reportPage } from "./page.js";
import { inputTable, pictureSection } from "./parts.js";
import {
  candidateTable,
  cueTable,
  estimateSection,
  frameTable,
  sensitivitySection,
  verdictCard,
  warningList,
} from "./sections.js";

export type { Checked, Picture, ReportInput, ReportOptions } from "./contents.js";

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

/** The report of a check as one HTML file without scripts. `pictures` are shown below the verdict. */
export function reportHtml(report: Checked, pictures: readonly Picture[] = [], options: ReportOptions = {}): string {
  like(REPORT, report, "report");
  like([{}], pictures, "pictures");
  like({}, options, "options");
  const { title = "Check of a calibration", made, inputs = [] } = options;
  like([{}], inputs, "options.inputs");
  const body = [
    ...[verdictCard(report), warningList(report), candidateTable(report), pictureSection(pictures), cueTable(report)],
    ...[frameTable(report), sensitivitySection(report), estimateSection(report), inputTable(inputs)],
  ];
  return reportPage(title, made, "options.made", body);
}
