/** What a control looks like while it is still moved: one look at a time, and of what was asked for meanwhile the newest. */

import type { Settings } from "./settings";

export class Trial {
  /** What is to be looked at next: what it changes in the settings. */
  #next: Settings | undefined;
  #isLooking = false;
  readonly #look: (patch: Settings) => Promise<void>;

  constructor(look: (patch: Settings) => Promise<void>) {
    this.#look = look;
  }

  async show(patch: Settings): Promise<void> {
    this.#next = patch;
    if (this.#isLooking) return;
    this.#isLooking = true;
    while (this.#next) {
      const next: Settings = this.#next;
      this.#next = undefined;
      await this.#look(next);
    }
    this.#isLooking = false;
  }

  /** What is moved has come to rest: nothing more is only looked at. */
  end(): void {
    this.#next = undefined;
  }
}
