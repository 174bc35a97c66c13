/** The panels of a run: both surfaces, and the curves of its iterations so far. */

import type { Estimator, StepReport } from "../../pkg/index.js";
import { cloudsOf } from "../learn/compute/clouds";
import type { Panel, PlotPanel } from "../learn/protocol";

type Curve = Pick<PlotPanel, "key" | "title" | "alt" | "y" | "range"> & {
  ink: "error" | "pose";
  value(report: StepReport): number;
};

/** The curves with the smallest range of each axis, so that the last digits of a run that has converged do not fill the picture. */
const CURVES: readonly Curve[] = [
  {
    key: "residual",
    title: "Residual",
    alt: "The image residual of each iteration.",
    y: "log colour",
    range: [0, 0.05],
    ink: "error",
    value: ({ residual }) => residual,
  },
  {
    key: "rotation-change",
    title: "Change of the rotation",
    alt: "The change of the rotation in each iteration.",
    y: "degrees",
    range: [0, 1],
    ink: "pose",
    value: ({ rotationChange }) => rotationChange,
  },
];

export class Course {
  /** Iteration and value in turn, for each curve. */
  readonly #points = CURVES.map((): number[] => []);

  take(report: StepReport): void {
    // Reports of the search belong to no iteration.
    if (report.stage === "search") return;
    for (const [at, { value }] of CURVES.entries()) this.#points[at]?.push(report.iteration, value(report));
  }

  panels(estimator: Estimator): Panel[] {
    const plots = CURVES.map(({ ink, value: _, ...panel }, at): PlotPanel => {
      const series = [{ name: panel.title, ink, points: this.#points[at] ?? [], dots: true }];
      return { kind: "plot", x: "iteration", ...panel, series };
    });
    return [cloudsOf(estimator), ...plots];
  }
}
