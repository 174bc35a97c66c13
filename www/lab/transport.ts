/** The buttons that run the loop, as they stand; where there is nothing to run they can still be reached, and say why. */

import { byId } from "../dom";

const IDS = ["play", "step", "stage-step", "reset"] as const;

export class Transport {
  readonly #play = byId("play", HTMLButtonElement);
  readonly #buttons = IDS.map((id) => byId(id, HTMLButtonElement));

  constructor() {
    for (const button of this.#buttons) {
      // Before anyone else who listens: it comes first.
      button.addEventListener("click", (event) => {
        if (button.getAttribute("aria-disabled") === "true") event.stopImmediatePropagation();
      });
    }
  }

  /** `lacking` is what there has to be before anything can run, in words. */
  show(playing: boolean, lacking: string): void {
    this.#play.setAttribute("aria-pressed", String(playing));
    this.#play.setAttribute("aria-label", playing ? "Pause" : "Play");
    for (const button of this.#buttons) {
      if (lacking) {
        button.setAttribute("aria-disabled", "true");
        button.title = `Nothing to run (${lacking})`;
      } else {
        button.removeAttribute("aria-disabled");
        button.removeAttribute("title");
      }
    }
  }
}
