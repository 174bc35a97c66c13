/** The parts of the report beyond its first page: tables and curves in sections that can be opened. */
import type { CandidateReport } from "../../../types/index.js";
import { bar, sensitivities } from "./charts.js";
import type { Checked } from "./contents.js";
import { type Markup, html } from "./markup.js";
import { digits, measure, percent, probability, span } from "./numbers.js";
import { cell, section, table } from "./parts.js";
import { cueName } from "./sections.js";
import { resultsOf, verdictOf, wordOf } from "./words.js";

const CANDIDATE_COLUMNS = [
  "Calibration",
  "Verdict",
  "Rotation",
  "Shift",
  "Expected error",
  "95\u202f% interval",
  "Probability",
  "Reason",
];

function candidateRow(name: string, found: CandidateReport): Markup {
  const number = (text: string) => html`<span class="number">${text}</span>`;
  const values = [
    html`<strong class="word ${verdictOf(found.verdict)}">${wordOf(found.verdict)}</strong>`,
    ...[measure(found.offDegrees, "\u00b0"), measure(found.offMillimetres, "mm"), measure(found.pixels, "px")].map(
      number,
    ),
    ...[number(span(found.interval, "px")), number(probability(found.probability)), found.reason],
  ];
  return html`<tr><th scope="row">${name}</th>${values.map((value, index) => cell(CANDIDATE_COLUMNS[index + 1] ?? "", value))}</tr>`;
}

function candidateTable(report: Checked): Markup | undefined {
  const rows = resultsOf(report).map(([name, found]) => candidateRow(name, found));
  if (rows.length === 0) return undefined;
  return section(
    "Calibrations compared",
    table("candidates stacks", CANDIDATE_COLUMNS, rows),
    html`<p class="soft">Rotation and shift: relative to the best fit, the shift at the centre of the scene. Expected error: the distance in the
colour image between the projection of a scene point and its true place, at the scene's depth. Probability: that of a result at least this far
from the best fit if the calibration were right.</p>`,
  );
}

const COVARIANCE = ["rotation x", "rotation y", "rotation z", "shift x", "shift y", "shift z"];

function covarianceSection({ covariance }: Checked): Markup {
  const row = (name: string, i: number) =>
    html`<tr><th scope="row">${name}</th>${COVARIANCE.map((_, j) => html`<td>${digits(covariance[6 * i + j] ?? NaN)}</td>`)}</tr>`;
  return section(
    "Covariance",
    html`<div class="scroll" tabindex="0">${table("matrix", ["", ...COVARIANCE], COVARIANCE.map(row))}</div><p class="soft">For a rotation vector in rad about the scene's centre, then a translation in m, in the colour camera's frame.</p>`,
  );
}

/** Descriptions of the cues. */
const MORE: Readonly<Record<string, string>> = {
  shading: "lighting of the surface's slopes",
  edges: "depth edges on image edges",
  information: "mutual information of colour and shape",
  silhouette: "object contours in both views",
};

const sharpness = (value: number): string => (value > 0 ? `\u00b1 ${measure(1 / value, "px")}` : "no information");

function cueTable({ cues }: Checked): Markup | undefined {
  const rows = Object.entries(cues).map(
    ([cue, { share, sharpness: sharp }]) =>
      html`<tr><th scope="row">${cueName(cue)} <span class="soft">${Object.hasOwn(MORE, cue) ? MORE[cue] : ""}</span></th><td class="number">${percent(share)}</td><td class="bars">${bar(share)}</td>${cell("Precision", sharpness(sharp))}</tr>`,
  );
  return rows.length === 0
    ? undefined
    : section("What the verdict rests on", table("shares", ["Cue", "Share", "", "Precision"], rows));
}

function frameTable({ frames }: Checked): Markup | undefined {
  const rows = frames.map(
    ({ name, share, note }) =>
      html`<tr><th scope="row">${name}</th><td class="number">${percent(share)}</td><td class="bars">${bar(share)}</td><td>${note}</td></tr>`,
  );
  return rows.length === 0 ? undefined : section("Frames", table("shares", ["Frame", "Share", "", "Note"], rows));
}

function sensitivitySection({ sensitivity }: Checked): Markup | undefined {
  const panels = sensitivities(sensitivity.map((row) => ({ ...row, cue: cueName(row.cue) })));
  if (panels.length === 0) return undefined;
  return section(
    "Sensitivity",
    html`<p class="soft">Loss of likelihood of each cue when the best fit is moved along one axis, with the other axes fixed. Height: sigmas, the square
root of twice the fall of the log likelihood, drawn up to 8. Triangles mark the optimum of a cue, bars under the axis its 95 % interval,
where its curve is below the dashed line.</p><div class="panels">${panels}</div>`,
  );
}

/** The sections are closed by default, so that a printed report has one page. */
export const details = (report: Checked, more: Markup | undefined): Markup =>
  html`<details><summary>Details: calibrations, cues, frames, sensitivity, covariance</summary>${[
    ...[candidateTable(report), more, cueTable(report), frameTable(report)],
    ...[sensitivitySection(report), covarianceSection(report)],
  ]}</details>`;
