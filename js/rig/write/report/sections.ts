/** The parts of a report, each a section of HTML or nothing. */
import type { CandidateReport, CheckVerdict } from "../../../types/index.js";
import { bar, intervals, sensitivities } from "./charts.js";
import type { Checked } from "./contents.js";
import { type Markup, html } from "./markup.js";
import { digits, measure, percent, probability, span } from "./numbers.js";
import { cell, fact, section, sign, table } from "./parts.js";

const WORDS: Readonly<Record<CheckVerdict, string>> = { consistent: "Consistent", off: "Off", undecided: "Undecided" };

const verdictOf = (verdict: CheckVerdict): CheckVerdict => (Object.hasOwn(WORDS, verdict) ? verdict : "undecided");

const within = (interval: readonly [number, number]): string => `95\u202f%: ${span(interval, "px")}`;

export function verdictCard({ verdict: given, reason, candidates, health, overlap }: Checked): Markup {
  const verdict = verdictOf(given);
  const [first] = Object.entries(candidates);
  const [name, candidate] = first ?? [];
  return html`<section class="card ${verdict}">${sign(verdict)}<div><p class="verdict">${WORDS[verdict]}${name === undefined ? undefined : html`<span class="name">${name}</span>`}</p>
<p>${reason}</p><dl class="facts">${
    candidate && [
      fact(
        "Offset from the best fit, at the centre of the scene",
        `${measure(candidate.offDegrees, "°")}, ${measure(candidate.offMillimetres, "mm")}`,
      ),
      fact("Expected reprojection error", measure(candidate.pixels, "px"), within(candidate.interval)),
    ]
  }${fact("Expected error of the best fit", measure(health.pixels, "px"), within(health.interval))}${fact(
    "Depth points that the best fit puts onto the image",
    percent(overlap),
  )}</dl></div></section>`;
}

export const warningList = ({ warnings }: Checked): Markup =>
  section(
    "Warnings",
    warnings.length === 0
      ? html`<p>None: nothing was guessed, and nothing looks wrong.</p>`
      : html`<ul class="warnings">${warnings.map((warning) => html`<li>${typeof warning === "string" ? warning : warning.message}</li>`)}</ul>`,
  );

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
  const verdict = verdictOf(found.verdict);
  const number = (text: string) => html`<span class="number">${text}</span>`;
  const values = [
    html`<strong class="word ${verdict}">${WORDS[verdict]}</strong>`,
    ...[measure(found.offDegrees, "°"), measure(found.offMillimetres, "mm"), measure(found.pixels, "px")].map(number),
    ...[number(span(found.interval, "px")), number(probability(found.probability)), found.reason],
  ];
  return html`<tr><th scope="row">${name}</th>${values.map((value, index) => cell(CANDIDATE_COLUMNS[index + 1] ?? "", value))}</tr>`;
}

export function candidateTable({ candidates, health }: Checked): Markup {
  const rows = Object.entries(candidates);
  const drawn = [
    ...rows.map(([name, { pixels, interval }]) => ({ name, value: pixels, interval, isEstimate: false })),
    { name: "best fit", value: health.pixels, interval: health.interval, isEstimate: true },
  ];
  return section(
    "Calibrations compared",
    rows.length > 0
      ? table(
          "candidates stacks",
          CANDIDATE_COLUMNS,
          rows.map(([name, found]) => candidateRow(name, found)),
        )
      : undefined,
    intervals(drawn),
    html`<p class="soft">Rotation and shift: relative to the best fit, the shift at the centre of the scene. Expected error: the distance in the
colour image between the projection of a scene point and its true place, at the scene's depth. Probability: that of a result at least this far
from the best fit if the calibration were right.</p>`,
  );
}

const AXES = ["x", "y", "z"];
const DEGREES = 180 / Math.PI;
const MILLIMETRES = 1000;

/** One sigma of each unknown: degrees, then millimetres. */
function sigmas(covariance: readonly number[]): number[] {
  return Array.from({ length: 6 }, (_, k) => Math.sqrt(covariance[7 * k] ?? NaN) * (k < 3 ? DEGREES : MILLIMETRES));
}

const named = (values: readonly number[], unit: string, about: string): string =>
  values.map((value, axis) => `${measure(value, unit)} ${about} ${AXES[axis]}`).join(", ");

function worst(values: readonly number[]): string | undefined {
  const most = Math.max(...values);
  return Number.isFinite(most) ? AXES[values.indexOf(most)] : undefined;
}

