/**
 * How well each cue constrains each axis: the loss of log likelihood when the estimated calibration is moved. Loaded with the first
 * verdict.
 */

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { CheckReport } from "../../pkg/index.js";
import { ink, make } from "../dom";
import { decimals, short } from "../draw/numbers";
import type { Run } from "./rig";
import { CUES } from "./verdict";

type Sensitivity = CheckReport["sensitivity"][number];
type Axis = Sensitivity["axis"];

/** Said where it happens, because the verdict and the intervals would seem to contradict each other. */
const CORRELATED =
  "The six unknowns are correlated: a calibration can be excluded although each of its six values lies within its own 95 % interval.";

const axes: Record<Axis, { title: string; unit: string }> = {
  rx: { title: "Rotation about x (up and down)", unit: "°" },
  ry: { title: "Rotation about y (left and right)", unit: "°" },
  rz: { title: "Rotation about z (in the image plane)", unit: "°" },
  tx: { title: "Shift along x (sideways)", unit: "mm" },
  ty: { title: "Shift along y (up and down)", unit: "mm" },
  tz: { title: "Shift along z (forwards and backwards)", unit: "mm" },
};
const AXES = Object.keys(axes) as Axis[];
const tokens: Record<string, string> = {
  shading: "series-1",
  edges: "series-3",
  information: "series-2",
  silhouette: "series-4",
};
/** Smallest loss at which curves are scaled up to fill the height. */
const FLAT = 4;
/** Half width of a 95 % interval, sigmas. */
const WITHIN = 1.96;

