/** Play, pause and step: requests the next frame from the worker only when the last one has been drawn. */

import type { Calls } from "../engine/protocol";

export type Advance = Omit<Calls["advance"]["request"], "look">;

/** Paces of play, slow to fast: the least time between two frames and how long the worker may compute for one. */
export const paces = [
  { label: "2 per second", pause: 500, milliseconds: 0 },
  { label: "8 per second", pause: 125, milliseconds: 0 },
  { label: "one per frame", pause: 0, milliseconds: 0 },
  { label: "fastest", pause: 0, milliseconds: 30 },
] as const;

/** Iterations that take longer than this, in milliseconds, are played stage by stage, which shows more, and a pause takes effect sooner. */
const SLOW = 300;

export interface PlayerHooks {
  /** Computes and draws one frame; resolves when it is on the screen, true while the loop has more to do. */
  advance(request: Advance): Promise<boolean>;
  /** Restarts the loop; resolves when its first frame is on the screen, or the input has been refused. */
  restart(): Promise<void>;
  isFinished(): boolean;
  onChange(): void;
  /** The error, and whether it occurred while the run played. */
  onError(error: unknown, playing: boolean): void;
}

export class Player {
  pace = 1;
  #playing = false;
  #turn = 0;
  #waiting = false;
  #underWay: Promise<boolean> = Promise.resolve(true);
  readonly #hooks: PlayerHooks;

  constructor(hooks: PlayerHooks) {
    this.#hooks = hooks;
  }

  get playing(): boolean {
    return this.#playing;
  }

  toggle(): void {
    if (this.#playing) this.pause();
    else void this.#play();
  }

  pause(): void {
    if (!this.#playing) return;
    this.#playing = false;
    this.#hooks.onChange();
  }

  /** One key press waits for the frame under way; further ones, for example from a key held down, are ignored. */
  async step(by: Advance["by"]): Promise<void> {
    this.pause();
    if (this.#waiting) return;
    this.#waiting = true;
    await this.#underWay;
    this.#waiting = false;
    await this.#once({ by, milliseconds: 0 });
  }

  async #play(): Promise<void> {
    // Pausing and playing again must not start a second loop.
    const turn = ++this.#turn;
    const isOn = () => this.#playing && turn === this.#turn;
    this.#playing = true;
    this.#hooks.onChange();
    await this.#underWay;
    if (isOn() && this.#hooks.isFinished()) await this.#hooks.restart();
    let by: Advance["by"] = "step";
    while (isOn()) {
      const { pause, milliseconds } = paces[this.pace] ?? paces[1];
      const began = performance.now();
      const more = await this.#once({ by, milliseconds });
      if (!more) break;
      const spent = performance.now() - began;
      if (spent > SLOW + milliseconds) by = "stage";
      const rest = pause - spent;
      if (rest > 0) await new Promise((resolve) => setTimeout(resolve, rest));
    }
    if (turn === this.#turn) this.pause();
  }

  /** False when there is nothing more to do. */
  #once(request: Advance): Promise<boolean> {
    this.#underWay = this.#attempt(request);
    return this.#underWay;
  }

  async #attempt(request: Advance): Promise<boolean> {
    try {
      return await this.#hooks.advance(request);
    } catch (error) {
      const playing = this.#playing;
      this.#playing = false;
      this.#hooks.onError(error, playing);
      return false;
    } finally {
      this.#hooks.onChange();
    }
  }
}
