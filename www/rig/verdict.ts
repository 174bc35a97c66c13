/** The result of the check in words: the verdict, what to do next, the tables. */

import type { CandidateReport, CheckReport, Warning } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";
import { make } from "../dom";
import { svg } from "./parts";
import { isUncertain, isUsable, placement } from "./placement";
import type { Run } from "./rig";
import { resultsOf, verdictReason, verdictWords, whole } from "./words";

export type Tone = "good" | "wrong" | "open";

const SHAPES: Record<Tone, readonly string[]> = {
  good: ["M7 12.5l3.5 3.5L17.5 8.5"],
  wrong: ["M8 8l8 8M16 8l-8 8"],
  open: ["M9 9.2a3 3 0 1 1 4.2 2.8c-.9.4-1.2 1-1.2 1.9", "M12 17v.2"],
};

/** The mark of a verdict. The marks differ in shape, not only in colour. */
export function icon(tone: Tone): SVGElement {
  return svg(
    "svg",
    { viewBox: "0 0 24 24", class: `rig-icon ${tone}`, "aria-hidden": "true" },
    svg(
      tone === "good" ? "circle" : "rect",
      tone === "good" ? { cx: 12, cy: 12, r: 10 } : { x: 2, y: 2, width: 20, height: 20, rx: tone === "open" ? 10 : 4 },
    ),
    ...SHAPES[tone].map((d) => svg("path", { d })),
  );
}

const WORDS: Record<CheckReport["verdict"], { word: string; tone: Tone }> = {
  consistent: { word: "Consistent", tone: "good" },
  off: { word: "Off", tone: "wrong" },
  undecided: { word: "Undecided", tone: "open" },
};

const px = (value: number, most = Infinity): string =>
  value > most ? "outside the picture" : `${decimals(value, 2)} px`;
const interval = ([low, high]: [number, number], most = Infinity): string =>
  low > most
    ? "outside the picture"
    : high > most
      ? `${px(low)} to outside the picture`
      : `${decimals(low, 2)} to ${decimals(high, 2)} px`;

/** A guess caps the verdict, because the files do not justify a better one. */
function headline(run: Run): { word: string; tone: Tone; sentence: string } {
  const report = whole(run);
  const { diagonal } = run;
  const { pixels, interval: range } = report.health;
  const word = verdictWords(report, run.estimateOnly);
  if (run.estimateOnly)
    return {
      word,
      tone: "open",
      sentence: `A calibration was found; expected reprojection error ${px(pixels, diagonal)} (95 %: ${interval(range, diagonal)}) at the scene's depth.`,
    };
  return { word, tone: WORDS[report.verdict].tone, sentence: verdictReason(report) };
}

/** A whole sentence for use beside the controls, where a single word would read like the state of a switch. */
export const ending = (run: Run): string => `The check is done. Verdict: ${headline(run).word}.`;

/** A frame whose share is below this fraction of the mean share adds little. */
const LITTLE = 0.3;

const SWAPPED = "Check step 1: colour image and depth map seem to be swapped.";
/** The advice for each warning about the files, the most useful first. */
const ADVICE: readonly [code: string, advice: string][] = [
  [
    "eight-bits",
    "Record the depth map itself with 16 bits: a colour-coded or 8-bit picture of it is too coarse for a calibration.",
  ],
  ["files-swapped", SWAPPED],
  ["rough-depth", SWAPPED],
  [
    "camera-size",
    "Use camera parameters that belong to the size of the files; check frames of another size, or of another rig, separately.",
  ],
];

/** The calibration that a warning of the check is about. */
const aboutOf = ({ field = "" }: Warning): string => field.replace(/^candidates\./, "");

/** Advice about calibrations that fit inverted: first about the one of the verdict, then about others by their names. */
function invert({ report }: Run, name: string): { own: string[]; others: string[] } {
  const names = new Set(report.warnings.filter(({ code }) => code === "fits-inverted").map(aboutOf));
  const own = names.delete(name) ? [`Invert “${name}” in step 2 and check again: it seems to be the inverse.`] : [];
  const others = [...names].map(
    (other) =>
      `About “${other}”, which this verdict is not about: invert it in step 2 and check again, because it seems to be an inverse.`,
  );
  return { own, others };
}

