/** Curves in a box with two axes, drawn as SVG so that they take the page's colours. */

import { make } from "../dom";
import { short } from "./digits";
import type { Panel, PlotPanel } from "./protocol";
import { svg } from "./svg";

/** The size of the drawing, which is as wide as its place: scaling it would make its type too small in a narrow place. */
const WIDTH = 320;
/** Landscape format if there is room, not too low to be legible and not higher than a screen. */
const heightOf = (width: number): number =>
  Math.round(Math.max(Math.min(width, 200), Math.min(0.5 * width, 280, 0.28 * innerHeight)));
/** Margins between the axes and the edges; the left one also holds the numbers of the vertical axis. */
const MARGIN = { left: 22, top: 8, right: 14, bottom: 36 };
/** Width of a character of an axis, at least. */
const CHARACTER = 7.5;
/** Steps between the numbers of an axis, and of one of angles. */
const ROUND = [10, 5, 2, 1, 0.5];
const ANGLES = [90, 60, 30, 15, 10, 5];
/** Height of the type for which the margins are set, px; with larger type, on slides, everything is enlarged. */
const TYPE = 11;
/** Smallest distance between the numbers of the horizontal axis, with room for four characters. */
const LEAST_ROOM = 28;
/** Number of ticks on an axis of a given length, each with room for its number. */
const marks = (length: number, room: number): number => Math.max(2, Math.min(6, Math.floor(length / room)));

interface Span {
  least: number;
  most: number;
}

function spanOf(values: number[], range?: readonly [number, number]): Span {
  const finite = [...values.filter(Number.isFinite), ...(range ?? [])];
  const [least, most] = [Math.min(...finite), Math.max(...finite)];
  if (!Number.isFinite(least)) return { least: 0, most: 1 };
  return most > least ? { least, most } : { least: least - 0.5, most: most + 0.5 };
}

