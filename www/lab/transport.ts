/** The buttons that run the loop. If there is nothing to run they stay focusable and state the reason. */

import { byId } from "../dom";

const IDS = ["play", "step", "stage-step", "reset"] as const;

/** Height of a low window; bar.css has the same number. */
const low = matchMedia("(max-height: 30rem)");

export class Transport {
  readonly #play = byId("play", HTMLButtonElement);
  readonly #buttons = IDS.map((id) => byId(id, HTMLButtonElement));

  constructor() {
    low.addEventListener("change", () => this.#settle());
    this.#settle();
    for (const button of this.#buttons) {
      // Registered before all other listeners, so that it is called first.
      button.addEventListener("click", (event) => {
        if (button.getAttribute("aria-disabled") === "true") event.stopImmediatePropagation();
      });
    }
  }

  /** The buttons stick to the lower edge of the window; in a low window, where nothing sticks, they stand above the surfaces. */
  #settle(): void {
    const bar = byId("bar", HTMLElement);
    const focused = bar.contains(document.activeElement) ? document.activeElement : undefined;
    if (low.matches) byId("inputs", HTMLElement).before(bar);
    else document.querySelector("footer")?.after(bar);
    // An element that is moved loses the focus.
    if (focused instanceof HTMLElement) focused.focus();
  }

  /** `lacking` describes the missing input, in words. */
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
