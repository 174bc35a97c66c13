/** The pose in numbers, beside the true one if the input is a sample. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";
import { byId, make } from "../dom";
import type { Explanations } from "./ask";
import type { Term } from "./explain";
import { BEFORE, angleBetween, dated, standing } from "./verdict";

/** The rows, in the words of the run's messages; those without a unit are lengths in the colour view's unit. */
const rows: readonly {
  words: string;
  name: string;
  index?: string;
  unit?: string;
  decimals: number;
  read(pose: Pose): number | undefined;
}[] = [
  { words: "scale", name: "s", unit: "", decimals: 4, read: ({ scale }) => scale },
  { words: "rotation about x", name: "α", unit: "°", decimals: 2, read: ({ angles }) => angles.alpha },
  { words: "rotation about y", name: "β", unit: "°", decimals: 2, read: ({ angles }) => angles.beta },
  { words: "rotation about z", name: "γ", unit: "°", decimals: 2, read: ({ angles }) => angles.gamma },
  { words: "translation along x", name: "t", index: "x", decimals: 3, read: ({ translation }) => translation[0] },
  { words: "translation along y", name: "t", index: "y", decimals: 3, read: ({ translation }) => translation[1] },
  { words: "translation along z", name: "t", index: "z", decimals: 3, read: ({ translation }) => translation[2] },
];

/** Degrees of β beyond which α and γ rotate about nearly the same axis, so that each may differ although the rotation is right. */
const POLE = 85;

export class PoseTable {
  readonly #cells = rows.map(() => ({ found: make("td"), truth: make("td"), unit: make("span", { class: "unit" }) }));
  readonly #error = byId("pose-error", HTMLElement);
  readonly #extras: readonly { dt: HTMLElement; dd: HTMLElement; read: Extra["read"] }[];
  readonly #table: HTMLTableElement;
  readonly #heading = byId("pose-found", HTMLTableCellElement);
  #standing = "start";
  #isBefore = false;

  constructor(table: HTMLTableElement, explanations: Explanations) {
    this.#table = table;
    this.#extras = extras.map(({ term, name, read }) => ({
      dt: make("dt", {}, name, explanations.button(term, name)),
      dd: make("dd"),
      read,
    }));
    byId("pose-extra", HTMLElement).append(...this.#extras.flatMap(({ dt, dd }) => [dt, dd]));
    const lines = this.#cells.map(({ found, truth, unit }, i) => {
      const { words, name, index } = rows[i] ?? { words: "", name: "" };
      const symbol = make("span", { class: "symbol" }, name, ...(index ? [make("sub", {}, index)] : []), " ", unit);
      const heading = make("th", { scope: "row" }, words, " ", symbol);
      return make("tr", {}, heading, found, truth);
    });
    table.tBodies[0]?.append(...lines);
  }

  /** Whether the numbers belong to the previous run, because the settings have changed or are being changed. */
  date(isBefore: boolean): void {
    this.#isBefore = isBefore;
    this.#head();
  }

  #head(): void {
    const words = dated(this.#standing, this.#isBefore);
    this.#table.toggleAttribute("data-before", words === BEFORE);
    this.#heading.textContent = words;
  }

  /** Shows a rival's pose instead of the run's; all other numbers are the run's. */
  show(
    report: StepReport,
    rival: Pose | undefined,
    start: Pose | undefined,
    truth: Pose | null,
    length: "px" | "m",
  ): void {
    const pose = rival ?? report.pose;
    // A search only tries poses; none is final before it ends.
    this.#standing = rival ? "alternative" : standing(report);
    this.#head();
    rows.forEach(({ index, decimals: count, read, unit = length }, i) => {
      const cells = this.#cells[i];
      if (!cells) return;
      cells.unit.textContent = unit;
      cells.found.textContent = decimals(read(pose), count);
      // An orthographic image does not determine the distance of the object, so there is no true value.
      const free = index === "z" && length === "px";
      cells.truth.textContent = truth ? (free ? "free" : decimals(read(truth), count)) : "";
    });
    this.#table.toggleAttribute("data-truth", truth !== null);
    this.#error.hidden = truth === null;
    if (truth) {
      const degrees = angleBetween(pose.rotation, truth.rotation);
      this.#error.dataset.degrees = String(degrees);
      // The error that the verdict refers to, beside the error of the alternative pose.
      const before = rival
        ? ` (best pose: ${decimals(angleBetween(report.pose.rotation, truth.rotation), 2)}°)`
        : start
          ? ` (${decimals(angleBetween(start.rotation, truth.rotation), 2)}° at the start)`
          : "";
      this.#error.replaceChildren(make("strong", {}, `${decimals(degrees, 2)}°`), ` from the true rotation${before}`);
      // The true pose decides this, so that the text does not change during the search.
      if (Math.abs(truth.angles.beta) > POLE)
        this.#error.append(". This close to β = 90°, only α and γ together determine the rotation.");
    }
    this.#extras.forEach(({ dt, dd, read }) => {
      const value = read(report, length);
      dt.hidden = dd.hidden = value === undefined;
      dd.textContent = value ?? "";
    });
  }
}

interface Extra {
  term: Term;
  name: string;
  /** Undefined if there is no such number. */
  read(report: StepReport, length: string): string | undefined;
}

/** The numbers beside the pose, as displayed. */
export function numbersOf(report: StepReport, length: string): [name: string, value: string][] {
  return extras.flatMap(({ name, read }): [string, string][] => {
    const value = read(report, length);
    return value === undefined ? [] : [[name, value]];
  });
}

/** Only an exact zero is shown as zero, as in the words of the chart. */
const change = (degrees: number): string =>
  degrees === 0 ? "0°" : degrees < 0.0001 ? "below 0.0001°" : `${decimals(degrees, 4)}°`;

/** A sigma measures precision, not correctness: beside a lost pose it would mislead. */
const sure = ({ status, uncertainty }: StepReport): StepReport["uncertainty"] =>
  status === "lost" ? undefined : uncertainty;

/** One sigma of each part of the pose; parts that are fixed or not observable have none. */
const extras: readonly Extra[] = [
  { term: "overlap", name: "Overlap", read: ({ overlap }) => `${decimals(100 * overlap, 0)} %` },
  { term: "inliers", name: "Inliers", read: ({ inliers }) => `${decimals(100 * inliers, 0)} %` },
  { term: "residual", name: "Colour residual", read: ({ residual }) => decimals(residual, 4) },
  { term: "change", name: "Rotation change", read: ({ rotationChange }) => change(rotationChange) },
  {
    term: "sigma",
    name: "σ about x, y, z",
    read: (report) => optional(sure(report), ({ rotationDegrees }) => sigmas(rotationDegrees)),
  },
  {
    term: "sigma",
    name: "σ of t",
    read: (report, length) =>
      optional(
        sure(report),
        ({ translation }) =>
          `${translation.map((value) => (value === null ? "free" : decimals(value, 3))).join(", ")} ${length}`,
      ),
  },
  {
    term: "sigma",
    name: "σ of s",
    read: (report) => optional(sure(report)?.scale ?? undefined, (scale) => decimals(scale, 4)),
  },
  { term: "weakest", name: "Weakest", read: (report) => sure(report)?.weakest },
];

const optional = <T>(value: T | undefined, show: (value: T) => string): string | undefined =>
  value === undefined ? undefined : show(value);

/** An uncertainty of half a turn means that the angle is unknown. */
const sigmas = (degrees: readonly number[]): string =>
  degrees.every((value) => value >= 180)
    ? "unknown"
    : `${degrees.map((value) => (value >= 180 ? "any" : decimals(value, 2))).join(", ")}°`;
