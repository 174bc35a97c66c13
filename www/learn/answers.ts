/** Whether the answers of guesses and exercises are hidden, as a link can ask. A button shows them and hides them again. */

import { make } from "../dom";
import { phrase } from "../words";

export class Answers {
  /** Its attribute data-answers is "hidden" or "shown" once they have been hidden; the style sheet does the rest. */
  readonly #parent: HTMLElement;
  readonly #onChange: () => void;

  constructor(parent: HTMLElement, onChange: () => void) {
    this.#parent = parent;
    this.#onChange = onChange;
  }

  get areHidden(): boolean {
    return this.#parent.dataset.answers === "hidden";
  }

  /** The part of an address that hides them for others, too. */
  get inAddress(): { answers?: "hidden" } {
    return this.areHidden ? { answers: "hidden" } : {};
  }

  hide(): void {
    this.#parent.dataset.answers = "hidden";
  }

  toggle(): void {
    this.#parent.dataset.answers = this.areHidden ? "shown" : "hidden";
    this.#onChange();
  }

  /** Both labels are in the document, and the style sheet shows one of them. */
  button(): HTMLButtonElement {
    const button = make(
      "button",
      { type: "button", class: "learn-answers" },
      make("span", { class: "when-hidden" }, phrase("answers.show", "Show answers")),
      make("span", { class: "when-shown" }, phrase("answers.hide", "Hide answers")),
    );
    button.addEventListener("click", () => this.toggle());
    return button;
  }
}
