/** The numbers of a figure, each in the colour of what it measures. */

import { make } from "../dom";
import type { Readout } from "./lesson";
import { decimals, withUnit } from "./digits";
import type { Drawing } from "./protocol";

/** A number that is not known yet. With its unit it is about as wide as the number, which then moves nothing. */
const blank = ({ unit }: Readout): string => (unit ? withUnit("–", unit) : "–");

export class Readouts {
  readonly element: HTMLElement;
  readonly #rows: { readout: Readout; value: HTMLElement }[];

  constructor(readouts: readonly Readout[]) {
    this.#rows = readouts.map((readout) => ({
      readout,
      value: make(
        "dd",
        { "data-number": readout.key, class: readout.ink ? `learn-ink-${readout.ink}` : "words" },
        blank(readout),
      ),
    }));
    this.element = make(
      "dl",
      { class: "learn-numbers" },
      ...this.#rows.map(({ readout, value }) => make("div", {}, make("dt", {}, readout.label), value)),
    );
  }

  /** Marks the numbers as those of an earlier state, until the next drawing. */
  wait(): void {
    this.element.setAttribute("aria-busy", "true");
  }

  show({ numbers, words = {} }: Drawing): void {
    this.element.setAttribute("aria-busy", "false");
    for (const { readout, value } of this.#rows) {
      const word = words[readout.key];
      const number = numbers[readout.key];
      const known = number !== undefined && Number.isFinite(number);
      value.textContent = word ?? (known ? withUnit(decimals(number, readout.digits ?? 2), readout.unit) : "–");
      value.classList.toggle("words", word !== undefined);
      if (known) value.dataset.value = String(number);
      else delete value.dataset.value;
    }
  }
}
