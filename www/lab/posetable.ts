/** The pose in numbers, beside the true one where the input is a sample. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";
import { byId, make } from "../dom";
import { angleBetween } from "./verdict";

/** Rows; those without a unit of their own are lengths in the colour view's unit. */
const rows: readonly { name: string; index?: string; unit?: string; decimals: number; read(pose: Pose): number | undefined }[] = [
  { name: "s", unit: "", decimals: 4, read: ({ scale }) => scale },
  { name: "α", unit: "°", decimals: 2, read: ({ angles }) => angles.alpha },
  { name: "β", unit: "°", decimals: 2, read: ({ angles }) => angles.beta },
  { name: "γ", unit: "°", decimals: 2, read: ({ angles }) => angles.gamma },
  { name: "t", index: "x", decimals: 3, read: ({ translation }) => translation[0] },
  { name: "t", index: "y", decimals: 3, read: ({ translation }) => translation[1] },
  { name: "t", index: "z", decimals: 3, read: ({ translation }) => translation[2] },
];

export class PoseTable {
  readonly #cells = rows.map(() => ({ found: make("td"), truth: make("td"), unit: make("span", { class: "unit" }) }));
  readonly #error = byId("pose-error", HTMLElement);
  readonly #extra = byId("pose-extra", HTMLElement);
  readonly #table: HTMLTableElement;

  constructor(table: HTMLTableElement) {
    this.#table = table;
    const lines = this.#cells.map(({ found, truth, unit }, i) => {
      const { name, index } = rows[i] ?? { name: "" };
      const heading = make("th", { scope: "row" }, name, ...(index ? [make("sub", {}, index)] : []), " ", unit);
      return make("tr", {}, heading, found, truth);
    });
    table.tBodies[0]?.append(...lines);
  }

  show(report: StepReport, start: Pose | undefined, truth: Pose | null, length: "px" | "m"): void {
    const { pose, uncertainty, status } = report;
    rows.forEach(({ index, decimals: count, read, unit = length }, i) => {
      const cells = this.#cells[i];
      if (!cells) return;
      cells.unit.textContent = unit;
      cells.found.textContent = decimals(read(pose), count);
      // An orthographic image cannot see how far away the object is: any number does, so none is the true one.
      const free = index === "z" && length === "px";
      cells.truth.textContent = truth ? (free ? "free" : decimals(read(truth), count)) : "";
    });
    this.#table.toggleAttribute("data-truth", truth !== null);
    this.#error.hidden = truth === null;
    if (truth) {
      const degrees = angleBetween(pose.rotation, truth.rotation);
      this.#error.dataset.degrees = String(degrees);
      const before = start ? `; ${decimals(angleBetween(start.rotation, truth.rotation), 1)}° at the start` : "";
      this.#error.replaceChildren(make("strong", {}, `${decimals(degrees, 2)}° off`), ` the true rotation${before}`);
    }
    this.#extra.replaceChildren(
      ...pair("Overlap", `${decimals(100 * report.overlap, 0)} %`),
      ...pair("Inliers", `${decimals(100 * report.inliers, 0)} %`),
      ...pair("Colour residual", decimals(report.residual, 4)),
      ...pair("Rotation change", `${decimals(report.rotationChange, 4)}°`),
      // A sigma says how sharp a pose is, not whether it is the right one: beside a lost one it would mislead.
      ...(uncertainty && status !== "lost" ? certainty(uncertainty, length) : []),
    );
  }
}

/** One sigma of each part of the pose; what is held or cannot be seen has none. */
function certainty({ rotationDegrees, translation, scale, weakest }: NonNullable<StepReport["uncertainty"]>, length: string): HTMLElement[] {
  const known = translation.map((value) => (value === null ? "free" : decimals(value, 3))).join(", ");
  return [
    ...pair("σ about x, y, z", sigmas(rotationDegrees)),
    ...pair("σ of t", `${known} ${length}`),
    ...(scale === null ? [] : pair("σ of s", decimals(scale, 4))),
    ...pair("Weakest", weakest),
  ];
}

/** Half a turn of uncertainty is no knowledge at all. */
const sigmas = (degrees: readonly number[]): string =>
  degrees.every((value) => value >= 180) ? "unknown" : `${degrees.map((value) => (value >= 180 ? "any" : decimals(value, 2))).join(", ")}°`;

const pair = (term: string, value: string): HTMLElement[] => [make("dt", {}, term), make("dd", {}, value)];
