/** The stages of an iteration: the one that ran last is highlighted, its time is shown below, and a click explains it. */

import type { Stage, StepReport } from "../../pkg/index.js";
import { decimals } from "../draw/numbers";
import { byId, make } from "../dom";
import { searched } from "../engine/searched";
import type { Explanations } from "./ask";

/** The search, and the five stages of one iteration. */
const stages: readonly Stage[] = ["search", "light", "shading", "surface", "registration", "refinement"];

/** Times below this, in milliseconds, would round to zero. */
const LEAST = 0.05;

export class Strip {
  readonly #buttons = new Map<Stage, { button: HTMLButtonElement; time: HTMLElement }>();
  readonly #count = byId("iteration", HTMLElement);
  #last: Stage | undefined;

  constructor(list: HTMLElement, explanations: Explanations) {
    for (const name of stages) {
      const time = make("span", { class: "time" });
      const button = make(
        "button",
        { type: "button", class: "stage", "aria-haspopup": "dialog" },
        make("span", {}, name),
        time,
      );
      button.addEventListener("click", () => void explanations.open({ stage: name }));
      this.#buttons.set(name, { button, time });
      list.append(make("li", {}, button));
    }
  }

  show(report: StepReport): void {
    const begun = report.iteration > 0 || report.milliseconds[report.stage] !== undefined;
    this.#last = begun ? report.stage : undefined;
    for (const [name, { button, time }] of this.#buttons) {
      const spent = report.milliseconds[name];
      button.toggleAttribute("data-lit", name === report.stage && begun);
      if (name === "search" && report.stage === name) time.textContent = searched(report);
      // The last slice that was drawn is seldom the last slice that ran.
      else if (name === "search" && begun && time.textContent?.endsWith("%")) time.textContent = "100 %";
      // A converged stage is not computed again, so its time rounds to zero.
      else if (spent !== undefined && spent < LEAST) time.textContent = "";
      else if (spent !== undefined) time.textContent = `${decimals(spent, spent < 10 ? 1 : 0)} ms`;
      else if (!begun) time.textContent = "";
    }
    this.#count.textContent = String(report.iteration);
  }

  /** Marks the stage under way: the one after the last; a search has many slices. */
  run(): void {
    if (this.#last === "search") return;
    const names = [...this.#buttons.keys()];
    const next = names[this.#last ? (names.indexOf(this.#last) + 1) % names.length : 0];
    for (const [name, { button }] of this.#buttons) button.toggleAttribute("data-lit", name === next);
  }
}
