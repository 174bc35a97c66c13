/** A run that is pinned, beside those that come after it: its curves are dashed, its pictures and surfaces lie left of the wipe. */

import { byId } from "../dom";

export interface CompareHooks {
  onPin(): void;
  onUnpin(): void;
  /** Share of the width that is the pinned run's. */
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

  /** Lets go of what is pinned. */
  release(): void {
    if (this.#isPinned) this.#pin(false);
  }

  #pin(isPinned: boolean): void {
    this.#isPinned = isPinned;
    if (isPinned) this.#hooks.onPin();
    else this.#hooks.onUnpin();
    this.#show();
  }

  /** What the pinned run had come to. */
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
