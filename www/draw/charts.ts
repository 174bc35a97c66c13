/** Energy and rotation change by iteration. Loaded after the first paint. */

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { StepReport } from "../../pkg/index.js";
import { ink } from "../dom";
import { short } from "./numbers";

interface Line {
  label: string;
  token: string;
  value(report: StepReport): number;
}

const energies: readonly Line[] = [
  { label: "total", token: "ink", value: ({ energy }) => energy.total },
  { label: "shading", token: "series-1", value: ({ energy }) => energy.shading },
  { label: "prior", token: "series-2", value: ({ energy }) => energy.prior },
  { label: "registration", token: "series-3", value: ({ energy }) => energy.registration },
  { label: "refinement", token: "series-4", value: ({ energy }) => energy.refinement },
];
const rotation: readonly Line[] = [{ label: "change, deg", token: "accent", value: ({ rotationChange }) => rotationChange }];

export class Charts {
  readonly #charts: Chart[];

  constructor(energyBox: HTMLElement, rotationBox: HTMLElement) {
    this.#charts = [new Chart(energyBox, energies), new Chart(rotationBox, rotation)];
  }

  show(history: readonly StepReport[]): void {
    for (const chart of this.#charts) chart.show(history);
  }

  /** uPlot draws on a canvas and has to be told the theme's colours anew. */
  recolour(): void {
    for (const chart of this.#charts) chart.build();
  }
}

class Chart {
  readonly #box: HTMLElement;
  readonly #lines: readonly Line[];
  #plot: uPlot | undefined;
  #data: uPlot.AlignedData;

  constructor(box: HTMLElement, lines: readonly Line[]) {
    this.#box = box;
    this.#lines = lines;
    this.#data = [[], ...lines.map(() => [])];
    this.build();
    new ResizeObserver(() => this.#plot?.setSize(this.#size())).observe(box);
  }

  /** A logarithm has no place for zero and below, so such values are gaps. */
  show(history: readonly StepReport[]): void {
    const steps = history.filter(({ iteration }) => iteration > 0);
    const positive = (value: number) => (value > 0 && Number.isFinite(value) ? value : null);
    this.#data = [steps.map(({ iteration }) => iteration), ...this.#lines.map(({ value }) => steps.map((report) => positive(value(report))))];
    this.#showData();
  }

  build(): void {
    this.#plot?.destroy();
    const axis: uPlot.Axis = {
      stroke: ink("ink-soft"),
      font: "11px system-ui, sans-serif",
      grid: { stroke: ink("line"), width: 1 },
      ticks: { stroke: ink("line"), width: 1, size: 4 },
    };
    this.#plot = new uPlot(
      {
        ...this.#size(),
        padding: [8, 8, 0, 0],
        cursor: { y: false, drag: { x: false, y: false } },
        scales: { x: { time: false, range: (_plot, _min, max) => [1, Math.max(max ?? 2, 2)] }, y: { distr: 3 } },
        axes: [
          { ...axis, size: 24, incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] },
          { ...axis, size: 48, values: (_, splits) => splits.map((value) => (Number.isInteger(Math.log10(value)) ? short(value) : "")) },
        ],
        series: [
          { label: "iteration" },
          ...this.#lines.map(({ label, token }) => ({
            label,
            stroke: ink(token),
            width: 1.5,
            // A line needs two points; until then, dots.
            points: { show: ({ data }: uPlot) => data[0].length < 2 },
            value: (_: uPlot, value: number | null | undefined) => (typeof value === "number" ? short(value) : "–"),
          })),
        ],
      },
      this.#data,
      this.#box,
    );
    this.#showData();
  }

  /** The legend shows the newest values until the pointer asks for others. */
  #showData(): void {
    this.#plot?.setData(this.#data);
    this.#plot?.setLegend({ idx: Math.max(0, this.#data[0].length - 1) });
  }

  #size(): { width: number; height: number } {
    return { width: Math.max(120, this.#box.clientWidth), height: 140 };
  }
}