/** What to do with the best fit if the calibration is off. */
function replace(run: Run, name: string): string {
  const { report, diagonal } = run;
  const { pixels, interval: range } = report.health;
  if (!isUncertain(run))
    return `Save the calibration found here, use it instead of “${name}”, and check it with new frames.`;
  const more = report.next?.message ?? "Add frames of a scene with edges near and far.";
  return `Do not use the best fit instead of “${name}”: it is itself too uncertain, ${px(pixels, diagonal)} (95 %: ${interval(range, diagonal)}; the limit is ${decimals(report.tolerance, 1)} px). ${more}`;
}

/** What to do next, the most useful first. Advice on a calibration names it, because there may be several. */
export function advise(run: Run): string[] {
  const { report, plans, estimateOnly, guessed, doubts, candidates } = run;
  const codes = new Set([...doubts, ...report.warnings].map(({ code }) => code));
  const name = Object.keys(candidates)[0] ?? "";
  const { own, others } = invert(run, name);
  const list = [...own, ...ADVICE.flatMap(([code, advice]) => (codes.has(code) ? [advice] : []))];
  const isOpen = report.verdict === "undecided" && Object.values(report.candidates)[0]?.verdict === "undecided";
  const confirm = guessed.length > 0 ? [`Confirm the guess in step 1: ${guessed.join("; ")}.`] : [];
  if (!isOpen) list.push(...confirm);
  const isMisread = report.code === "misread";
  const isReplaced = !estimateOnly && report.verdict === "off" && !isMisread && isUsable(run);
  if (!estimateOnly && isMisread)
    list.push(
      `Find out how the file of “${name}” was written. If in the convention that the verdict names, convert it and check again; otherwise treat “${name}” as off.`,
    );
  else if (isReplaced) list.push(replace(run, name));
  // Such a warning keeps the verdict from "consistent".
  if (report.code === "doubtful") list.push(...others.splice(0));
  if (!isUsable(run))
    list.push(
      "Check that image and depth map show the same scene: the best fit leaves most of the depth map outside the image.",
    );
  else if (estimateOnly && isUncertain(run))
    list.push(
      `The best fit is too uncertain to use: ${px(report.health.pixels, run.diagonal)} (95 %: ${interval(report.health.interval, run.diagonal)}; the limit is ${decimals(report.tolerance, 1)} px).`,
    );
  else if (estimateOnly) list.push("Save the calibration found here, or add your own in step 2 to have it checked.");
  if (plans.length < 3 && run.isLidar)
    list.push(
      `Add ${plans.length === 1 ? "two more frames" : "another frame"}: drive on or turn the vehicle, so that other things are near.`,
    );
  else if (plans.length < 3)
    list.push(
      plans.length === 1
        ? "Add two more frames, with the object turned by about 30° each time."
        : "Add another frame, with the object turned by about 30°.",
    );
  // Advice against an uncertain best fit already has the frame to take next.
  if (report.next && !(isReplaced && isUncertain(run))) list.push(report.next.message);
  if (isOpen) list.push(...confirm);
  const mean = 1 / Math.max(1, report.frames.length);
  for (const { name, share, note } of report.frames)
    if (report.frames.length > 1 && share < LITTLE * mean)
      list.push(`Retake ${name}: it contributes little (${(100 * share).toFixed(0)} %)${note ? `, ${note}` : ""}.`);
  const isKept = !estimateOnly && report.verdict === "consistent";
  const keep = isKept ? [`Keep “${name}”, and check again after the rig has been moved, knocked or heated.`] : [];
  return guessed.length + doubts.length === 0 ? [...keep, ...list, ...others] : [...list, ...keep, ...others];
}

