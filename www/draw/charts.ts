/** Curves on a logarithmic axis: the Lab's objective and rotation change, and other sequences. Loaded after the first paint. */

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { StepReport } from "../../pkg/index.js";
import { ink, make } from "../dom";
import { short } from "./numbers";

export interface Curve {
  label: string;
  token: string;
  /** Whether the curve belongs to the pinned run; it is dashed and has no entry in the legend. */
  isPinned?: boolean;
}

interface Line extends Curve {
  value(report: StepReport): number;
}

/** `report.energy` holds the objective (Eq. 1) and its terms. */
const objectiveTerms: readonly Line[] = [
  { label: "total", token: "ink", value: ({ energy }) => energy.total },
  { label: "shading", token: "series-1", value: ({ energy }) => energy.shading },
  { label: "prior", token: "series-2", value: ({ energy }) => energy.prior },
  { label: "registration", token: "series-3", value: ({ energy }) => energy.registration },
  { label: "refinement", token: "series-4", value: ({ energy }) => energy.refinement },
];
/** Degrees. A rotation that does not move changes by zero, which a logarithmic axis cannot show: the curve has a gap. */
const rotation: readonly Line[] = [
  { label: "change, deg", token: "accent", value: ({ rotationChange }) => rotationChange },
];

/** One of the Lab's charts. */
export class Chart {
  readonly #box: HTMLElement;
  readonly #name: string;
  readonly #lines: readonly Line[];
  readonly #plot: Plot;
  readonly #still = make("p", { class: "soft still", hidden: true });

  private constructor(box: HTMLElement, name: string, lines: readonly Line[]) {
    box.setAttribute("role", "group");
    this.#box = box;
    this.#name = name;
    this.#lines = lines;
    this.#plot = new Plot(box, {
      xLabel: "iteration",
      curves: [...lines, ...lines.map((line) => ({ ...line, isPinned: true }))],
      whole: true,
      waits: true,
    });
    box.append(this.#still);
  }

  static objective(box: HTMLElement): Chart {
    return new Chart(box, "Objective", objectiveTerms);
  }

  static rotation(box: HTMLElement): Chart {
    return new Chart(box, "Rotation change", rotation);
  }

  /** The run that is pinned is dashed. */
  show(history: readonly StepReport[], pinned: readonly StepReport[] = []): void {
    const [name, lines] = [this.#name, this.#lines];
    const runs = [history, pinned].map((run) => new Map(run.map((report) => [report.iteration, report])));
    const iterations = Array.from({ length: Math.max(0, ...runs.flatMap((run) => [...run.keys()])) }, (_, i) => i + 1);
    const [curves = [], dashed = []] = runs.map((run) =>
      lines.map(({ value }) => iterations.map((iteration) => optional(run.get(iteration), value))),
    );
    this.#plot.show(iterations, [...curves, ...dashed]);
    this.#sayZeros(curves.flat(), dashed.flat());
    this.#box.setAttribute(
      "aria-label",
      [
        inWords(name, lines, curves),
        ...(pinned.length > 0 ? [inWords(`Pinned: ${name.toLowerCase()}`, lines, dashed)] : []),
      ].join(" "),
    );
  }

  /** States where and why a single curve has gaps. */
  #sayZeros(values: readonly (number | null)[], pinned: readonly (number | null)[]): void {
    const isDrawn = [...values, ...pinned].some((value) => value !== null && value > 0);
    const zeros = zerosIn(values);
    this.#still.hidden = this.#lines.length > 1 || (isDrawn ? !zeros : !values.includes(0) && !pinned.includes(0));
    this.#still.toggleAttribute("data-some", isDrawn);
    this.#still.textContent = isDrawn
      ? `${zeros.charAt(0).toUpperCase()}${zeros.slice(1)} (not shown on a logarithmic axis).`
      : "No change in any iteration (a logarithmic axis cannot show zero).";
  }

  /** uPlot draws on a canvas, which does not follow a change of theme by itself. */
  recolour(): void {
    this.#plot.build();
    this.#plot.begin();
  }

  /** The first drawing is a separate task, so that the browser has styled and laid out the new elements by then. */
  begin(): void {
    this.#plot.begin();
  }
}

const optional = <T>(given: T | undefined, value: (given: T) => number): number | null =>
  given === undefined ? null : value(given);

/** The number of iterations in which a value is zero, in words; empty if it never is. */
function zerosIn(values: readonly (number | null)[]): string {
  const [known, zeros] = [values.filter((value) => value !== null), values.filter((value) => value === 0)];
  return zeros.length > 0 ? `zero in ${zeros.length} of ${known.length} iterations` : "";
}

/** A description of a chart for screen readers: the first and the last value of each curve, including zeros, which a logarithmic axis cannot show. */
function inWords(name: string, lines: readonly Line[], curves: readonly (readonly (number | null)[])[]): string {
  const said = lines.map(({ label }, i) => {
    const all = curves[i] ?? [];
    const values = all.filter((value): value is number => value !== null && value >= 0);
    const [first, last] = [values[0], values.at(-1)];
    if (first === undefined || last === undefined) return `${label}: none yet`;
    if (!values.some((value) => value > 0)) return `${label}: zero throughout`;
    const zeros = zerosIn(values);
    return `${label}: from ${short(first)} to ${short(last)}${zeros && `, ${zeros} (not shown on a logarithmic axis)`}`;
  });
  return `${name} over the iterations. ${said.join("; ")}.`;
}

