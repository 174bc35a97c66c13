/** One fixed logarithmic ramp for all tables, so that a colour means the same number everywhere. */

import { colourAt, gradient, type MapName } from "../draw/colours";
import { make } from "../dom";

const MAP: MapName = "viridis";
/** The exponents of ten at its ends; values beyond take the end's colour. */
const FROM = -3;
const TO = 2;

/** Where a value lies on the ramp, 0 .. 1. */
const shareOf = (value: number): number => (Math.log10(value) - FROM) / (TO - FROM);

const bytes = (value: number): [number, number, number] =>
  colourAt(MAP, value > 0 ? Math.max(0, Math.min(1, shareOf(value))) : 0);

export const colourOf = (value: number): string => `rgb(${bytes(value).join(" ")})`;

/** Whether black is more legible than white on the colour of a value, by the luminance of the contrast formula. */
export function wantsBlack(value: number): boolean {
  const [r = 0, g = 0, b = 0] = bytes(value).map((byte) => (byte / 255) ** 2.2);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18;
}

/** The ramp with a tick at every power of ten. */
export function rampLegend(unit: string): HTMLElement {
  const ticks = Array.from({ length: TO - FROM + 1 }, (_, i) => make("span", {}, `${10 ** (FROM + i)}${unit}`));
  const bar = make("div", { class: "ramp-bar", style: `background: ${gradient(MAP)}` });
  return make(
    "div",
    { class: "ramp", role: "img", "aria-label": `Colours from ${10 ** FROM} to ${10 ** TO}${unit}, logarithmic` },
    bar,
    make("div", { class: "ramp-ticks" }, ...ticks),
  );
}
