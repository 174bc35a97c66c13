/** One figure at a time in large type for presenting to a class; the arrow keys change slides. */

import { make } from "../dom";

/** Elements that use the arrow keys themselves. */
const MOVED_BY_ARROWS = "input, select, textarea";

export interface Slide {
  article: HTMLElement;
  title: string;
  /** Whether there is a next or a previous slide. */
  hasBeside(by: 1 | -1): boolean;
}

export class Slides {
  readonly element: HTMLDialogElement;
  readonly #holder = make("div", { class: "learn-slide" });
  readonly #turns: readonly { by: 1 | -1; button: HTMLButtonElement }[];
  readonly #onTurn: (by: 1 | -1) => void;

  constructor(onTurn: (by: 1 | -1) => void, onClose: () => void) {
    this.#onTurn = onTurn;
    this.#turns = (
      [
        ["Previous lesson", -1, "←"],
        ["Next lesson", 1, "→"],
      ] as const
    ).map(([words, by, sign]) => {
      const button = make("button", { type: "button", "aria-label": words }, sign);
      button.addEventListener("click", () => this.#onTurn(by));
      return { by, button };
    });
    const close = make("button", { type: "button" }, "Close (Esc)");
    close.addEventListener("click", () => this.close());
    this.element = make(
      "dialog",
      { class: "learn-slides" },
      this.#holder,
      make("div", { class: "learn-slide-bar" }, ...this.#turns.map(({ button }) => button), close),
    );
    this.element.addEventListener("keydown", (event) => this.#key(event));
    this.element.addEventListener("close", onClose);
  }

  get isOpen(): boolean {
    return this.element.open;
  }

  open(slide: Slide): void {
    this.element.showModal();
    this.take(slide);
  }

  take({ article, title, hasBeside }: Slide): void {
    this.element.setAttribute("aria-label", `Slide: ${title}`);
    for (const { by, button } of this.#turns) button.disabled = !hasBeside(by);
    this.#holder.replaceChildren(article);
    this.#holder.scrollTop = 0;
    // A removed control loses the focus, and then the keys would have no target.
    article.querySelector("h2")?.focus();
  }

  close(): void {
    if (this.element.open) this.element.close();
  }

  #key(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const by = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 }[event.key] as 1 | -1 | undefined;
    if (by === undefined) return;
    const isArrow = event.key.startsWith("Arrow");
    if (isArrow && event.target instanceof Element && event.target.closest(MOVED_BY_ARROWS)) return;
    event.preventDefault();
    this.#onTurn(by);
  }
}
