/** The explanation behind a "?" or a stage. */

import type { Stage } from "../../pkg/index.js";
import { byId, make } from "../dom";
import type { Method, Term } from "./explain";

export type Question = { stage: Stage } | { term: Term };

export class Explanations {
  readonly #popover = byId("explanation", HTMLElement);
  readonly #method: () => Method;

  constructor(method: () => Method) {
    this.#method = method;
  }

  async open(question: Question): Promise<void> {
    const { explainStage, explainTerm } = await import("./explain");
    const method = this.#method();
    this.#popover.replaceChildren(
      ...("stage" in question ? explainStage(question.stage, method) : explainTerm(question.term, method)),
    );
    this.#popover.showPopover();
  }

  /** A "?" beside the explained item. */
  button(term: Term, name: string): HTMLButtonElement {
    const button = make(
      "button",
      { type: "button", class: "quiet hint", "aria-haspopup": "dialog", "aria-label": `What is "${name}"?` },
      "?",
    );
    button.addEventListener("click", () => void this.open({ term }));
    return button;
  }
}
