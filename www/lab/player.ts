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

/** Iterations that take longer than this, in milliseconds, are played stage by stage, to show more and to react sooner to a pause. */
const SLOW = 300;

export interface PlayerHooks {
  /** Computes and draws one frame; resolves when it is on the screen, true while the loop has more to do. */
  advance(request: Advance): Promise<boolean>;
  /** Restarts the loop; resolves when its first frame is on the screen, or the input has been refused. */
  restart(): Promise<void>;
  isFinished(): boolean;
  /** Whether a step of this kind is still within the search. */
  isSearching(by: Advance["by"]): boolean;
  onChange(): void;
  /** Called with the error and with a function that repeats the interrupted step, unless the run has been paused. */
  onError(error: unknown, again: Again | undefined): void;
}

/** `isThere` tells whether a run that began anew has repeated the iterations that had been completed. */
export type Again = (isThere: () => boolean) => void;

export class Player {
  pace = 1;
  #playing = false;
  #turn = 0;
  #waiting = false;
  #underWay: Promise<boolean> = Promise.resolve(true);
  /** The step under way. */
  #stepping: Advance["by"] | undefined;
  /** The kind of playing that was requested, until it is paused. */
  #asked: Again | undefined;
  readonly #hooks: PlayerHooks;

  constructor(hooks: PlayerHooks) {
    this.#hooks = hooks;
  }

  /** A step of several frames, such as the search, plays until it is done. */
  get playing(): boolean {
    return this.#playing || (this.#stepping !== undefined && this.#hooks.isSearching(this.#stepping));
  }

  toggle(): void {
    if (this.playing) this.pause();
    else void this.#play();
  }

  pause(): void {
    const { playing } = this;
    this.#asked = undefined;
    this.#stepping = undefined;
    this.#playing = false;
    if (playing) this.#hooks.onChange();
  }

  /**
   * Runs an iteration or a stage. The search is one stage and belongs to the first iteration, however many frames it takes. One key press
   * waits for the frame under way; others, for example from a key held down, are ignored. If `isThere` is given, the run plays until it
   * is true.
   */
  async step(by: Advance["by"], isThere = () => true): Promise<void> {
    this.pause();
    if (this.#waiting) return;
    this.#waiting = true;
    await this.#underWay;
    this.#waiting = false;
    const turn = ++this.#turn;
    if (!(await this.#catchUp(isThere, turn))) return;
    this.#asked = (isThere) => void this.step(by, isThere);
    this.#stepping = by;
    let more = true;
    do more = await this.#once({ by, milliseconds: 0 });
    while (more && turn === this.#turn && this.#stepping && this.#hooks.isSearching(by));
    if (turn === this.#turn) this.pause();
  }

  /** Plays until `isThere`. False if it was paused before, or nothing is left to do. */
  async #catchUp(isThere: () => boolean, turn: number): Promise<boolean> {
    if (turn !== this.#turn || isThere()) return turn === this.#turn;
    this.#playing = true;
    this.#hooks.onChange();
    const isOn = () => this.#playing && turn === this.#turn;
    let more = true;
    while (more && isOn() && !isThere()) more = await this.#once({ by: "step", milliseconds: 0 });
    const goesOn = more && isOn();
    if (turn === this.#turn) this.pause();
    return goesOn;
  }

  async #play(): Promise<void> {
    // Pausing and playing again must not start a second loop.
    const turn = ++this.#turn;
    const isOn = () => this.#playing && turn === this.#turn;
    this.#playing = true;
    this.#stepping = undefined;
    this.#asked = () => void this.#play();
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
      const again = this.#asked;
      this.#asked = undefined;
      this.#stepping = undefined;
      this.#playing = false;
      this.#hooks.onError(error, again);
      return false;
    } finally {
      this.#hooks.onChange();
    }
  }
}