/** All digits, to be copied. */
const exact = (value: number): string => (Number.isFinite(value) ? String(value) : "?");

const COVARIANCE = ["rotation x", "rotation y", "rotation z", "shift x", "shift y", "shift z"];

export function estimateSection({ estimate, covariance }: Checked): Markup {
  const { rotation: r, translation: t, angles } = estimate;
  const known = sigmas(covariance);
  const [turn, shift] = [known.slice(0, 3), known.slice(3)];
  const [axis, along] = [worst(turn), worst(shift)];
  const weakest = axis && along ? `The rotation about ${axis} and the shift along ${along} are the least certain.` : "";
  const rows = [0, 1, 2].map((i) => [...r.slice(3 * i, 3 * i + 3), t[i] ?? NaN].map(exact).join("  "));
  return section(
    "The best fit",
    html`<dl class="facts">${fact("Translation", t.map((metres) => measure(MILLIMETRES * metres, "mm")).join(", "))}${fact(
      "Angles of R = Rx Ry Rz",
      [angles.alpha, angles.beta, angles.gamma].map((angle) => measure(angle, "°")).join(", "),
    )}</dl>`,
    html`<p>One sigma: ${named(turn, "°", "about")}; ${named(shift, "mm", "along")}. ${weakest}</p>`,
    html`<pre tabindex="0">${[...rows, "0  0  0  1"].join("\n")}</pre>`,
    html`<p class="soft">P_colour = R P_depth + t, metres; x right, y down, z forward.</p>`,
    html`<h3>Covariance</h3><div class="scroll" tabindex="0">${table(
      "matrix",
      ["", ...COVARIANCE],
      COVARIANCE.map(
        (name, i) =>
          html`<tr><th scope="row">${name}</th>${COVARIANCE.map((_, j) => html`<td>${digits(covariance[6 * i + j] ?? NaN)}</td>`)}</tr>`,
      ),
    )}</div><p class="soft">For a rotation vector in rad about the scene's centre, then a translation in m, in the colour camera's frame.</p>`,
  );
}

/** What the cues are called, and what they are. */
const CUES: Readonly<Record<string, readonly [name: string, more: string]>> = {
  shading: ["Shading", "lighting of the surface's slopes"],
  edges: ["Edges", "depth edges on image edges"],
  information: ["Information", "mutual information of colour and shape"],
  silhouette: ["Silhouettes", "object contours in both views"],
};

const about = (cue: string): readonly [name: string, more: string] =>
  (Object.hasOwn(CUES, cue) ? CUES[cue] : undefined) ?? [cue, ""];

const sharpness = (value: number): string => (value > 0 ? `± ${measure(1 / value, "px")}` : "no information");

export function cueTable({ cues }: Checked): Markup | undefined {
  const rows = Object.entries(cues).map(
    ([cue, { share, sharpness: sharp }]) =>
      html`<tr><th scope="row">${about(cue)[0]} <span class="soft">${about(cue)[1]}</span></th><td class="number">${percent(share)}</td><td class="bars">${bar(share)}</td>${cell("Precision", sharpness(sharp))}</tr>`,
  );
  return rows.length === 0
    ? undefined
    : section("What the verdict rests on", table("shares", ["Cue", "Share", "", "Precision"], rows));
}

export function frameTable({ frames }: Checked): Markup | undefined {
  const rows = frames.map(
    ({ name, share, note }) =>
      html`<tr><th scope="row">${name}</th><td class="number">${percent(share)}</td><td class="bars">${bar(share)}</td><td>${note}</td></tr>`,
  );
  return rows.length === 0 ? undefined : section("Frames", table("shares", ["Frame", "Share", "", "Note"], rows));
}

export function sensitivitySection({ sensitivity }: Checked): Markup | undefined {
  const panels = sensitivities(sensitivity.map((row) => ({ ...row, cue: about(row.cue)[0] })));
  if (panels.length === 0) return undefined;
  return section(
    "Sensitivity",
    html`<p class="soft">Loss of likelihood of each cue when the best fit is moved along one axis, with the other axes fixed. Height: sigmas, the square
root of twice the fall of the log likelihood, drawn up to 8. Triangles mark the optimum of a cue, bars under the axis its 95 % interval,
where its curve is below the dashed line.</p><div class="panels">${panels}</div>`,
  );
}
