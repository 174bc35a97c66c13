/** The numbers of a figure, each in the colour of what it measures. */

import { make } from "../dom";
import { decimals } from "../draw/numbers";
import type { Readout } from "./lesson";
import type { Drawing } from "./protocol";

export class Readouts {
  readonly element: HTMLElement;
  readonly #rows: { readout: Readout; value: HTMLElement }[];

  constructor(readouts: readonly Readout[]) {
    this.#rows = readouts.map((readout) => ({
      readout,
      value: make(
        "dd",
        { "data-number": readout.key, ...(readout.ink ? { class: `learn-ink-${readout.ink}` } : {}) },
        "–",
      ),
    }));
    this.element = make(
      "dl",
      { class: "learn-numbers" },
      ...this.#rows.map(({ readout, value }) => make("div", {}, make("dt", {}, readout.label), value)),
    );
  }

  show({ numbers, words = {} }: Drawing): void {
    for (const { readout, value } of this.#rows) {
      const word = words[readout.key];
      const number = numbers[readout.key];
      const unit = readout.unit === undefined ? "" : /^[°%]$/.test(readout.unit) ? readout.unit : ` ${readout.unit}`;
      const known = number !== undefined && Number.isFinite(number);
      value.textContent = word ?? (known ? `${decimals(number, readout.digits ?? 2)}${unit}` : "–");
      value.classList.toggle("words", word !== undefined);
      if (known) value.dataset.value = String(number);
      else delete value.dataset.value;
    }
  }
}
