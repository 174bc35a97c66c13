/** The record of a run: its reports, its initial pose, and the truth if known. */

import { isWithinSearch } from "./verdict";
import type { Opened } from "../engine/protocol";
import type { Pose, StepReport } from "../../pkg/index.js";

export class RunRecord {
  truth: Opened["truth"] = null;
  /** The unit of lengths in the image. */
  length: Opened["units"]["image"] = "px";
  /** The newest. */
  report: StepReport | undefined;
  /** Where the loop began. */
  from: Pose | undefined;
  /** One report for each completed iteration. */
  history: StepReport[] = [];
  /** Number of frames so far; the first one shows the start. */
  #frames = 0;

  get isFinished(): boolean {
    return this.report !== undefined && this.report.status !== "running";
  }

  get iteration(): number {
    return this.report?.iteration ?? 0;
  }

  /** Whether anything has been computed since the start. */
  get hasBegun(): boolean {
    return this.#frames > 1 || this.iteration > 0;
  }

  isSearching(by: "step" | "stage"): boolean {
    return this.report !== undefined && isWithinSearch(this.report, by);
  }

  add(reports: readonly StepReport[]): void {
    this.#frames++;
    for (const report of reports) {
      // The pose where the registration starts. A search has found it before the first iteration.
      this.from ??= report.pose;
      this.report = report;
      if (report.iteration > (this.history.at(-1)?.iteration ?? 0)) this.history.push(report);
    }
  }

  /** Starts a new record for the same input. */
  restart(): void {
    this.#frames = 0;
    this.history = [];
    this.from = undefined;
  }

  /** Clears the record when its input is gone. */
  clear(): void {
    this.report = undefined;
    this.truth = null;
    this.restart();
  }
}