export function card(run: Run): HTMLElement {
  const { word, tone, sentence } = headline(run);
  const [next = ""] = advise(run);
  const names = run.estimateOnly ? [] : Object.keys(run.candidates);
  const [count, [name]] = [names.length, names];
  const all = [
    ...run.guessed.map((what) => `Guessed: ${what}.`),
    ...[...run.doubts, ...run.report.warnings].map(({ message }) => message),
  ];
  return make(
    "div",
    { class: `rig-verdict ${tone}`, "data-verdict": run.estimateOnly ? "estimate" : run.report.verdict },
    icon(tone) as unknown as HTMLElement,
    make(
      "div",
      {},
      make("h3", { class: "rig-word", tabindex: "-1" }, word),
      make("p", {}, sentence),
      ...(count > 1
        ? [make("p", { class: "rig-subject soft" }, `This is about “${name}”, the first of ${count} calibrations.`)]
        : []),
      figures(run),
      make("p", { class: "rig-placement soft" }, placement(run)),
      make("p", { class: "rig-next" }, make("strong", {}, "Next: "), next),
      ...(all.length > 0 ? [make("ul", { class: "rig-notes" }, ...all.map((words) => make("li", {}, words)))] : []),
    ),
  );
}

/** The main numbers of the calibration being checked. */
function figures({ report, estimateOnly, diagonal }: Run): HTMLElement {
  const { health } = report;
  const [[name, first] = []] = Object.entries(report.candidates);
  const figure = (value: string, words: string) => make("div", {}, make("dt", {}, words), make("dd", {}, value));
  const found = figure(
    px(health.pixels, diagonal),
    `expected error of the best fit (95 %: ${interval(health.interval, diagonal)})`,
  );
  if (estimateOnly || !first) return make("dl", { class: "rig-figures-row" }, found);
  return make(
    "dl",
    { class: "rig-figures-row" },
    figure(
      `${decimals(first.offDegrees, 2)}° and ${decimals(first.offMillimetres, 1)} mm`,
      "from the best fit; shift at the centre of the scene",
    ),
    figure(px(first.pixels, diagonal), `expected error of “${name}” (95 %: ${interval(first.interval, diagonal)})`),
    found,
  );
}

/** All intervals on one scale, so that they can be compared at a glance. */
function whisker(value: number, [low, high]: [number, number], most: number): HTMLElement {
  const at = (x: number) => `${(100 * Math.min(1, x / most)).toFixed(1)}%`;
  return make(
    "span",
    { class: "rig-whisker", "aria-hidden": "true" },
    make("span", { class: "rig-range", style: `inset-inline: ${at(low)} calc(100% - ${at(high)})` }),
    make("span", { class: "rig-dot", style: `inset-inline-start: ${at(value)}` }),
  );
}

