/** Sets the controls of a lesson for a task or an answer, and moves one of them slowly enough to be watched. */

import type { Controls } from "./controls";
import type { Lesson, Try } from "./lesson";
import type { Values } from "./protocol";

/** Steps of a slow move and the milliseconds between them: browsers refuse more than some 100 changes of an address in half a minute. */
const STEPS = 20;
const EVERY = 100;

export class Player {
  readonly #lesson: Lesson;
  readonly #controls: Controls;
  #timer = 0;

  constructor(lesson: Lesson, controls: Controls) {
    this.#lesson = lesson;
    this.#controls = controls;
    // Using any control stops the animation.
    for (const kind of ["pointerdown", "keydown"]) controls.element.addEventListener(kind, () => this.stop());
  }

  get isPlaying(): boolean {
    return this.#timer !== 0;
  }

  /** Calls `last` just before the controls take their last state. Visitors who prefer no motion see that state at once. */
  play({ set = {}, sweep, step: moved }: Try, last: () => void = () => {}): void {
    this.stop();
    if (moved !== undefined) return this.#move(moved, set);
    const slider = this.#lesson.controls.find(({ key }) => key === sweep?.key);
    if (!sweep || slider?.kind !== "slider" || matchMedia("(prefers-reduced-motion: reduce)").matches) {
      last();
      return this.#controls.set({ ...set, ...(sweep ? { [sweep.key]: sweep.to } : {}) });
    }
    this.#controls.set(set);
    const from = Number(this.#controls.values[sweep.key]);
    let step = 0;
    this.#timer = window.setInterval(() => {
      step++;
      const value = from + (step / STEPS) * (sweep.to - from);
      const whole = step === STEPS ? sweep.to : Math.round(value / slider.step) * slider.step;
      if (step === STEPS) {
        this.stop();
        last();
      }
      this.#controls.set({ [sweep.key]: Number(whole.toFixed(6)) });
    }, EVERY);
  }

  #move(key: string, set: Values): void {
    const slider = this.#lesson.controls.find((each) => each.key === key);
    if (slider?.kind !== "slider") return;
    const next = Math.min(slider.max, Number(this.#controls.values[key]) + slider.step);
    this.#controls.set({ ...set, [key]: next });
  }

  stop(): void {
    clearInterval(this.#timer);
    this.#timer = 0;
  }
}
