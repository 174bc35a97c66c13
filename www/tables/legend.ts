/** The meaning of the colours and shapes of a grid. */

import { make } from "../dom";
import { marks } from "./heat";
import type { Panel } from "./panels";
import { rampLegend } from "./ramp";

const swatch = (state: string, words: string): HTMLElement =>
  make(
    "span",
    { class: "key-cell" },
    make("span", { class: "heat-cell sample", "data-state": state, "aria-hidden": "true" }),
    words,
  );

export function legend({ unit, paper }: Panel): HTMLElement {
  return make(
    "div",
    { class: "heat-legend" },
    rampLegend(unit),
    make(
      "p",
      { class: "keys-line" },
      ...(paper ? [make("span", {}, `small: the paper's, in ${unit === "°" ? "degrees" : unit.trim()}`)] : []),
      swatch("idle", "not run"),
      swatch("waiting", "waiting"),
      swatch("running", "running"),
      swatch("failed", "failed"),
      ...marks.map(({ kind, glyph, words }) =>
        make(
          "span",
          { class: "key-cell" },
          make("span", { class: "mark", "data-mark": kind, "aria-hidden": "true" }, glyph),
          words,
        ),
      ),
    ),
  );
}
