/** Examples behind buttons. Each lists all differences from the defaults, so that the result does not depend on earlier settings. */

import { byId, make } from "../dom";
import { defaults, type Settings, type Value } from "./settings";

interface Preset {
  name: string;
  /** A sentence about what the example shows. */
  words: string;
  set: Readonly<Record<string, Value>>;
}

export const presets: readonly Preset[] = [
  { name: "Easy bust", words: "Three coloured lamps, views 20 degrees apart, no noise.", set: {} },
  {
    name: "Window light",
    words: "Light of nearly one colour, as in a room; views 40 degrees apart.",
    set: { light: "window", beta: 40, noise: 0.01 },
  },
  {
    name: "Noise",
    words: "5 % noise in the colours and a noisy depth map; the pose is still found.",
    set: { noise: 0.05, depthNoise: 0.5 },
  },
  {
    name: "Half hidden",
    words: "The depth map covers only the middle half of the object; the pose is still found.",
    set: { overlap: 0.5, beta: 30, noise: 0.01 },
  },
  {
    name: "Too hard",
    words:
      "Views 70 degrees apart, a third of the object, light of nearly one colour and 30 % noise. Not even the search's best rotation is near the true one, and the verdict says so.",
    set: { size: "64", light: "window", beta: 70, noise: 0.3, overlap: 0.3 },
  },
  {
    name: "The paper's loop",
    words:
      "Equations 1 to 19 as published: light given, pixels solved independently, ICP starting with the views aligned.",
    set: { size: "64", lighting: "known", start: "identity", registration: "icp", shading: "pixel" },
  },
  {
    // The project has no photographs that it may ship, so this example states that it is synthetic.
    name: "Sensor-like",
    words:
      "Not a photograph: a synthetic scene as a cheap sensor would see it under an overcast sky, with noise, holes and a cropped edge.",
    set: { light: "overcast", beta: 25, alpha: 6, noise: 0.02, depthNoise: 0.7, holes: 0.05, overlap: 0.85 },
  },
];

const settingsOf = ({ set }: Preset): Settings => ({ ...defaults, ...set });

/** Buttons; the one that matches the settings is pressed. */
export class Presets {
  /** The sentence about the present example, for devices without tooltips. */
  readonly #words = byId("example", HTMLElement);
  readonly #buttons: readonly { preset: Preset; button: HTMLButtonElement }[];

  /** `onChoose` is called for another example, `onAgain` for a click on the current one. */
  constructor(parent: HTMLElement, onChoose: (settings: Settings) => void, onAgain: () => void) {
    this.#buttons = presets.map((preset) => {
      const button = make(
        "button",
        { type: "button", "aria-pressed": "false", title: preset.words, "aria-description": preset.words },
        preset.name,
      );
      button.addEventListener("click", () =>
        button.getAttribute("aria-pressed") === "true" ? onAgain() : onChoose(settingsOf(preset)),
      );
      parent.append(button);
      return { preset, button };
    });
  }

  show(settings: Settings, isSample: boolean): void {
    const isSet = ({ preset }: { preset: Preset }) => {
      const wanted = settingsOf(preset);
      return isSample && Object.keys(wanted).every((key) => wanted[key] === settings[key]);
    };
    for (const each of this.#buttons) each.button.setAttribute("aria-pressed", String(isSet(each)));
    const { name, words } = this.#buttons.find(isSet)?.preset ?? {};
    this.#words.textContent = name === undefined ? "" : `${name}: ${words}`;
  }
}
