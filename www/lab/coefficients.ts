/** The 27 numbers of a sample's light, each with a slider: nine per channel, grouped by their order in the normal. */

import { make } from "../dom";
import { decimals } from "../draw/numbers";
import type { Settings } from "./settings";
import { lightText } from "./settings";

export interface CoefficientHooks {
  /** Called while a slider moves, and once more when it stops; `gesture` stays the same until the slider is released. */
  onLight(patch: Settings, done: boolean, gesture: object): void;
}

/** Harmonics of one channel as functions of the normal: x right, y down, z away. */
const PER_CHANNEL = 9;
const ORDERS = [
  { name: "Order 0: brightness", of: [[0, "1"]] },
  {
    name: "Order 1: one side brighter",
    of: [
      [3, "x"],
      [1, "y"],
      [2, "z"],
    ],
  },
  {
    name: "Order 2: equal on opposite sides",
    of: [
      [4, "xy"],
      [5, "yz"],
      [6, "z²"],
      [7, "xz"],
      [8, "x² − y²"],
    ],
  },
] as const;
const CHANNELS = ["red", "green", "blue"] as const;

/** Largest absolute value of a slider, a factor of e² that no built-in light reaches, and the step of a slider. */
const MOST = 2;
const STEP = 0.01;
/** How long, in milliseconds, a slider rests before its value takes effect. */
const REST = 200;

export class Coefficients {
  readonly element: HTMLElement;
  readonly #hooks: CoefficientHooks;
  readonly #sliders = new Map<number, HTMLInputElement>();
  readonly #readout = make("output", {}, "x right, y down, z away");
  #values: number[] = [];
  #resting: ReturnType<typeof setTimeout> | undefined;
  #gesture = {};

  constructor(hooks: CoefficientHooks) {
    this.#hooks = hooks;
    const heads = CHANNELS.map((channel) => make("span", { class: "channel" }, channel));
    const groups = ORDERS.map(({ name, of }) =>
      make(
        "fieldset",
        {},
        make("legend", {}, name),
        ...of.flatMap(([k, harmonic]) => [
          make("span", { class: "harmonic", "aria-hidden": "true" }, harmonic),
          ...CHANNELS.map((channel, c) => this.#slider(PER_CHANNEL * c + k, `${channel}, ${harmonic}`)),
        ]),
      ),
    );
    this.element = make(
      "details",
      { id: "coefficients", hidden: true },
      make("summary", {}, "All 27 coefficients"),
      this.#readout,
      make("div", { class: "channels", "aria-hidden": "true" }, make("span"), ...heads),
      ...groups,
    );
  }

  /** The coefficients of a known light, if any. */
  show(values: ArrayLike<number> | null): void {
    this.element.hidden = values === null;
    // A slider that the visitor moves is ahead of the drawing.
    if (!values || this.#resting !== undefined) return;
    this.#values = Array.from(values);
    for (const [index, slider] of this.#sliders) slider.value = String(this.#values[index] ?? 0);
  }

  #slider(index: number, name: string): HTMLInputElement {
    const slider = make("input", { type: "range", min: -MOST, max: MOST, step: STEP, "aria-label": name });
    this.#sliders.set(index, slider);
    slider.addEventListener("focus", () => this.#say(name, index));
    slider.addEventListener("input", () => {
      this.#values[index] = slider.valueAsNumber;
      this.#say(name, index);
      this.#hooks.onLight(this.#patch(), false, this.#gesture);
      clearTimeout(this.#resting);
      this.#resting = setTimeout(() => this.#finish(), REST);
    });
    slider.addEventListener("change", () => {
      this.#finish();
      this.#gesture = {};
    });
    return slider;
  }

  #finish(): void {
    if (this.#resting === undefined) return;
    clearTimeout(this.#resting);
    this.#resting = undefined;
    this.#hooks.onLight(this.#patch(), true, this.#gesture);
  }

  #say(name: string, index: number): void {
    this.#readout.textContent = `${name}: ${decimals(this.#values[index], 2)}`;
  }

  /** The numbers are those of the rotated light, so that the rotation itself is reset. */
  #patch(): Settings {
    return { light: lightText(this.#values), lightTurn: 0, lightTilt: 0 };
  }
}
