/** Curves in a box with two axes, drawn as SVG so that they take the page's colours. */

import { make } from "../dom";
import { short } from "../draw/numbers";
import type { Panel, PlotPanel } from "./protocol";
import { svg } from "./svg";

const [WIDTH, HEIGHT] = [320, 200];
const BOX = { left: 40, top: 8, right: 306, bottom: 164 };
const TICKS = 4;

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

/** Round numbers within a span, about four of them. */
function ticks({ least, most }: Span): number[] {
  const rough = (most - least) / TICKS;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 5, 10].find((each) => each * power >= rough) ?? 10) * power;
  const first = Math.ceil(least / step - 1e-9);
  return Array.from({ length: Math.floor(most / step + 1e-9) - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

export class Plot {
  readonly element: HTMLElement;
  readonly #title = make("figcaption", {});
  readonly #drawing = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", class: "learn-plot" });
  readonly #legend = make("p", { class: "learn-legend learn-keys" });

  constructor() {
    this.element = make("figure", { class: "learn-panel learn-wide" }, this.#title, this.#drawing as unknown as HTMLElement, this.#legend);
  }

  show(panel: Panel): void {
    if (panel.kind !== "plot") return;
    this.element.dataset.panel = panel.key;
    this.#title.textContent = panel.title;
    this.#drawing.setAttribute("aria-label", panel.alt);
    this.#legend.replaceChildren(...panel.series.map(({ name, ink }) => make("span", { class: `learn-key learn-ink-${ink}` }, name)));
    this.#draw(panel);
  }

  #draw({ series, x, y, at, range }: PlotPanel): void {
    const every = (axis: 0 | 1) => series.flatMap(({ points }) => points.filter((_, i) => i % 2 === axis));
    const [across, up] = [spanOf(at === undefined ? every(0) : [...every(0), at]), spanOf(every(1), range)];
    const toX = (value: number) => BOX.left + ((value - across.least) / (across.most - across.least)) * (BOX.right - BOX.left);
    const toY = (value: number) => BOX.bottom - ((value - up.least) / (up.most - up.least)) * (BOX.bottom - BOX.top);
    const parts: SVGElement[] = [];
    for (const value of ticks(across)) {
      parts.push(svg("path", { class: "grid", d: `M${toX(value)} ${BOX.top}V${BOX.bottom}` }), svg("text", { class: "tick", x: toX(value), y: BOX.bottom + 13, "text-anchor": "middle" }, label(value)));
    }
    for (const value of ticks(up)) {
      parts.push(svg("path", { class: "grid", d: `M${BOX.left} ${toY(value)}H${BOX.right}` }), svg("text", { class: "tick", x: BOX.left - 5, y: toY(value) + 3.5, "text-anchor": "end" }, label(value)));
    }
    parts.push(svg("text", { class: "axis", x: (BOX.left + BOX.right) / 2, y: HEIGHT - 6, "text-anchor": "middle" }, x));
    parts.push(svg("text", { class: "axis", transform: `translate(10 ${(BOX.top + BOX.bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, y));
    if (at !== undefined) parts.push(svg("path", { class: "at", d: `M${toX(at)} ${BOX.top}V${BOX.bottom}` }));
    for (const { ink, points, dots } of series) {
      const places = Array.from({ length: points.length / 2 }, (_, i) => [toX(points[2 * i] ?? NaN), toY(points[2 * i + 1] ?? NaN)] as const);
      parts.push(svg("path", { class: `curve learn-ink-${ink}`, d: path(places) }));
      if (dots) parts.push(...places.filter(([px, py]) => Number.isFinite(px + py)).map(([px, py]) => svg("circle", { class: `point learn-ink-${ink}`, cx: px, cy: py, r: 3 })));
    }
    this.#drawing.replaceChildren(...parts);
  }
}

const label = (value: number): string => (Number.isInteger(value) ? String(value) : short(value).replace(/0+$/, "")).replace("-", "−");

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
