/** The status of the run, in a panel of fixed height: a mark, a word, one cause, and what may help. */

import type { StepReport } from "../../pkg/index.js";
import { byId } from "../dom";
import type { Origin } from "./settings";
import type { Verdict } from "./verdict";

/** States of the page other than those of the loop. */
export type Notice = "loading" | "waiting" | "error";

/** The marks of the Tables, and those of unfinished states. */
const glyphs: Readonly<Record<string, string>> = {
  ready: "○",
  paused: "‖",
  playing: "▸",
  loading: "…",
  waiting: "…",
  error: "!",
  converged: "✓",
  doubted: "~",
  "max-iterations": "=",
  ambiguous: "?",
  lost: "×",
};

/** A tick is for poses that can be trusted: beside a wrong pose it would contradict the words. */
const markOf = (state: string, tone: Verdict["tone"]): string =>
  state !== "converged" || tone === "good" ? state : tone === "wrong" ? "lost" : "doubted";

export class Status {
  readonly #panel = byId("panel", HTMLElement);
  readonly #icon = byId("status-icon", HTMLElement);
  readonly #word = byId("status", HTMLElement);
  readonly #cause = byId("verdict", HTMLElement);
  readonly #message = byId("message", HTMLElement);
  readonly #next = byId("next", HTMLElement);
  #doubt = "";
  #isOwn = false;

  /** `doubt` describes what seems wrong with own files and how to correct it; it takes precedence over other advice. */
  about(origin: Origin, doubt: string): void {
    this.#isOwn = origin === "files";
    this.#doubt = this.#isOwn ? doubt : "";
  }

  /** `idle` is the state of the page while the loop is paused. The verdict is that of the best pose, even while an alternative pose is shown. */
  show(report: StepReport, idle: "ready" | "paused" | "playing", end: Verdict | undefined, isRival: boolean): void {
    this.#say(
      end ? report.status : idle,
      end?.tone ?? "open",
      end ? `${isRival ? "best pose: " : ""}${end.status}` : idle,
    );
    this.#put(this.#cause, end?.words ?? "");
    this.#put(this.#next, this.#doubt || (end?.next ?? (idle === "ready" ? this.#first : "")));
    this.#put(this.#message, end ? "" : (report.message ?? ""));
  }

  /** Something other than the loop is running, or has failed. */
  announce(state: Notice, words: string, cause: string): void {
    this.#say(state, state === "error" ? "wrong" : "open", words);
    this.#put(this.#cause, cause);
    this.#put(this.#next, this.#doubt);
    this.#put(this.#message, "");
  }

  /** The most important advice for the present input. */
  get #first(): string {
    return this.#isOwn
      ? "Press play; masks, cameras and the method are in the settings."
      : "Press play, or choose another example.";
  }

  #say(state: string, tone: Verdict["tone"], word: string): void {
    const mark = markOf(state, tone);
    this.#panel.dataset.tone = tone;
    this.#word.dataset.state = state;
    this.#word.dataset.tone = tone;
    this.#icon.dataset.mark = mark === "max-iterations" ? "stopped" : mark;
    this.#put(this.#icon, glyphs[mark] ?? "");
    this.#put(this.#word, word);
  }

  /** Setting the same words again would have them read aloud again. */
  #put(element: HTMLElement, words: string): void {
    if (element.textContent !== words) element.textContent = words;
  }
}
