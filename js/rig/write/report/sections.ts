/** The parts of a report's first page, each a section of HTML or nothing. */
import type { CandidateReport } from "../../../types/index.js";
import type { Checked, ReportEntry, ReportOptions } from "./contents.js";
import { type Markup, html } from "./markup.js";
import { fixed, measure, percent, span } from "./numbers.js";
import { cell, clamped, fact, firstOf, section, sign, table } from "./parts.js";
import { sigmasOf, valuesOf } from "./unknowns.js";
import { SIGMAS_95 } from "./curves.js";
import { placeInWords, verdictOf, verdictReason, verdictWords, wordOf } from "./words.js";

/** Numbers of warnings, and of other candidates, that fit on the first page. */
const [MOST_WARNINGS, MOST_OTHERS] = [3, 2];

const within = (interval: readonly [number, number]): string => `95\u202f%: ${span(interval, "px")}`;

/** The verdict with its number, which comes first. */
export function verdictHeader(report: Checked, title: string, date: string | undefined, isEstimate = false): Markup {
  const verdict = isEstimate ? "undecided" : verdictOf(report.verdict);
  const [[name, candidate] = []] = Object.entries(report.candidates);
  const { pixels, interval } = (isEstimate ? undefined : candidate) ?? report.health;
  const subject = [
    title,
    ...(name === undefined || isEstimate || String(title).includes(name) ? [] : [name]),
    ...(date ? [date] : []),
  ];
  return html`<header class="card ${verdict}">${sign(verdict)}<div><h1 class="verdict">${verdictWords(report, isEstimate)}: ${
    candidate && !isEstimate ? "expected reprojection error" : "expected error of the best fit"
  } ${measure(pixels, "px")} <span class="interval">(${within(interval)})</span></h1>
<div class="subject">${clamped(subject.join(" \u00b7 "))}</div></div></header>`;
}

const CUES: Readonly<Record<string, string>> = {
  shading: "Shading",
  edges: "Edges",
  information: "Information",
  silhouette: "Silhouettes",
};
export const cueName = (cue: string): string => (Object.hasOwn(CUES, cue) ? CUES[cue] : undefined) ?? cue;

/** An unknown pose gives no place. */
const isKnown = ({ rotation, translation }: Placed): boolean =>
  rotation.length === 9 && translation.length === 3 && [...rotation, ...translation].every(Number.isFinite);

/** The place of the depth camera under the calibration in question and under the best fit. */
function places({ estimate }: Checked, given: Calibration | undefined): Markup[] {
  const all = [["The calibration in question", given] as const, ["The best fit", estimate] as const];
  return all.flatMap(([name, pose]) => (pose && isKnown(pose) ? [html`<p>${name}: ${placeInWords(pose)}</p>`] : []));
}

type Placed = Pick<Calibration, "rotation" | "translation">;
type Calibration = NonNullable<ReportOptions["calibrations"]>[string];

/** The calibration in question, if the caller has passed its numbers. */
export function inQuestion(
  { candidates }: Checked,
  { calibrations = {}, isEstimate }: ReportOptions,
): Calibration | undefined {
  const [name = ""] = Object.keys(candidates);
  return !isEstimate && Object.hasOwn(calibrations, name) ? calibrations[name] : undefined;
}

function others({ candidates }: Checked): Markup[] {
  const say = ([name, found]: [string, CandidateReport]) =>
    html`<p class="clamp">Compared with it: ${name}: <strong class="word ${verdictOf(found.verdict)}">${wordOf(found.verdict)}</strong>, ${measure(found.pixels, "px")} (${within(found.interval)})</p>`;
  return firstOf(Object.entries(candidates).slice(1), MOST_OTHERS, say, (words) => html`<p>${words}</p>`);
}

export function summary(report: Checked, options: ReportOptions): Markup {
  const { candidates, health, overlap, cues, next } = report;
  const candidate = options.isEstimate ? undefined : Object.values(candidates)[0];
  const rests = Object.entries(cues).map(([cue, { share }]) => `${cueName(cue)} ${percent(share)}`);
  return html`<section>${clamped(verdictReason(report))}${places(report, inQuestion(report, options))}${
    options.isEstimate ? undefined : others(report)
  }<dl class="facts">${
    candidate &&
    fact(
      "Offset at the scene's centre",
      `${measure(candidate.offDegrees, "\u00b0")}, ${measure(candidate.offMillimetres, "mm")}`,
    )
  }${fact("Error of the best fit", measure(health.pixels, "px"), within(health.interval))}${fact(
    "Overlap",
    percent(overlap),
    "of the depth points lie on the image",
  )}${fact("Evidence", rests.join(", "))}</dl>${next && html`<p>${next.message}</p>`}</section>`;
}

