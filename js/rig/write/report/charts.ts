/** The report's drawings as inline SVG: bars, and small multiples of the sensitivity curves. */
import type { CheckReport } from "../../../types/index.js";
import { type Curve, SIGMAS_95, curve } from "./curves.js";
import { type Markup, html } from "./markup.js";
import { brief, digits, measure } from "./numbers.js";

type Axis = CheckReport["sensitivity"][number]["axis"];

const AXES: readonly { axis: Axis; title: string; unit: string }[] = [
  { axis: "rx", title: "Rotation about x", unit: "°" },
  { axis: "ry", title: "Rotation about y", unit: "°" },
  { axis: "rz", title: "Rotation about z", unit: "°" },
  { axis: "tx", title: "Shift along x", unit: "mm" },
  { axis: "ty", title: "Shift along y", unit: "mm" },
  { axis: "tz", title: "Shift along z", unit: "mm" },
];

/** Largest height that a panel shows, sigmas: higher offsets are excluded anyway. */
export const MOST_SIGMAS = 8;

/** Line styles that the style sheet distinguishes. */
const SERIES = 5;

/** A share of a whole, 0 .. 1. */
export const bar = (share: number): Markup =>
  html`<svg class="bar" viewBox="0 0 100 8" preserveAspectRatio="none" aria-hidden="true"><rect class="track" width="100" height="8"/><rect class="fill" width="${Math.min(100, Math.max(0, 100 * share)) || 0}" height="8"/></svg>`;

/** A step of 1, 2 or 5 times a power of ten that divides a range into at most five parts. */
function step(range: number): number {
  const power = 10 ** Math.floor(Math.log10(range / 5));
  return ([1, 2, 5].find((times) => range / (times * power) <= 5) ?? 10) * power;
}

function ticks(from: number, to: number): number[] {
  const by = step(to - from);
  const first = Math.ceil(from / by - 1e-9);
  const count = Math.floor(to / by + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, k) => (first + k) * by);
}

/** Lengths of a panel in its units. They have names where they are used, because a list is a smaller download. */
const PANEL = [320, 200, 26, 10, 10, 40, 5, 3, 32] as const;

const at = (value: number): string => value.toFixed(2);

interface Line {
  cue: string;
  series: number;
  curve: Curve;
}

/** The part of a line within the panel, cut at its border. Each piece inside is one stroke, so that its dashes continue. */
function path({ points }: Curve, x: (offset: number) => string, y: (height: number) => string): string {
  type Point = (typeof points)[number];
  const place = ({ offset, height }: Point) => `${x(offset)} ${y(height)}`;
  const cut = (inside: Point, outside: Point) => {
    const part = (MOST_SIGMAS - inside.height) / (outside.height - inside.height);
    return { offset: inside.offset + part * (outside.offset - inside.offset), height: MOST_SIGMAS };
  };
  const isOut = ({ height }: Point) => height > MOST_SIGMAS;
  const strokes = points.map((to, index) => {
    const from = points[index - 1];
    if (from === undefined) return isOut(to) ? "" : `M${place(to)}`;
    if (isOut(from)) return isOut(to) ? "" : `M${place(cut(to, from))}L${place(to)}`;
    return `L${place(isOut(to) ? cut(from, to) : to)}`;
  });
  return strokes.join("");
}

/** Best offset and 95 % interval in words, as far as the curve's range shows them. */
function says({ points, best, from, to }: Curve, unit: string): string {
  const [first = NaN, last = NaN] = [points[0]?.offset, points.at(-1)?.offset];
  if (from === undefined && to === undefined)
    return `not constrained from ${brief(first)} to ${brief(last)}${unit === "°" ? unit : ` ${unit}`}`;
  const least = from === undefined ? `below ${brief(first)}` : digits(from, 2);
  const most = to === undefined ? `above ${brief(last)}` : digits(to, 2);
  // Beyond the end of the range the likelihood may rise further.
  const where = best === first || best === last ? "the minimum is at the end of the range or beyond, " : "";
  return `${where}${measure(best, unit, 2)} (${least} to ${most})`;
}

function panel(title: string, unit: string, lines: readonly Line[]): Markup {
  const [width, height, left, right, top, bottom, mark, between, under] = PANEL;
  const all = lines.flatMap((line) => line.curve.points.map(({ offset }) => offset));
  const [first, last] = [Math.min(...all), Math.max(...all)];
  const x = (offset: number) => at(left + ((offset - first) / (last - first || 1)) * (width - left - right));
  const y = (sigmas: number) => at(height - bottom - (sigmas / MOST_SIGMAS) * (height - top - bottom));
  const words = lines.map(({ cue, series, curve: found }) => ({ cue, series, text: says(found, unit) }));
  return html`<figure class="panel"><figcaption>${title} <span class="soft">(${unit})</span></figcaption>
<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="${title}: ${words.map(({ cue, text }) => `${cue} ${text}`).join("; ")}">
${[0, 2, 4, 6, 8].map((sigmas) => html`<path class="grid" d="M${left} ${y(sigmas)}H${width - right}"/><text class="tick" x="${left - 5}" y="${Number(y(sigmas)) + 4}" text-anchor="end">${sigmas}</text>`)}
${ticks(first, last).map((tick) => html`<path class="grid" d="M${x(tick)} ${top}V${y(0)}"/><text class="tick" x="${x(tick)}" y="${height - bottom + under}" text-anchor="middle">${brief(tick)}</text>`)}
<path class="level" d="M${left} ${y(SIGMAS_95)}H${width - right}"/>
${lines.map(({ series, curve: found }) => html`<path class="series s${series}" d="${path(found, x, y)}"/>`)}
${lines.map(({ series, curve: { best, from, to } }) => {
  if (from === undefined && to === undefined) return undefined;
  // The marks are in separate lines under the axis, so that none hides another.
  const level = Number(y(0)) + 2 + between * series;
  return html`<path class="width s${series}" d="M${x(from ?? first)} ${level}H${x(to ?? last)}"/><path class="best s${series}" d="M${x(best)} ${y(0)}l-${mark} -${2 * mark}h${2 * mark}z"/>`;
})}
</svg>
<ul class="says">${words.map(({ cue, series, text }) => html`<li><svg class="key" viewBox="0 0 24 8" aria-hidden="true"><path class="series s${series}" d="M0 4H24"/></svg> ${cue}: ${text}</li>`)}</ul></figure>`;
}

/** One panel for each axis that has curves, one line for each cue; a cue has the same line style in all of them. */
export function sensitivities(sensitivity: CheckReport["sensitivity"]): Markup[] {
  const cues = [...new Set(sensitivity.map(({ cue }) => cue))];
  return AXES.flatMap(({ axis, title, unit }) => {
    const lines = sensitivity.flatMap((row) => {
      const found = row.axis === axis ? curve(row.offsets, row.values) : undefined;
      return found ? [{ cue: row.cue, series: (cues.indexOf(row.cue) % SERIES) + 1, curve: found }] : [];
    });
    return lines.length > 0 ? [panel(title, unit, lines)] : [];
  });
}
