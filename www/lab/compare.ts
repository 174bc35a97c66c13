/** A pinned run, compared with later runs: its curves are dashed, and its pictures and surfaces are shown left of the wipe. */

import { byId } from "../dom";

export interface CompareHooks {
  onPin(): void;
  onUnpin(): void;
  /** The pinned run's share of the width. */
  onWipe(share: number): void;
}

export class Compare {
  readonly #button = byId("pin", HTMLButtonElement);
  readonly #wipe = byId("wipe", HTMLInputElement);
  readonly #words = byId("pinned-words", HTMLElement);
  readonly #hooks: CompareHooks;
  #isPinned = false;

  constructor(hooks: CompareHooks) {
    this.#hooks = hooks;
    this.#button.addEventListener("click", () => this.#pin(!this.#isPinned));
    const place = () => this.#hooks.onWipe(Number(this.#wipe.value) / 100);
    this.#wipe.addEventListener("input", place);
    place();
    this.#show();
  }

  /** Removes the pinned run. */
  release(): void {
    if (this.#isPinned) this.#pin(false);
  }

  #pin(isPinned: boolean): void {
    this.#isPinned = isPinned;
    if (isPinned) this.#hooks.onPin();
    else this.#hooks.onUnpin();
    this.#show();
  }

  /** The state of the pinned run. */
  say(words: string): void {
    this.#words.textContent = words;
    this.#words.title = words && `pinned: ${words}`;
  }

  #show(): void {
    this.#button.setAttribute("aria-pressed", String(this.#isPinned));
    this.#button.textContent = this.#isPinned ? "Unpin" : "Pin this run";
    this.#wipe.disabled = !this.#isPinned;
    if (!this.#isPinned) this.say("");
  }
}
