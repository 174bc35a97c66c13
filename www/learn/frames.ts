/** The panels of each lesson before they are computed, so that a figure has its size from the beginning. */

import { make } from "../dom";
import { phrase } from "../words";
import type { LessonId, Panel } from "./protocol";

/** The kinds of the panels in their order: tests/contract/lesson-frames.test.mjs compares them with the figures. */
export const FRAMES: Readonly<Record<LessonId, readonly Panel["kind"][]>> = {
  normal: ["image", "image", "image"],
  lambert: ["image", "image", "image", "plot"],
  relief: ["image", "image", "image", "plot"],
  strips: ["image", "image", "cloud", "plot"],
  orders: ["image", "image", "image", "image", "plot"],
  pixel: ["image", "image", "image", "plot"],
  grey: ["image", "image", "plot", "image"],
  colours: ["image", "image", "image", "image"],
  surface: ["image", "image", "image", "plot"],
  prior: ["image", "image", "image", "plot", "plot"],
  pose: ["image", "cloud", "image", "plot"],
  loop: ["image", "cloud", "image"],
  sensor: ["image", "image", "image", "plot"],
  paint: ["image", "image", "image", "image"],
  failure: ["image", "image", "cloud", "image"],
};

/** The place of a picture, whose free room the style sheet of the slides measures. */
export const placed = (canvas: HTMLElement): HTMLElement => make("div", { class: "learn-place" }, canvas);

/** An empty panel in the place of one that is being computed. */
export function blank(kind: Panel["kind"]): HTMLElement {
  const isPlot = kind === "plot";
  return make(
    "div",
    { class: `learn-panel learn-blank${isPlot ? " learn-wide" : ""}` },
    make("p", { class: "learn-computing" }, phrase("figure.computing", "Computing")),
    isPlot ? make("div", { class: "learn-plot-box" }) : placed(make("div", { class: "learn-canvas plain" })),
    make("p", { class: "learn-legend" }),
  );
}
