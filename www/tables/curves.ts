/** Figures as curves over the finished cells. Loaded with the first figure. */

import { Plot, type Curve } from "../draw/charts";
import { make } from "../dom";
import type { Panel } from "./panels";
import type { Cell, Done } from "./protocol";

interface Data {
  title: string;
  xLabel: string;
  xs: number[];
  curves: Curve[];
  ys: (number | null)[][];
}

const tokens = ["series-3", "series-1", "series-2", "series-4"];
const token = (index: number): string => tokens[index % tokens.length] ?? "ink";

/** One curve for each row of the grid, and the paper's beside them. */
function across(
  { across, down, value, paper, quantity, unit, cells }: Panel,
  done: Done,
  shown: readonly Cell[],
): Data[] {
  const xs = [...new Set(shown.map((cell) => Number(across.of(cell))))].sort((a, b) => a - b);
  const at = (row: string | number) =>
    xs.map((x) => {
      const found = done.find(({ cell }) => down.of(cell) === row && across.of(cell) === x);
      return (found && value(found.result)) ?? null;
    });
  const rows = [...new Set(shown.map((cell) => down.of(cell)))];
  const reference = paper && xs.map((x) => paper(cells.find((cell) => across.of(cell) === x) as Cell) ?? null);
  return [
    {
      title: `${quantity},${unit === "°" ? " degrees" : unit}`,
      xLabel: across.label,
      xs,
      curves: [
        ...rows.map((row, i) => ({ label: down.name(row), token: token(i) })),
        ...(reference ? [{ label: "the paper", token: "ink" }] : []),
      ],
      ys: [...rows.map(at), ...(reference ? [reference] : [])],
    },
  ];
}

interface Iteration {
  iteration: number;
  depthRmse: number;
  degrees: number;
}

/** One curve for each run; runs end at different iterations. */
function iterations(done: Done): Data[] {
  const runs = done.map(({ cell, result }) => ({
    name: `${cell.row.run}, ${cell.row.protocol}`,
    list: (result.iterations ?? []) as Iteration[],
  }));
  const last = runs.reduce((most, { list }) => Math.max(most, list.length), 1);
  const xs = Array.from({ length: last }, (_, i) => i + 1);
  const data = (title: string, key: "degrees" | "depthRmse"): Data => ({
    title,
    xLabel: "iteration",
    xs,
    curves: runs.map(({ name }, i) => ({ label: name, token: token(i) })),
    ys: runs.map(({ list }) => xs.map((x) => list.find(({ iteration }) => iteration === x)?.[key] ?? null)),
  });
  return [data("error of the rotation, degrees", "degrees"), data("error of the depth, px", "depthRmse")];
}

export class Curves {
  readonly element = make("div", { class: "curves" });
  #plots: Plot[] = [];

  show(panel: Panel, done: Done, shown: readonly Cell[]): void {
    const list =
      done.length === 0
        ? []
        : panel.curves === "iterations"
          ? iterations(done)
          : panel.curves === "across"
            ? across(panel, done, shown)
            : [];
    for (const plot of this.#plots) plot.destroy();
    this.#plots = [];
    this.element.replaceChildren();
    for (const { title, xLabel, xs, curves, ys } of list) {
      const box = make("div", { class: "chart" });
      this.element.append(make("figure", {}, make("figcaption", {}, title), box));
      const plot = new Plot(box, { xLabel, curves, whole: xLabel === "iteration" });
      plot.show(xs, ys);
      this.#plots.push(plot);
    }
  }

  /** The canvas does not follow a change of theme by itself. */
  recolour(): void {
    for (const plot of this.#plots) plot.build();
  }
}
