/** `<bimodal-figure>`: the live figure of a lesson. The lessons load with the first one that is shown. */

import type { BimodalFigureElement, FigureResult } from "../../pkg/elements.js";
import { Base } from "./base";
import type { Shown } from "./lesson-figure";

export class BimodalFigure extends Base implements BimodalFigureElement {
  static readonly observedAttributes = ["lesson", "state"];
  protected readonly settable = ["lesson", "state"];
  #shown: Shown | undefined;
  #result: FigureResult | undefined;
  /** Starts are numbered, because the lessons may arrive after another start. */
  #turn = 0;
  /** The state that the visitor's own change has just written. */
  #written: string | undefined;

  get lesson(): string {
    return this.text("lesson");
  }
  set lesson(value: string) {
    this.write("lesson", value);
  }
  get state(): string {
    return this.text("state");
  }
  set state(value: string) {
    this.write("state", value);
  }
  get result(): FigureResult | undefined {
    return this.#result;
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (before === now || (name === "state" && (now ?? "") === this.#written)) return;
    if (name === "lesson" || !this.#shown) return this.restart();
    // Waits for the other changes of this task, because the state may be meant for the lesson that is set next.
    queueMicrotask(() => {
      if (!this.isScheduled) this.#shown?.set(this.state);
    });
  }

  protected stop(): void {
    this.#turn++;
    this.#shown?.end();
    this.#shown = undefined;
    this.#written = undefined;
  }

  protected start(): void {
    this.#result = undefined;
    if (this.lesson !== "") void this.#load(this.#turn);
  }

  async #load(turn: number): Promise<void> {
    try {
      const { show } = await import("./lesson-figure");
      if (turn !== this.#turn) return;
      const root = this.shadowRoot ?? this.attachShadow({ mode: "open" });
      this.#shown = show(root, this.lesson, this.state, {
        onResult: (result, done) => this.#take(result, done),
        onState: (state) => this.#write(state),
        onError: (error) => this.fail(error),
      });
    } catch (error) {
      if (turn === this.#turn)
        this.fail({ code: "init", message: `the lessons could not be loaded (${String(error)})` });
    }
  }

  #take(result: FigureResult, done: boolean): void {
    this.forgive();
    this.#result = result;
    this.tell("step", result);
    if (done) this.tell("done", result);
  }

  #write(state: string): void {
    if (state === this.#written) return;
    this.#written = state;
    this.write("state", state);
    this.tell("status", { state });
  }
}
