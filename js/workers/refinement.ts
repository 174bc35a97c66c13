/** A worker that refines the depth view while the estimator's own thread finds the image surface. */
import type { PlainOptions } from "../options.js";
import { READY, type WorkerAnswer, type Views, type WorkerHandle } from "./messages.js";
import { startWorker } from "./start.js";

/** A refinement to be computed: the number of its initial shape, other numbers, and the rasters one after the other. */
export type RefinementTask = [shape: number, numbers: Float64Array, planes: Float32Array];

/** A finished refinement: the number of its initial shape, and the new shape. */
export interface Refinement {
  shape: number;
  planes: Float32Array;
}

/**
 * Longest wait for an answer, milliseconds: a refinement of the largest views takes half of this time. After that the estimator continues
 * alone.
 */
const LONGEST_WAIT = 2000;

/**
 * The worker affects only how long an iteration takes: without one, or if it fails or is late, the estimator refines alone to the end of
 * the loop. The worker lasts as long as the loop.
 */
export class RefinementWorker {
  readonly #pair: Views;
  readonly #unavailable: (reason: unknown) => void;
  #worker: WorkerHandle | undefined;
  /** Whether it could not be started or has failed; no other one is started in this loop. */
  #failed = false;
  /** Whether it has read the pair. */
  #ready = false;
  /** The shape from which the current refinement started. */
  #asked: number | undefined;
  /** The shape that the worker has. */
  #held: number | undefined;
  #answer: Refinement | undefined;
  #waiting: (() => void)[] = [];

  constructor(pair: Views, unavailable: (reason: unknown) => void) {
    this.#pair = pair;
    this.#unavailable = unavailable;
  }

  /** Starts the worker of a loop, unless it has been started. */
  begin(options: PlainOptions): void {
    if (this.#worker || this.#failed) return;
    const worker = startWorker(this.#pair, options, this.#unavailable);
    this.#worker = worker;
    this.#failed = !worker;
    worker?.onAnswer((answer) => {
      if (worker === this.#worker) this.#receive(answer);
    });
    worker?.onFailure(() => {
      if (worker === this.#worker) this.#fail();
    });
  }

  /** Requests the next refinement, unless one is still under way; `take` makes the task for a worker that has the shape. */
  ask(take: (held: number | undefined) => RefinementTask | undefined): void {
    this.#answer = undefined;
    if (!this.#worker || !this.#ready || this.isBusy) return;
    const task = take(this.#held);
    if (!task) return;
    const [shape, numbers, planes] = task;
    this.#asked = shape;
    try {
      this.#worker.post({ kind: "refine", numbers, planes }, [planes.buffer as ArrayBuffer]);
    } catch {
      this.#fail();
    }
  }

  /** Whether a refinement is under way. */
  get isBusy(): boolean {
    return this.#asked !== undefined;
  }

  /** The answers since the last refinement was requested. */
  get answer(): Refinement | undefined {
    return this.#answer;
  }

  /** Waits until there is an answer, or it is certain that there will be none. */
  async settled(): Promise<void> {
    if (!this.isBusy) return;
    const late = setTimeout(() => this.#fail(), LONGEST_WAIT);
    await new Promise<void>((resolve) => this.#waiting.push(resolve));
    clearTimeout(late);
  }

  /** Ends the worker, because the loop is over or the estimator was freed. */
  end(): void {
    this.#worker?.end();
    this.#worker = this.#asked = this.#held = this.#answer = undefined;
    this.#ready = this.#failed = false;
    this.#resume();
  }

  #fail(): void {
    this.end();
    this.#failed = true;
  }

  #receive(answer: WorkerAnswer): void {
    if (answer === READY) {
      this.#ready = true;
      return;
    }
    const shape = this.#asked;
    if (!(answer instanceof Float32Array) || shape === undefined) return this.#fail();
    this.#asked = undefined;
    this.#held = shape + 1;
    this.#answer = { shape, planes: answer };
    this.#resume();
  }

  /** Releases the callers that are waiting for the answer. */
  #resume(): void {
    const waiting = this.#waiting;
    this.#waiting = [];
    for (const resolve of waiting) resolve();
  }
}
