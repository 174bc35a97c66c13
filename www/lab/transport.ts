/** The buttons that run the loop, as they stand. */

import { byId } from "../dom";

export class Transport {
  readonly #play = byId("play", HTMLButtonElement);

  show(playing: boolean): void {
    this.#play.setAttribute("aria-pressed", String(playing));
    this.#play.setAttribute("aria-label", playing ? "Pause" : "Play");
  }
}
