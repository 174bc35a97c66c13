/** The panels beside the views: the stages of a run, its pose, the rivals, the light, the map of scores, and the status. */

import { byId } from "../dom";
import type { Frame } from "../engine/protocol";
import type { Explanations } from "./ask";
import { LightPanel, type LightHooks } from "./light";
import { PoseTable } from "./posetable";
import type { RunRecord } from "./record";
import { Rivals, type RivalHooks } from "./rivals";
import { ScoreMap } from "./scoremap";
import type { Origin } from "./settings";
import { Status, type Notice } from "./status";
import { Strip } from "./strip";
import { isSearching, standing, type Verdict } from "./verdict";

export class Panels {
  readonly light: LightPanel;
  readonly #rivals: Rivals;
  readonly #strip: Strip;
  readonly #pose: PoseTable;
  readonly #status = new Status();
  readonly #scores = new ScoreMap();

  constructor(explanations: Explanations, hooks: { rivals: RivalHooks; light: LightHooks }) {
    this.#strip = new Strip(byId("stages", HTMLElement), explanations);
    this.#pose = new PoseTable(byId("pose", HTMLTableElement), explanations);
    this.#rivals = new Rivals(hooks.rivals);
    this.light = new LightPanel(hooks.light);
    byId("objective-title", HTMLElement).append(explanations.button("objective", "Objective"));
  }

  /** Whether the results shown are those of the previous run. */
  date(isBefore: boolean): void {
    this.#pose.date(isBefore);
    this.light.date(isBefore);
  }

  /** A stage is being computed. */
  run(): void {
    this.#strip.run();
  }

  /** The run begins anew. */
  clear(): void {
    this.#scores.clear();
    this.date(false);
  }

  /** The parts of a new frame besides surfaces. */
  take({ light, scores }: Frame, { report, truth }: RunRecord): void {
    this.light.show(light, report ? standing(report) : "start");
    this.#scores.show(scores, truth);
  }

  /** `doubt` describes what seems wrong with the visitor's files. */
  about(origin: Origin, doubt: string): void {
    this.#status.about(origin, doubt);
  }

  /** `end` is the verdict of a run that is over. */
  show({ report, from, truth, length }: RunRecord, playing: boolean, end: Verdict | undefined): void {
    if (!report) return;
    this.#rivals.show(report);
    const { looked } = this.#rivals;
    this.#pose.show(report, looked, from, truth, length);
    this.#strip.show(report);
    const idle = playing ? "playing" : report.iteration > 0 || isSearching(report) ? "paused" : "ready";
    this.#status.show(report, idle, end, looked !== undefined);
    this.light.beside(looked !== undefined);
  }

  /** Something other than the loop is running, or has failed. */
  announce({ state, words, cause }: { state: Notice; words: string; cause: string }): void {
    this.#status.announce(state, words, cause);
  }
}
