/** Another thread that refines the depth view while the estimator's own finds the image surface. */
import { hire } from "./spawn.js";
import { READY, type Answer, type Pair, type Thread } from "./threads.js";
import type { Options } from "./types.js";

/** A refinement to be made: the number of the shape that it starts from, numbers, and rasters one after the other. */
export type RefinementTask = [shape: number, numbers: Float64Array, planes: Float32Array];

/** What has become of one: the number of the shape that it started from, and the new one. */
export interface Refinement {
  shape: number;
  planes: Float32Array;
}

/** Longest wait for an answer, milliseconds: a refinement of the largest views takes half of it. Who waits longer goes on alone. */
const PATIENCE = 2000;

/**
 * The partner changes how long an iteration takes, and nothing else: where there is none, or it fails or is late, the
 * estimator refines alone, to the end of the loop. Its thread lasts as long.
 */
export class Partner {
  readonly #pair: Pair;
  #thread: Thread | undefined;
  /** Whether it was in vain, and nobody is hired again in this loop. */
  #failed = false;
  /** Whether it has read the pair. */
  #ready = false;
  /** The shape that the refinement under way started from. */
  #asked: number | undefined;
  /** The shape that the partner has. */
  #held: number | undefined;
  #answer: Refinement | undefined;
  #waiting: (() => void)[] = [];

  constructor(pair: Pair) {
    this.#pair = pair;
  }

  /** A loop begins, unless it is under way. */
  begin(options: Options): void {
    if (this.#thread || this.#failed) return;
    const thread = hire(this.#pair, options);
    this.#thread = thread;
    this.#failed = !thread;
    thread?.onAnswer((answer) => {
      if (thread === this.#thread) this.#hear(answer);
    });
    thread?.onFailure(() => {
      if (thread === this.#thread) this.#fail();
    });
  }

  /** Asks for the next refinement, unless one is still under way; `take` gives its task to who holds a shape. */
  ask(take: (held: number | undefined) => RefinementTask | undefined): void {
    this.#answer = undefined;
    if (!this.#thread || !this.#ready || this.isBusy) return;
    const task = take(this.#held);
    if (!task) return;
    const [shape, numbers, planes] = task;
    this.#asked = shape;
    try {
      this.#thread.post({ kind: "refine", numbers, planes }, [planes.buffer as ArrayBuffer]);
    } catch {
      this.#fail();
    }
  }

  /** Whether a refinement is under way. */
  get isBusy(): boolean {
    return this.#asked !== undefined;
  }

  /** What has been found since it was asked for. */
  get answer(): Refinement | undefined {
    return this.#answer;
  }

  /** Until there is an answer, or none to be had. */
  async rest(): Promise<void> {
    if (!this.isBusy) return;
    const late = setTimeout(() => this.#fail(), PATIENCE);
    await new Promise<void>((resolve) => this.#waiting.push(resolve));
    clearTimeout(late);
  }

  /** The loop is over, or the partner not wanted any more. */
  end(): void {
    this.#thread?.end();
    this.#thread = this.#asked = this.#held = this.#answer = undefined;
    this.#ready = this.#failed = false;
    this.#wake();
  }

  #fail(): void {
    this.end();
    this.#failed = true;
  }

  #hear(answer: Answer): void {
    if (answer === READY) {
      this.#ready = true;
      return;
    }
    const shape = this.#asked;
    if (!(answer instanceof Float32Array) || shape === undefined) return this.#fail();
    this.#asked = undefined;
    this.#held = shape + 1;
    this.#answer = { shape, planes: answer };
    this.#wake();
  }

  #wake(): void {
    const waiting = this.#waiting;
    this.#waiting = [];
    for (const resume of waiting) resume();
  }
}
