/** The report of a run as one self-contained HTML file: pictures, numbers, options and the hashes of the inputs, to be kept and printed. */
import { word } from "../check.js";
import type { Pose, PoseInput } from "../types/index.js";
import { type Example, like } from "../rig/write/built.js";
import type { Picture, ReportInput } from "../rig/write/report/contents.js";
import { type Markup, html } from "../rig/write/report/markup.js";
import { digits, measure } from "../rig/write/report/numbers.js";
import { dateOf, heading, reportPage } from "../rig/write/report/page.js";
import { cell, fact, inputTable, pictureSection, section, sign, table } from "../rig/write/report/parts.js";
import { checkLight, checkUnit, checkedWholePose, text } from "./check.js";
import { type Unit, lightCsv, matrixText } from "./results.js";

export type { Picture, ReportInput };

/** A name and its value. */
export type Entry = readonly [name: string, value: string];

/** The contents of the report of a run. */
export interface RunReport {
  /** The rating of the outcome; "open" if the evidence neither supports nor contradicts it. */
  tone: "good" | "open" | "wrong";
  /** The outcome in one or two words: "converged". */
  status: string;
  /** The outcome in one or a few sentences. */
  words: readonly string[];
  /** The estimated pose. */
  pose: PoseInput;
  /** The true pose, if known. */
  truth?: PoseInput | null | undefined;
  /** The unit of lengths in the colour view. */
  unit: Unit;
  /** The 27 coefficients of the light. */
  light: ArrayLike<number>;
  /** Numbers with their names that are shown beside the status. */
  numbers: readonly Entry[];
  /** Options of the run, in the form in which the report shows them. */
  options: readonly Entry[];
  /** Pictures that are shown below the pose. */
  pictures?: readonly Picture[];
  /** The input files of the run, with their hashes. */
  inputs?: readonly ReportInput[];
  /** The heading, by default "A run of bimodal stereo". */
  title?: string;
  /** The date of the report. If it is absent, the report has no date. */
  made?: Date;
  /** The page's address with the state of the run. */
  link?: string;
}

/** The class of the status's card in the style sheet, for each tone. */
const CARDS = { good: "consistent", open: "undecided", wrong: "off" } as const;

function card({ tone, status, words, numbers }: RunReport): Markup {
  const kind = CARDS[tone];
  return html`<section class="card ${kind}">${sign(kind)}<div><p class="verdict">${status}</p>${words.map((each) => html`<p>${each}</p>`)}
<dl class="facts">${numbers.map(([name, value]) => fact(name, value))}</dl></div></section>`;
}

const COLUMNS = ["", "Found", "True"];

function poseSection({ pose, truth, unit }: Checked): Markup {
  const rows: [string, (pose: Pose) => string][] = [
    ["Scale", ({ scale }) => digits(scale, 5)],
    ...(["alpha", "beta", "gamma"] as const).map((name): [string, (pose: Pose) => string] => [
      name,
      ({ angles }) => measure(angles[name], "°", 4),
    ]),
    ...["x", "y", "z"].map((axis, i): [string, (pose: Pose) => string] => [
      `Translation ${axis}`,
      ({ translation }) => measure(translation[i] ?? NaN, unit, 4),
    ]),
  ];
  const columns = truth ? COLUMNS : COLUMNS.slice(0, 2);
  // An orthographic image does not determine the distance of the object, so this number has no true value.
  const isFree = (name: string) => unit === "px" && name === "Translation z";
  const line = ([name, read]: (typeof rows)[number]) =>
    html`<tr><th scope="row">${name}</th>${cell("Found", read(pose))}${truth ? cell("True", isFree(name) ? "free" : read(truth)) : undefined}</tr>`;
  return section(
    "Pose",
    table("pose", columns, rows.map(line)),
    html`<pre tabindex="0">${matrixText(pose)}</pre>`,
    html`<p class="soft">P_colour = scale R P_depth + t, R = Rx Ry Rz; ${unit === "m" ? "metres" : "pixels"}; x right, y down, z forward. The matrix holds scale R and t.</p>`,
  );
}

const COEFFICIENTS = 9;

function lightSection({ light }: RunReport): Markup {
  const names = ["", ...Array.from({ length: COEFFICIENTS }, (_, k) => `L${k + 1}`)];
  const rows = ["Red", "Green", "Blue"].map(
    (channel, c) =>
      html`<tr><th scope="row">${channel}</th>${names.slice(1).map((_, k) => html`<td>${digits(light[COEFFICIENTS * c + k] ?? NaN)}</td>`)}</tr>`,
  );
  return section(
    "Light",
    html`<div class="scroll" tabindex="0">${table("matrix", names, rows)}</div>`,
    html`<pre tabindex="0">${lightCsv(light)}</pre>`,
  );
}

function optionSection({ options, link }: RunReport): Markup | undefined {
  const rows = options.map(([name, value]) => html`<tr><th scope="row">${name}</th>${cell("Set to", value)}</tr>`);
  if (rows.length === 0 && link === undefined) return undefined;
  return section(
    "Options",
    rows.length > 0 ? table("options", ["Option", "Set to"], rows) : undefined,
    link === undefined
      ? undefined
      : html`<p class="soft">The same state as an address, without files:</p><pre tabindex="0">${link}</pre>`,
  );
}

const PARTS: Example = { words: [], numbers: [[]], options: [[]] };
const checkTone = word(...Object.keys(CARDS));

/** The report with its poses as members. */
type Checked = RunReport & { pose: Pose; truth?: Pose | null | undefined };

/** Checks that the required parts are present, and that words are strings. */
function checkedReport(report: RunReport): Checked {
  like(PARTS, report, "report");
  const {
    tone,
    status,
    words,
    pose,
    truth,
    unit,
    light,
    numbers,
    options,
    title = "",
    link = "",
    pictures = [],
    inputs = [],
  } = report;
  checkTone(tone, "report.tone");
  checkUnit(unit, "report.unit");
  const found = checkedWholePose(pose, "report.pose");
  const known = truth === undefined || truth === null ? undefined : checkedWholePose(truth, "report.truth");
  checkLight(light, "report.light");
  for (const [name, value] of Object.entries({ status, title, link })) text(value, `report.${name}`);
  words.forEach((each, index) => text(each, `report.words[${index}]`));
  for (const [name, entries] of Object.entries({ numbers, options })) {
    entries.forEach((entry, index) => [0, 1].forEach((at) => text(entry[at], `report.${name}[${index}][${at}]`)));
  }
  like([{}], pictures, "report.pictures");
  pictures.forEach(({ title }, index) => text(title, `report.pictures[${index}].title`));
  like([{}], inputs, "report.inputs");
  inputs.forEach(({ says = "" }, index) => text(says, `report.inputs[${index}].says`));
  return { ...report, pose: found, truth: known };
}

/** The report of a run as one HTML file without scripts. */
export function runReportHtml(given: RunReport): string {
  const report = checkedReport(given);
  const { pictures = [], inputs = [], title = "A run of bimodal stereo", made } = report;
  return reportPage(title, heading(title, dateOf(made, "report.made")), [
    card(report),
    poseSection(report),
    pictureSection(pictures),
    lightSection(report),
    optionSection(report),
    inputTable(inputs),
  ]);
}