export function candidatesTable(run: Run): HTMLElement {
  const { report, estimateOnly, diagonal } = run;
  const { health } = report;
  const list = resultsOf(whole(run));
  const most = 1.05 * Math.max(health.interval[1], ...list.map(([, { interval }]) => interval[1]), 1e-6);
  const row = (
    name: string,
    words: (Node | string)[],
    off: string,
    shift: string,
    pixels: number,
    range: [number, number],
    reason: string,
  ) => [
    make(
      "tr",
      {},
      make("th", { scope: "row" }, name),
      make("td", {}, ...words),
      make("td", { "data-label": "rotation" }, off),
      make("td", { "data-label": "shift" }, shift),
      make(
        "td",
        { class: "rig-pixels" },
        px(pixels, diagonal),
        make("span", { class: "soft" }, interval(range, diagonal)),
        whisker(pixels, range, most),
      ),
    ),
    ...(reason ? [make("tr", { class: "rig-reason" }, make("td", { colspan: 5 }, reason))] : []),
  ];
  const candidate = ([name, { verdict, reason, offDegrees, offMillimetres, pixels, interval: range, probability }]: [
    string,
    CandidateReport,
  ]) => {
    const { word, tone } = WORDS[verdict];
    // If nothing is known about the pose, any result is as far off as expected.
    const isKnown = probability < 0.99 && pixels <= diagonal;
    const chance = !isKnown
      ? ""
      : `If it were right, a result this far off would occur in ${probability < 0.001 ? "fewer than 0.1" : decimals(100 * probability, 1)} % of checks.`;
    return row(
      name,
      [icon(tone) as unknown as HTMLElement, word],
      `${decimals(offDegrees, 2)}°`,
      `${decimals(offMillimetres, 1)} mm`,
      pixels,
      range,
      `${reason} ${chance}`.trim(),
    );
  };
  const head = ["Calibration", "Verdict", "Rotation", "Shift", "Reprojection error, 95 %"].map((words) =>
    make("th", { scope: "col" }, words),
  );
  return make(
    "section",
    { class: "rig-card" },
    make("h3", {}, "Calibrations"),
    make(
      "p",
      { class: "soft" },
      "Rotation and shift are relative to the calibration found, at the centre of the scene. The error is the expected error at the scene's depth, in pixels of the colour image.",
    ),
    make(
      "div",
      { class: "rig-scroll rig-calibrations-card" },
      make(
        "table",
        { class: "rig-table rig-calibrations" },
        make("thead", {}, make("tr", {}, ...head)),
        make(
          "tbody",
          {},
          ...row("found", ["the best fit"], "–", "–", health.pixels, health.interval, ""),
          ...(estimateOnly ? [] : list.flatMap(candidate)),
        ),
      ),
    ),
  );
}

const bar = (share: number): HTMLElement =>
  make(
    "span",
    { class: "rig-bar", "aria-hidden": "true" },
    make("span", { style: `width: ${(100 * Math.max(0, Math.min(1, share))).toFixed(1)}%` }),
  );
const percent = (share: number): string => `${(100 * share).toFixed(0)} %`;

export function sharesCard(
  { report }: Run,
  history: readonly { frames: number; pixels: number; interval: [number, number] }[],
): HTMLElement {
  const frame = ({ name, share, note }: CheckReport["frames"][number]) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, name),
      make("td", {}, bar(share)),
      make("td", {}, percent(share)),
      make("td", { class: "rig-note" }, note ?? ""),
    );
  const cue = ([name, { share, sharpness }]: [string, { share: number; sharpness: number }]) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, CUES[name] ?? name),
      make("td", {}, bar(share)),
      make("td", {}, percent(share)),
      make("td", {}, sharpness > 0 ? `± ${decimals(1 / sharpness, 2)} px` : "no information"),
    );
  const table = (caption: string, last: string, rows: HTMLElement[]) =>
    make(
      "table",
      { class: "rig-table rig-shares" },
      make("caption", {}, caption),
      make(
        "thead",
        { class: "visually-hidden" },
        make("tr", {}, ...["Name", "As a bar", "Share", last].map((words) => make("th", { scope: "col" }, words))),
      ),
      make("tbody", {}, ...rows),
    );
  const runs = history.map(({ frames, pixels, interval: range }) =>
    make("li", {}, `${frames} ${frames === 1 ? "frame" : "frames"}: ${px(pixels)} (${interval(range)})`),
  );
  return make(
    "section",
    { class: "rig-card" },
    make("h3", {}, "What the verdict rests on"),
    table("Each frame's share of the evidence", "Note", report.frames.map(frame)),
    table("Each cue's share, and its sigma", "Sigma", Object.entries(report.cues).map(cue)),
    ...(runs.length > 1
      ? [make("h4", {}, "Checks so far, with their expected error"), make("ol", { class: "rig-history" }, ...runs)]
      : []),
  );
}

export const CUES: Record<string, string> = {
  shading: "shading",
  edges: "depth edges on image edges",
  information: "shared information",
  silhouette: "silhouettes",
};

export function nextCard(run: Run): HTMLElement {
  return make(
    "section",
    { class: "rig-card" },
    make("h3", {}, "What to do next"),
    make("ol", { class: "rig-advice-list" }, ...advise(run).map((words) => make("li", {}, words))),
  );
}
