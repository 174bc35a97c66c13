/** Numbers in a text that show the value of a control and can be dragged sideways. Keyboards can use the control itself. */

import type { Controls } from "./controls";
import { shown, type Lesson, type SliderControl } from "./lesson";
import type { Values } from "./protocol";

/** Pixels of a drag over the whole range of a slider. */
const RANGE = 300;

export class TextNumbers {
  readonly #shown: readonly { element: HTMLElement; slider: SliderControl }[];

  /** Takes the numbers that the text has for sliders of the lesson. */
  constructor(text: HTMLElement, { controls }: Lesson, set: Controls) {
    this.#shown = [...text.querySelectorAll<HTMLElement>("[data-control]")].flatMap((element) => {
      const slider = controls.find(({ key }) => key === element.dataset.control);
      if (slider?.kind !== "slider") return [];
      draggable(element, slider, set);
      return [{ element, slider }];
    });
  }

  show(values: Values): void {
    for (const { element, slider } of this.#shown)
      element.textContent = shown(slider, Number(values[slider.key] ?? slider.initial), values);
  }
}

function draggable(element: HTMLElement, { key, min, max, step }: SliderControl, controls: Controls): void {
  let [from, start] = [0, 0];
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    element.setPointerCapture(event.pointerId);
    [from, start] = [event.clientX, Number(controls.values[key])];
  });
  element.addEventListener("pointermove", (event) => {
    if (!element.hasPointerCapture(event.pointerId)) return;
    const value = start + ((event.clientX - from) / RANGE) * (max - min);
    const whole = min + Math.round((Math.min(max, Math.max(min, value)) - min) / step) * step;
    controls.set({ [key]: Number(whole.toFixed(6)) });
  });
}
