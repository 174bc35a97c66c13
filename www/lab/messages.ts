/** Shows errors and guesses beside their field or file, or else above all fields. */

import { byId } from "../dom";
import { EngineError } from "../engine/engine";
import type { Opened } from "../engine/protocol";
import type { Form } from "./form";
import type { Intake, Remark } from "./intake";

/** Guesses that may be wrong, shown beside the files as well, because fields may be folded. */
function standing({ "depth.unit": unit, "image.mask": mask }: Opened["notes"], drawMask: () => void): Remark[] {
  const action = { label: "Draw a mask", press: drawMask };
  // The field itself shows what other units would give.
  const short = unit?.replace(/ \([^()]*\)/, "");
  return [
    ...(short ? [{ words: `Unit of depth: ${short} Settings, Depth camera, Unit changes that.`, wrong: false }] : []),
    ...(mask ? [{ words: `${mask} Drop a mask, or draw one.`, wrong: false, action }] : []),
  ];
}

export class Messages {
  readonly #alert = byId("alert", HTMLElement);
  readonly #form: Form;
  readonly #intake: Intake;
  readonly #drawMask: () => void;
  #notes: Opened["notes"] = {};

  constructor(form: Form, intake: Intake, drawMask: () => void) {
    this.#form = form;
    this.#intake = intake;
    this.#drawMask = drawMask;
  }

  /** Removes errors; guesses about the input stay beside the fields. */
  clear(): void {
    this.#alert.hidden = true;
    this.note(this.#notes);
  }

  /** Shows what was guessed about the input. */
  note(notes: Opened["notes"]): void {
    this.#notes = notes;
    this.#form.clearMessages();
    this.#intake.clearMessages();
    this.#intake.remarks("pair", standing(notes, this.#drawMask));
    for (const [path, note] of Object.entries(notes)) {
      // A missing mask is reported beside a button that draws one.
      if (path === "image.mask" || this.#intake.remark(path, note)) continue;
      this.#form.remark(path, note);
    }
  }

  /** Reports an error; if it is shown beside a field, returns a short name of that field. */
  fail(error: unknown): { field: string; words: string } | undefined {
    const message = error instanceof Error ? error.message : String(error);
    const field = error instanceof EngineError ? error.field : undefined;
    const placed = field === undefined ? undefined : this.#complain(field, message);
    this.#alert.textContent = message;
    this.#alert.hidden = placed !== undefined;
    return placed;
  }

  /** Adds a sentence to an error; `shown` is where it must be visible. */
  add(words: string, shown = false): void {
    this.#alert.textContent = `${this.#alert.textContent.replace(/\.?$/, ".")} ${words}`;
    if (shown) this.#alert.hidden = false;
  }

  /** Beside its field a message need not repeat the field's name. */
  #complain(field: string, message: string): { field: string; words: string } | undefined {
    const words = message.startsWith(`${field}: `) ? message.slice(field.length + 2) : message;
    const label = this.#intake.complain(field, words) ?? this.#form.complain(field, words);
    return label === undefined ? undefined : { field: label, words };
  }
}