const isPower = (value: number): boolean => Number.isInteger(Math.log10(value));

/** Largest number of grid lines; over many decades, the lines in between would merge into a grey area. */
const MOST_LINES = 30;
const sparse = (_: uPlot, splits: number[]): (number | null)[] =>
  splits.length > MOST_LINES ? splits.map((value) => (isPower(value) ? value : null)) : splits;

/** Largest number of points that are drawn as dots. */
const FEW = 12;

export interface PlotOptions {
  xLabel: string;
  curves: readonly Curve[];
  /** Whether x is a count. The axis then begins at one, and all ticks are whole numbers. */
  whole: boolean;
  /** Whether the chart draws nothing before `begin` is called. */
  waits?: boolean;
}

export class Plot {
  readonly #box: HTMLElement;
  readonly #options: PlotOptions;
  readonly #observer: ResizeObserver;
  #plot: uPlot | undefined;
  #begin: (() => void) | undefined;
  #data: uPlot.AlignedData;
  /** The newest value of each curve, also if it is zero, which no logarithm shows. */
  #newest: (number | null)[] = [];

  constructor(box: HTMLElement, options: PlotOptions) {
    this.#box = box;
    this.#options = options;
    this.#data = [[], ...options.curves.map(() => [])];
    this.build();
    if (!options.waits) this.begin();
    this.#observer = new ResizeObserver(() => {
      const size = this.#size();
      // The first size that the observer reports is the one with which the chart was built.
      if (!this.#begin && size.width !== this.#plot?.width) this.#plot?.setSize(size);
    });
    this.#observer.observe(box);
  }

  /** Draws the chart, in a separate task if the caller wishes. */
  begin(): void {
    const begin = this.#begin;
    this.#begin = undefined;
    begin?.();
  }

  /** A logarithmic axis cannot show values of zero and below, so these are gaps. */
  show(xs: number[], ys: readonly (number | null)[][]): void {
    const positive = (value: number | null) => (value !== null && value > 0 && Number.isFinite(value) ? value : null);
    const curves = ys.map((values) => values.map(positive));
    // A count begins at the first value that can be shown.
    const first = this.#options.whole
      ? Math.max(
          0,
          xs.findIndex((_, i) => curves.some((values) => values[i] != null)),
        )
      : 0;
    this.#newest = ys.map((values) => values.findLast((value) => value !== null) ?? null);
    this.#data = [xs.slice(first), ...curves.map((values) => values.slice(first))];
    // Drawn at once, because uPlot would otherwise draw at the end of the task, where the painter cannot measure the time.
    this.#plot?.batch(() => this.#plot?.setData(this.#data));
  }

  build(): void {
    this.#plot?.destroy();
    const axis: uPlot.Axis = {
      stroke: ink("ink-soft"),
      font: "11px system-ui, sans-serif",
      grid: { stroke: ink("line"), width: 1 },
      ticks: { stroke: ink("line"), width: 1, size: 4 },
    };
    const { xLabel, curves, whole } = this.#options;
    const counted: Pick<uPlot.Scale, "range"> = {
      range: (_plot, min, max) => [min ?? 1, Math.max(max ?? 2, (min ?? 1) + 1)],
    };
    this.#plot = new uPlot(
      {
        ...this.#size(),
        // Leaves room for the first number, to the left of which there may be no axis.
        padding: [8, 8, 0, 4],
        cursor: { y: false, drag: { x: false, y: false } },
        scales: { x: { time: false, ...(whole ? counted : {}) }, y: { distr: 3 } },
        axes: [
          { ...axis, size: 24, ...(whole ? { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] } : {}) },
          {
            ...axis,
            size: 48,
            grid: { ...axis.grid, filter: sparse },
            ticks: { ...axis.ticks, filter: sparse },
            values: (_, splits) => splits.map((value) => (isPower(value) ? short(value) : "")),
          },
        ],
        series: [
          { label: xLabel },
          ...curves.map(({ label, token, isPinned = false }) => ({
            label: isPinned ? `${label}, pinned` : label,
            stroke: ink(token),
            ...(isPinned ? { dash: [5, 4], class: "pinned-curve" } : {}),
            width: 1.5,
            spanGaps: !whole,
            // If there are few points, each one is drawn as a dot; a line needs at least two points.
            points: { show: ({ data }: uPlot) => !whole || data[0].length < FEW },
            // The newest value, unless the pointer selects another.
            value: (_: uPlot, value: number | null | undefined, index: number, at: number | null) => {
              const shown = at === null ? this.#newest[index - 1] : value;
              return typeof shown === "number" ? short(shown) : "–";
            },
          })),
        ],
      },
      this.#data,
      (plot, begin) => {
        this.#box.append(plot.root);
        this.#begin = () => begin();
      },
    );
  }

  destroy(): void {
    this.#observer.disconnect();
    this.#plot?.destroy();
  }

  #size(): { width: number; height: number } {
    return { width: Math.max(120, this.#box.clientWidth), height: 140 };
  }
}