/** Round numbers within a range, about as many as requested and at least two, because a single one gives no scale. */
function ticks({ least, most }: Span, count: number, hasAngles = false): number[] {
  const rough = (most - least) / (hasAngles ? 2 * count : count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const steps = hasAngles ? ANGLES : ROUND.map((each) => each * power);
  const within = (step: number): number[] => {
    const first = Math.ceil(least / step - 1e-9);
    return Array.from({ length: Math.floor(most / step + 1e-9) - first + 1 }, (_, i) =>
      Number(((first + i) * step).toPrecision(12)),
    );
  };
  const coarse = steps.findLastIndex((step) => step >= rough);
  return (
    steps
      .slice(Math.max(0, coarse))
      .map(within)
      .find((all) => all.length > 1) ?? []
  );
}

export class Plot {
  readonly element: HTMLElement;
  readonly #title = make("figcaption", {});
  readonly #drawing = svg("svg", { role: "img", class: "learn-plot" });
  readonly #box = make("div", { class: "learn-plot-box" }, this.#drawing);
  readonly #legend = make("p", { class: "learn-legend learn-keys" });
  #panel: PlotPanel | undefined;
  #width = 0;
  #height = 0;

  constructor() {
    this.element = make("figure", { class: "learn-panel learn-wide" }, this.#title, this.#box, this.#legend);
    const observer = new ResizeObserver(() => this.#fit());
    for (const part of [this.element, this.#box]) observer.observe(part);
  }

  show(panel: Panel): void {
    if (panel.kind !== "plot") return;
    this.element.dataset.panel = panel.key;
    this.#title.textContent = panel.title;
    this.#drawing.setAttribute("aria-label", panel.alt);
    this.#legend.replaceChildren(
      ...panel.series.map(({ name, ink }) => make("span", { class: `learn-key learn-ink-${ink}` }, name)),
    );
    this.#panel = panel;
    this.#draw(panel);
  }

  /**
   * Redraws for another width or type size, and where the style sheet gives another height, which can be that of the box. The height that
   * follows from the drawing itself changes nothing.
   */
  #fit(): void {
    const style = getComputedStyle(this.#drawing);
    const type = parseFloat(style.fontSize) / TYPE || 1;
    const width = Math.round(this.element.clientWidth / type);
    const given = style.getPropertyValue("--plot-height");
    const height = Math.round((given.includes("%") ? this.#box.clientHeight : parseFloat(given)) / type) || 0;
    if (width === 0 || (width === this.#width && height === this.#height)) return;
    [this.#width, this.#height] = [width, height];
    if (this.#panel) this.#draw(this.#panel);
  }

  #draw({ series, x, y, at, domain, range, hasAngles }: PlotPanel): void {
    const width = this.#width || WIDTH;
    const height = this.#height || heightOf(width);
    this.#drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const every = (axis: 0 | 1) => series.flatMap(({ points }) => points.filter((_, i) => i % 2 === axis));
    const [across, up] = [spanOf(at === undefined ? every(0) : [...every(0), at], domain), spanOf(every(1), range)];
    const [top, bottom] = [MARGIN.top, height - MARGIN.bottom];
    const rows = ticks(up, marks(bottom - top, 36));
    const widest = Math.max(...rows.map((value) => label(value).length));
    const box = { left: MARGIN.left + CHARACTER * widest, top, right: width - MARGIN.right, bottom };
    const toX = (value: number) =>
      box.left + ((value - across.least) / (across.most - across.least)) * (box.right - box.left);
    const toY = (value: number) => box.bottom - ((value - up.least) / (up.most - up.least)) * (box.bottom - box.top);
    const parts: SVGElement[] = [];
    const columns = ticks(across, marks(box.right - box.left, 55), hasAngles);
    // Numbers that would touch are left out.
    const numbered = Math.ceil(LEAST_ROOM / (toX(columns[1] ?? NaN) - toX(columns[0] ?? NaN))) || 1;
    columns.forEach((value, index) => {
      parts.push(svg("path", { class: "grid", d: `M${toX(value)} ${box.top}V${box.bottom}` }));
      if (index % numbered > 0) return;
      parts.push(
        svg("text", { class: "tick", x: toX(value), y: box.bottom + 13, "text-anchor": "middle" }, label(value)),
      );
    });
    for (const value of rows) {
      parts.push(
        svg("path", { class: "grid", d: `M${box.left} ${toY(value)}H${box.right}` }),
        svg("text", { class: "tick", x: box.left - 5, y: toY(value) + 3.5, "text-anchor": "end" }, label(value)),
      );
    }
    // A name that is longer than its axis begins at the upper edge.
    const middle = Math.max((box.top + box.bottom) / 2, (CHARACTER * y.length) / 2);
    parts.push(
      svg("text", { class: "axis", x: (box.left + box.right) / 2, y: height - 6, "text-anchor": "middle" }, x),
    );
    parts.push(
      svg(
        "text",
        {
          class: "axis",
          transform: `translate(10 ${middle}) rotate(-90)`,
          "text-anchor": "middle",
        },
        y,
      ),
    );
    if (at !== undefined) parts.push(svg("path", { class: "at", d: `M${toX(at)} ${box.top}V${box.bottom}` }));
    for (const { ink, points, dots } of series) {
      const places = Array.from(
        { length: points.length / 2 },
        (_, i) => [toX(points[2 * i] ?? NaN), toY(points[2 * i + 1] ?? NaN)] as const,
      );
      parts.push(svg("path", { class: `curve learn-ink-${ink}`, d: path(places) }));
      if (dots)
        parts.push(
          ...places
            .filter(([px, py]) => Number.isFinite(px + py))
            .map(([px, py]) => svg("circle", { class: `point learn-ink-${ink}`, cx: px, cy: py, r: 3 })),
        );
    }
    this.#drawing.replaceChildren(...parts);
  }
}

const label = (value: number): string =>
  (Number.isInteger(value) ? String(value) : short(value).replace(/0+$/, "")).replace("-", "−");

function path(places: readonly (readonly [number, number])[]): string {
  let isDown = false;
  return places
    .map(([x, y]) => {
      if (!Number.isFinite(x + y)) {
        isDown = false;
        return "";
      }
      const step = `${isDown ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
      isDown = true;
      return step;
    })
    .join("");
}
