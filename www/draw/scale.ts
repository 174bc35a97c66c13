/** The range of values that one or more views share, automatic or fixed by the visitor, with its legend. */

import { make } from "../dom";
import type { Range } from "../engine/protocol";
import { gradient, type MapName } from "./colours";
import { short } from "./numbers";

export class Scale {
  readonly #map: MapName;
  #range: Range = { min: 0, max: 1 };
  #isFixed = false;
  readonly #onChange: () => void;
  #legends: { min: HTMLInputElement; max: HTMLInputElement; auto: HTMLButtonElement; unit: HTMLElement }[] = [];

  /** `onChange` is called when every view on this scale has to be redrawn. */
  constructor(map: MapName, onChange: () => void) {
    this.#map = map;
    this.#onChange = onChange;
  }

  /** The range that the visitor has fixed, if any. */
  get fixed(): Range | undefined {
    return this.#isFixed ? this.#range : undefined;
  }

  /** The range of the last drawing. */
  follow(range: Range): void {
    if (this.#isFixed) return;
    this.#range = range;
    this.#show();
  }

  /** A legend for one view; `name` tells screen readers which. */
  legend(name: string): { element: HTMLElement; setUnit(unit: string): void } {
    const end = (which: "min" | "max") => {
      const input = make("input", {
        type: "number",
        step: "any",
        "aria-label": `${name}: ${which === "min" ? "lowest" : "highest"} value shown`,
      });
      input.addEventListener("blur", () => this.#show());
      input.addEventListener("change", () => {
        if (Number.isFinite(input.valueAsNumber)) {
          this.#range = { ...this.#range, [which]: input.valueAsNumber };
          this.#isFixed = true;
        }
        this.#tell();
      });
      return input;
    };
    const min = end("min");
    const max = end("max");
    const unit = make("span", { class: "unit" });
    const auto = make(
      "button",
      {
        type: "button",
        class: "quiet",
        "aria-pressed": "true",
        "aria-label": `${name}: range follows the values, auto`,
      },
      "auto",
    );
    auto.addEventListener("click", () => {
      this.#isFixed = !this.#isFixed;
      this.#tell();
    });
    const bar = make("span", { class: "bar" });
    bar.style.background = gradient(this.#map);
    this.#legends.push({ min, max, auto, unit });
    this.#show();
    return {
      element: make("div", { class: "legend" }, min, bar, max, unit, auto),
      setUnit: (text) => (unit.textContent = text),
    };
  }

  #tell(): void {
    this.#show();
    this.#onChange();
  }

  #show(): void {
    // Frames arrive while a visitor types, so the focused field keeps its text.
    const put = (input: HTMLInputElement, value: number) => {
      if (document.activeElement !== input) input.value = short(value);
    };
    for (const { min, max, auto } of this.#legends) {
      put(min, this.#range.min);
      put(max, this.#range.max);
      auto.setAttribute("aria-pressed", String(!this.#isFixed));
    }
  }
}
