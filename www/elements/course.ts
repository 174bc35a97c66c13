/** The panels of a run: both surfaces, and the curves of its iterations so far. */

import type { Estimator, StepReport } from "../../pkg/index.js";
import { cloudsOf } from "../learn/compute/clouds";
import type { Panel, PlotPanel } from "../learn/protocol";

type Curve = Pick<PlotPanel, "key" | "title" | "alt" | "y"> & {
  ink: "error" | "pose";
  value(report: StepReport): number;
};

const CURVES: readonly Curve[] = [
  {
    key: "residual",
    title: "Residual",
    alt: "The image residual of each iteration.",
    y: "log colour",
    ink: "error",
    value: ({ residual }) => residual,
  },
  {
    key: "rotation-change",
    title: "Change of the rotation",
    alt: "The change of the rotation in each iteration, as a logarithm.",
    y: "log10 of degrees",
    ink: "pose",
    value: ({ rotationChange }) => Math.log10(rotationChange),
  },
];

export class Course {
  /** Iteration and value in turn, for each curve. */
  readonly #points = CURVES.map((): number[] => []);

  take(report: StepReport): void {
    // The search has no iterations, and a rotation that stays has no logarithm.
    if (report.stage === "search") return;
    for (const [at, { value }] of CURVES.entries()) {
      const now = value(report);
      this.#points[at]?.push(report.iteration, Number.isFinite(now) ? now : NaN);
    }
  }

  panels(estimator: Estimator): Panel[] {
    const plots = CURVES.map(
      ({ key, title, alt, y, ink }, at): PlotPanel => ({
        ...{ kind: "plot", key, title, alt, x: "iteration", y },
        series: [{ name: title, ink, points: this.#points[at] ?? [], dots: true }],
      }),
    );
    return [cloudsOf(estimator), ...plots];
  }
}