export class SensitivityCharts {
  readonly #keys = make("p", { class: "rig-curve-keys" });
  readonly #figures = make("div", { class: "rig-curves" });
  readonly #correlated = make("p", { class: "rig-correlated soft", hidden: true }, CORRELATED);
  readonly element = make("div", { class: "rig-column" }, this.#keys, this.#correlated, this.#figures);
  #plots: uPlot[] = [];
  #observers: ResizeObserver[] = [];
  #shown: readonly Sensitivity[] = [];
  #covariance: readonly number[] = [];
  /** The calibration being checked, relative to the estimate, by axis. */
  #checked: readonly number[] = [];
  /** Its name. */
  #name = "";

  show({ report: { sensitivity, covariance, candidates }, estimateOnly }: Run): void {
    if (this.#shown === sensitivity) return;
    this.#shown = sensitivity;
    this.#covariance = covariance;
    const [[name = "", found] = []] = estimateOnly ? [] : Object.entries(candidates);
    this.#name = name;
    this.#checked = found?.offAxes ?? [];
    const isExcluded = found?.verdict === "off" && this.#checked.length > 0;
    const isInside = this.#checked.every((off, k) => Math.abs(off) <= certainty(covariance, AXES[k] ?? "rx"));
    this.#correlated.hidden = !(isExcluded && isInside);
    this.#build();
  }

  /** A canvas does not follow a change of theme by itself. */
  recolour(): void {
    this.#build();
  }

  #build(): void {
    for (const plot of this.#plots) plot.destroy();
    for (const observer of this.#observers) observer.disconnect();
    this.#plots = [];
    this.#observers = [];
    const key = (token: string, words: string) => make("span", { style: `--key: var(--${token})` }, words);
    const cues = [...new Set(this.#shown.map(({ cue }) => cue))];
    this.#keys.replaceChildren(
      ...cues.map((cue) => key(tokens[cue] ?? "ink-soft", CUES[cue] ?? cue)),
      key("ink", "all together"),
    );
    this.#figures.replaceChildren();
    for (const axis of AXES) {
      const curves = this.#shown.filter((each) => each.axis === axis && each.offsets.length > 1);
      if (curves.length > 0) this.#chart(axis, curves);
    }
  }

  #chart(axis: Axis, curves: readonly Sensitivity[]): void {
    const { title, unit } = axes[axis];
    const { xs, lines, total } = lossesOf(curves);
    const best = minimumOf(xs, total);
    const place = xs[best] ?? 0;
    const reach = certainty(this.#covariance, axis);
    const inside: [number, number] = [Math.max(xs[0] ?? 0, -reach), Math.min(xs.at(-1) ?? 0, reach)];
    const [digits, gap] = unit === "mm" ? [1, " "] : [2, ""];
    const box = make("div", { class: "chart" });
    const amount = (value: number) => `${decimals(value, digits)}${gap}${unit}`;
    const checked = this.#checked[AXES.indexOf(axis)];
    const beyond = checked === undefined ? 0 : Number(checked > (xs.at(-1) ?? 0)) - Number(checked < (xs[0] ?? 0));
    const isAtEnd = best === 0 || best === xs.length - 1;
    const words = [
      `Minimum at ${amount(place)}${isAtEnd ? " or beyond" : ""}; ± ${amount(reach)} (95 %)`,
      ...(isAtEnd
        ? ["the minimum lies at the end of the chart, so do not trust it for this axis"]
        : isOutside(xs, best, reach)
          ? ["the minimum lies outside this interval, so do not trust it for this axis"]
          : []),
      ...(checked === undefined
        ? []
        : [`“${this.#name}” at ${amount(checked)}${beyond === 0 ? "" : ", beyond the end of the chart (arrow)"}`]),
    ].join("; ");
    this.#figures.append(
      make(
        "figure",
        {},
        make("figcaption", {}, make("strong", {}, title), make("span", { class: "soft" }, words)),
        box,
      ),
    );
    const line = { stroke: ink("line"), width: 1 };
    const style: uPlot.Axis = {
      stroke: ink("ink-soft"),
      font: "11px system-ui, sans-serif",
      grid: line,
      ticks: { ...line, size: 4 },
    };
    const size = () => ({ width: Math.max(120, box.clientWidth), height: 150 });
    const plot = new uPlot(
      {
        ...size(),
        padding: [8, 8, 0, 0],
        cursor: { y: false, drag: { x: false, y: false } },
        scales: { x: { time: false }, y: { range: (_plot, _min, max) => [0, Math.max(max ?? 1, FLAT)] } },
        axes: [
          { ...style, size: 26, values: (_, splits) => splits.map((value) => `${value}`) },
          {
            ...style,
            size: 44,
            values: (_, splits) => splits.map((value) => (value >= 1e4 ? short(value) : `${value}`)),
          },
        ],
        legend: { show: false },
        series: [
          {},
          ...lines.map(({ cue }) => ({ stroke: ink(tokens[cue] ?? "ink-soft"), width: 1.5, points: { show: false } })),
          { stroke: ink("ink"), width: 2, points: { show: false } },
        ],
        hooks: {
          drawClear: [(plot) => band(plot, inside)],
          draw: [
            (plot) => mark(plot, place, total[best] ?? 0),
            (plot) =>
              checked !== undefined && (beyond === 0 ? triangle(plot, checked) : arrow(plot, beyond, amount(checked))),
          ],
        },
      },
      [xs, ...lines.map(({ losses }) => losses), total],
      box,
    );
    const observer = new ResizeObserver(() => plot.setSize(size()));
    observer.observe(box);
    this.#plots.push(plot);
    this.#observers.push(observer);
  }
}

/** The curves of all cues at the offsets of the first cue. Values are the loss relative to the maximum of the cue. */
function lossesOf(curves: readonly Sensitivity[]): {
  xs: number[];
  lines: { cue: string; losses: number[] }[];
  total: number[];
} {
  const xs = curves[0]?.offsets ?? [];
  const same = curves.filter(({ offsets, values }) => offsets.length === xs.length && values.length === xs.length);
  const sum = xs.map((_, i) => same.reduce((total, { values }) => total + (values[i] ?? 0), 0));
  const lost = (values: readonly number[]) => {
    const most = Math.max(...values);
    return values.map((value) => most - value);
  };
  return { xs, lines: same.map(({ cue, values }) => ({ cue, losses: lost(values) })), total: lost(sum) };
}

/** Half width of the 95 % interval, in degrees or millimetres, from the covariance, which includes errors that the cues share. */
function certainty(covariance: readonly number[], axis: Axis): number {
  const index = AXES.indexOf(axis);
  const sigma = Math.sqrt(Math.max(0, covariance[7 * index] ?? 0));
  return WITHIN * sigma * (index < 3 ? 180 / Math.PI : 1000);
}

/** The place of the smallest loss. Of equal ones it is the nearest to the estimate, so that a flat curve has no minimum at its end. */
function minimumOf(xs: readonly number[], losses: readonly number[]): number {
  const least = Math.min(...losses);
  return losses.reduce(
    (best, loss, i) => (loss === least && (best < 0 || Math.abs(xs[i] ?? 0) < Math.abs(xs[best] ?? 0)) ? i : best),
    -1,
  );
}

/** Whether the minimum lies outside the interval by more than one step of the offsets, which are too coarse for a finer test. */
function isOutside(xs: readonly number[], best: number, reach: number): boolean {
  const [before, after] = [xs[best - 1] ?? -Infinity, xs[best + 1] ?? Infinity];
  return before > reach || after < -reach;
}

/** An arrow at the end of the axis with the offset that lies beyond it, to the left or to the right. */
function arrow({ ctx, bbox }: uPlot, side: number, words: string): void {
  const [size, row] = [6 * devicePixelRatio, bbox.top + bbox.height];
  const tip = side < 0 ? bbox.left : bbox.left + bbox.width;
  ctx.save();
  ctx.fillStyle = ink("ink");
  ctx.beginPath();
  ctx.moveTo(tip, row - size);
  ctx.lineTo(tip - 1.6 * side * size, row - 2 * size);
  ctx.lineTo(tip - 1.6 * side * size, row);
  ctx.fill();
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = side < 0 ? "left" : "right";
  ctx.textBaseline = "middle";
  ctx.fillText(words, tip - 2.2 * side * size, row - size);
  ctx.restore();
}

/** Marks an offset on the axis. */
function triangle({ ctx, bbox, valToPos }: uPlot, x: number): void {
  const [column, row, size] = [valToPos(x, "x", true), bbox.top + bbox.height, 6 * devicePixelRatio];
  ctx.save();
  ctx.fillStyle = ink("ink");
  ctx.beginPath();
  ctx.moveTo(column, row - 1.6 * size);
  ctx.lineTo(column - size, row);
  ctx.lineTo(column + size, row);
  ctx.fill();
  ctx.restore();
}

function band({ ctx, bbox, valToPos }: uPlot, inside: readonly [number, number]): void {
  const [left, right] = [valToPos(inside[0], "x", true), valToPos(inside[1], "x", true)];
  ctx.fillStyle = ink("sunk");
  ctx.fillRect(left - 1, bbox.top, Math.max(2, right - left + 2), bbox.height);
}

function mark({ ctx, bbox, valToPos }: uPlot, x: number, y: number): void {
  const [column, row] = [valToPos(x, "x", true), valToPos(y, "y", true)];
  ctx.save();
  ctx.strokeStyle = ink("accent");
  ctx.fillStyle = ink("accent");
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(column, bbox.top);
  ctx.lineTo(column, bbox.top + bbox.height);
  ctx.stroke();
  ctx.beginPath();
  ctx.arc(column, row, 4 * devicePixelRatio, 0, 7);
  ctx.fill();
  ctx.restore();
}
