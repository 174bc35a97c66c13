/** One figure at a time in large type for presenting to a class; the arrow keys change slides. */

import { make } from "../dom";
import { phrase } from "../words";

/** Elements that use the arrow keys themselves. */
const MOVED_BY_ARROWS = "input:not([type=checkbox]), select, textarea";

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
        [phrase("slides.previous", "Previous lesson"), -1, "←"],
        [phrase("slides.next", "Next lesson"), 1, "→"],
      ] as const
    ).map(([words, by, sign]) => {
      const button = make("button", { type: "button", "aria-label": words }, sign);
      button.addEventListener("click", () => this.#onTurn(by));
      return { by, button };
    });
    const close = make("button", { type: "button" }, phrase("slides.close", "Close (Esc)"));
    close.addEventListener("click", () => this.close());
    const whole = make(
      "button",
      { type: "button", hidden: !document.fullscreenEnabled },
      phrase("slides.fill", "Full screen (F)"),
    );
    whole.addEventListener("click", () => this.#fill());
    this.element = make(
      "dialog",
      { class: "learn-slides" },
      this.#holder,
      make("div", { class: "learn-slide-bar" }, ...this.#turns.map(({ button }) => button), whole, close),
    );
    this.element.addEventListener("keydown", (event) => this.#key(event));
    // After a drag of a slider the arrow keys turn slides again; a slider that the Tab key reached keeps them.
    this.element.addEventListener("pointerup", ({ target }) => {
      if (target instanceof HTMLInputElement && target.type === "range") this.#title()?.focus({ preventScroll: true });
    });
    this.element.addEventListener("close", () => {
      if (document.fullscreenElement) void document.exitFullscreen();
      onClose();
    });
  }

  get isOpen(): boolean {
    return this.element.open;
  }

  open(slide: Slide): void {
    this.element.showModal();
    this.take(slide);
  }

  take({ article, title, hasBeside }: Slide): void {
    this.element.setAttribute("aria-label", phrase("slides.slide", "Slide: {title}", { title }));
    for (const { by, button } of this.#turns) button.disabled = !hasBeside(by);
    this.#holder.replaceChildren(article);
    this.#holder.scrollTop = 0;
    // A removed control loses the focus, and then the keys would have no target.
    this.#title()?.focus();
  }

  #title(): HTMLElement | null {
    return this.#holder.querySelector("h2");
  }

  close(): void {
    if (this.element.open) this.element.close();
  }

  /** The page as a whole, because no browser gives the screen to a dialog. Where it refuses, the slide stays in the window. */
  #fill(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => {});
  }

  #key(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === "f" && !event.repeat) return this.#fill();
    const by = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 }[event.key] as 1 | -1 | undefined;
    if (by === undefined) return;
    const isArrow = event.key.startsWith("Arrow");
    if (isArrow && event.target instanceof Element && event.target.closest(MOVED_BY_ARROWS)) return;
    event.preventDefault();
    this.#onTurn(by);
  }
}
