/** The range of values that one or more views share, automatic or fixed by the visitor, with its legend. */

import { make } from "../dom";
import type { Raster } from "../engine/protocol";
import { automaticRange, gradient, type MapName, type Range } from "./colours";
import { short } from "./numbers";

/** The range of a view that has no values yet. */
const NOTHING: Range = { min: 0, max: 1 };

export class Scale {
  readonly map: MapName;
  #automatic = NOTHING;
  #fixed: Range | null = null;
  #listeners: (() => void)[] = [];
  #legends: { min: HTMLInputElement; max: HTMLInputElement; auto: HTMLButtonElement; unit: HTMLElement }[] = [];
  /** Zero as a fixed lower end suits quantities that cannot be negative. */
  readonly #fromZero: boolean;

  constructor(map: MapName, fromZero = false) {
    this.map = map;
    this.#fromZero = fromZero;
  }

  /** Calls back when every view on this scale has to be painted again. */
  listen(listener: () => void): void {
    this.#listeners.push(listener);
  }

  get range(): Range {
    return this.#fixed ?? this.#automatic;
  }

  /** Takes the automatic range from these values. */
  follow(raster: Raster): void {
    const range = automaticRange(raster) ?? NOTHING;
    this.#automatic = this.#fromZero ? { min: 0, max: range.max } : range;
    if (!this.#fixed) this.#tell();
  }

  /** A legend for one view; `name` tells screen readers which. */
  legend(name: string): { element: HTMLElement; setUnit(unit: string): void } {
    const end = (which: "min" | "max") => {
      const input = make("input", { type: "number", step: "any", "aria-label": `${name}: ${which === "min" ? "lowest" : "highest"} value shown` });
      input.addEventListener("change", () => {
        if (Number.isFinite(input.valueAsNumber)) this.#fixed = { ...this.range, [which]: input.valueAsNumber };
        this.#tell();
      });
      return input;
    };
    const min = end("min");
    const max = end("max");
    const unit = make("span", { class: "unit" });
    const auto = make("button", { type: "button", class: "quiet", "aria-pressed": "true", "aria-label": `${name}: range follows the values, auto` }, "auto");
    auto.addEventListener("click", () => {
      this.#fixed = this.#fixed ? null : this.#automatic;
      this.#tell();
    });
    const bar = make("span", { class: "bar", style: `background: ${gradient(this.map)}` });
    this.#legends.push({ min, max, auto, unit });
    this.#show();
    return {
      element: make("div", { class: "legend" }, min, bar, max, unit, auto),
      setUnit: (text) => (unit.textContent = text),
    };
  }

  #tell(): void {
    this.#show();
    for (const listener of this.#listeners) listener();
  }

  #show(): void {
    for (const { min, max, auto } of this.#legends) {
      min.value = short(this.range.min);
      max.value = short(this.range.max);
      auto.setAttribute("aria-pressed", String(this.#fixed === null));
    }
  }
}