export function warningList({ warnings }: Checked): Markup {
  const said = warnings.map((warning) => (typeof warning === "string" ? warning : warning.message));
  return section(
    "Warnings",
    said.length === 0
      ? html`<p>None: nothing was guessed, and nothing looks wrong.</p>`
      : html`<ul class="warnings">${firstOf(
          said,
          MOST_WARNINGS,
          (each) => html`<li>${clamped(each)}</li>`,
          (words) => html`<li>${words}</li>`,
        )}</ul>`,
  );
}

const UNKNOWNS = [
  ...["x", "y", "z"].map((axis) => ({ name: `Rotation about ${axis}`, unit: "\u00b0", decimals: 3 })),
  ...["x", "y", "z"].map((axis) => ({ name: `Translation ${axis}`, unit: "mm", decimals: 2 })),
];
const COLUMNS = ["Unknown", "Candidate", "Found", "Difference", "95\u202f% interval", "Unit"];

/** The angle of the shorter way around. */
const around = (degrees: number): number => degrees - 360 * Math.round(degrees / 360);

/** Each unknown: candidate, found value and difference, with half of the found value's interval. */
function unknownsOf(report: Checked, given: Calibration | undefined) {
  const found = valuesOf(report.estimate);
  const sigmas = sigmasOf(report);
  const candidate = given && valuesOf(given);
  return UNKNOWNS.map((unknown, k) => {
    const [value = NaN, half = NaN] = [found[k], SIGMAS_95 * (sigmas[k] ?? NaN)];
    const off = (candidate?.[k] ?? NaN) - value;
    return { ...unknown, value, half, given: candidate?.[k], difference: k < 3 ? around(off) : off };
  });
}
type Unknown = ReturnType<typeof unknownsOf>[number];

const CORRELATED =
  "The six unknowns are correlated: a calibration can be excluded although each of its six values lies within its own 95\u202f% interval.";

/** Said where it happens, because the verdict and the table would seem to contradict each other. */
function correlated({ candidates }: Checked, unknowns: readonly Unknown[]): Markup | undefined {
  const isOff = Object.values(candidates)[0]?.verdict === "off";
  return isOff && unknowns.every(({ difference, half }) => Math.abs(difference) <= half)
    ? html`<p>${CORRELATED}</p>`
    : undefined;
}

function unknownTable(unknowns: readonly Unknown[]): Markup {
  const rows = unknowns.map(({ name, unit, decimals, value, half, given, difference }) => {
    const show = (number: number) => fixed(number, decimals);
    const range = Number.isFinite(half) ? `${show(value - half)} to ${show(value + half)}` : show(half);
    const isOutside = Math.abs(difference) > half;
    const cells = [
      given === undefined ? "\u2013" : show(given),
      show(value),
      given !== undefined ? (isOutside ? html`<strong>${show(difference)}</strong>` : show(difference)) : "\u2013",
      range,
      unit,
    ];
    return html`<tr><th scope="row">${name}</th>${cells.map((each, index) => cell(COLUMNS[index + 1] ?? "", each))}</tr>`;
  });
  return table("unknowns stacks", COLUMNS, rows);
}

/** Nanometres and nanoradians, so that a copied matrix keeps the precision of the calibration. */
const COPIED = 9;

/** The matrix as four rows that programs can read. */
function matrix({ rotation: r, translation: t }: Placed): Markup {
  const shown = (value: number) => (Number.isFinite(value) ? value.toFixed(COPIED) : "?").padStart(COPIED + 4);
  const rows = [0, 1, 2].map((i) => [0, 1, 2, 3].map((j) => shown((j < 3 ? r[3 * i + j] : t[i]) ?? NaN)).join(""));
  return html`<pre tabindex="0">${[...rows, "  0 0 0 1"].join("\n")}</pre>`;
}

export function extrinsicsSection(report: Checked, options: ReportOptions): Markup {
  const given = inQuestion(report, options);
  const unknowns = unknownsOf(report, given);
  return section(
    "Extrinsics",
    html`<div class="extrinsics"><div>${unknownTable(unknowns)}${correlated(report, unknowns)}<p class="soft">Rotation: R = Rx Ry Rz. Interval: that of the value found. Bold: the candidate lies outside it.</p></div>
<div>${given && html`<h3>Candidate</h3>${matrix(given)}`}<h3>Found</h3>${matrix(report.estimate)}<p class="soft">P_colour = R P_depth + t, metres; x right, y down, z forward.</p></div></div>`,
  );
}

const entries = (name: string, all: readonly ReportEntry[]): Markup | undefined =>
  all.length === 0 ? undefined : html`<p>${name}: ${all.map(([key, value]) => `${key} ${value}`).join("; ")}.</p>`;

export function shellSection({ shell, settings = [], versions = [] }: ReportOptions): Markup | undefined {
  if (!shell && settings.length + versions.length === 0) return undefined;
  return section(
    "How to reproduce it",
    shell && [
      shell.command ? html`<pre class="shell" tabindex="0">${shell.command}</pre>` : undefined,
      shell.note ? html`<p>${shell.note}</p>` : undefined,
    ],
    entries("Options", settings),
    entries("Versions", versions),
  );
}
