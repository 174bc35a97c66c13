/** Examples at a press: each says all that differs from the defaults, so that what comes out does not depend on what was set before. */

import { make } from "../dom";
import { defaults, type Settings, type Value } from "./settings";

interface Preset {
  name: string;
  /** What one is to see there. */
  words: string;
  set: Readonly<Record<string, Value>>;
}

export const presets: readonly Preset[] = [
  { name: "Easy bust", words: "Three coloured lamps, 20 degrees apart, no noise.", set: {} },
  {
    name: "Window light",
    words: "Nearly one colour of light, as in a room, and 40 degrees.",
    set: { light: "window", beta: 40, noise: 0.01 },
  },
  {
    name: "Noise",
    words: "5 % of noise in the colours, and a noisy depth map; the pose is found all the same.",
    set: { noise: 0.05, depthNoise: 0.5 },
  },
  {
    name: "Half hidden",
    words: "The depth map shows the middle half of the object alone; the pose is found all the same.",
    set: { overlap: 0.5, beta: 30, noise: 0.01 },
  },
  {
    name: "Too hard",
    words:
      "A third of the object, nearly one colour of light, and 30 % of noise: no pose can be told from that, and the verdict says so.",
    set: { size: "64", light: "window", beta: 40, noise: 0.3, overlap: 0.3 },
  },
  {
    name: "The paper's loop",
    words: "Equations 1 to 19 as published: the light told, each pixel on its own, ICP from where both views coincide.",
    set: { size: "64", lighting: "known", start: "identity", registration: "icp", shading: "pixel" },
  },
  {
    // Photographs whose terms let them be shipped are none of the project's; this one says what it is.
    name: "Sensor-like",
    words:
      "No photograph: a made scene as cheap sensors see it, under clouds, with noise in both views, holes and an edge cut off.",
    set: { light: "overcast", beta: 25, alpha: 6, noise: 0.02, depthNoise: 0.7, holes: 0.05, overlap: 0.85 },
  },
];

const settingsOf = ({ set }: Preset): Settings => ({ ...defaults, ...set });

/** Buttons, of which the one that says what is set is pressed. */
export class Presets {
  readonly #buttons: readonly { preset: Preset; button: HTMLButtonElement }[];

  /** `onChoose` is told of another example, `onAgain` of a press of the one that is set. */
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
    for (const { preset, button } of this.#buttons) {
      const wanted = settingsOf(preset);
      button.setAttribute(
        "aria-pressed",
        String(isSample && Object.keys(wanted).every((key) => wanted[key] === settings[key])),
      );
    }
  }
}
