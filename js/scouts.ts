/** Other threads that take parts of the opening search off an estimator's hands. */
import { compiled, spawn } from "./engine.js";
import type { Answer, Order, Thread } from "./scouting.js";
import type { ColorImage, DepthMap, Options } from "./types.js";

/** What the estimator's side of wasm gives away and takes in. */
export interface Tasks {
  take(): Float64Array | undefined;
  accept(finding: Float64Array): void;
}

/** Tasks that a scout has before it: enough for some ten milliseconds, in which its estimator may not be heard of. */
const IN_HAND = 3;

interface Hired {
  thread: Thread;
  inHand: number;
}

/** A copy of its own for another thread: a view would take along all of the buffer it looks into. */
function copyOf<T extends object>(input: T, transfer: ArrayBuffer[]): T {
  const copy = structuredClone(
    Object.fromEntries(Object.entries(input).filter(([, value]) => !ArrayBuffer.isView(value))),
  );
  for (const [key, value] of Object.entries(input)) {
    if (!ArrayBuffer.isView(value)) continue;
    const array = (value as Float32Array<ArrayBuffer>).slice();
    transfer.push(array.buffer);
    copy[key] = array;
  }
  return copy as T;
}

/**
 * Scouts change how long a search takes, and nothing else: where none can be had, or one fails, the estimator does all
 * of it. They hear of new tasks and are heard whenever their estimator's thread lets events through.
 */
export class Scouts {
  #hired: Hired[] = [];
  #run = 0;
  #searching = false;
  #options: Options;
  readonly #tasks: Tasks;

  /** Hires `count` scouts for one pair, or as many as can be had. */
  constructor(count: number, image: ColorImage, depth: DepthMap, options: Options, tasks: Tasks) {
    this.#tasks = tasks;
    // Its owner may change it before the next search.
    this.#options = structuredClone(options);
    try {
      for (let hired = 0; hired < count; hired++) this.#hire(image, depth);
    } catch {
      // A page may forbid workers, a system may be out of threads.
    }
  }

  #hire(image: ColorImage, depth: DepthMap): void {
    const thread = spawn();
    if (!thread) return;
    const hired: Hired = { thread, inHand: 0 };
    this.#hired.push(hired);
    thread.onAnswer((answer) => this.#hear(hired, answer));
    thread.onFailure(() => this.#dismiss(hired));
    const transfer: ArrayBuffer[] = [];
    const order: Order = { kind: "meet", module: compiled(), image: copyOf(image, transfer), depth: copyOf(depth, transfer) };
    thread.post(order, transfer);
  }

  /** The loop begins, with other options if there are any, and with a search unless they give a pose. */
  begin(options = this.#options): void {
    this.#options = structuredClone(options);
    this.rest();
    if ((options.start ?? "search") !== "search") return;
    this.#run++;
    this.#searching = true;
    for (const hired of this.#hired) {
      hired.inHand = 0;
      hired.thread.post({ kind: "search", run: this.#run, options: this.#options }, []);
    }
  }

  /** Hands out tasks, as many as there are and scouts have hands for. */
  feed(): void {
    if (!this.#searching) return;
    for (const hired of this.#hired) {
      while (hired.inHand < IN_HAND) {
        const task = this.#tasks.take();
        if (!task) return;
        hired.inHand++;
        hired.thread.post({ kind: "task", run: this.#run, task }, []);
      }
    }
  }

  /** The search is over: scouts give their memory back and wait for the next one. */
  rest(): void {
    if (!this.#searching) return;
    this.#searching = false;
    for (const { thread } of this.#hired) thread.post({ kind: "rest" }, []);
  }

  /** Ends their threads. */
  end(): void {
    this.#searching = false;
    for (const hired of [...this.#hired]) this.#dismiss(hired);
  }

  #hear(hired: Hired, { run, finding }: Answer): void {
    if (!this.#hired.includes(hired)) return;
    if (finding === null) return this.#dismiss(hired);
    if (!this.#searching || run !== this.#run) return;
    hired.inHand--;
    try {
      this.#tasks.accept(finding);
      this.feed();
    } catch {
      // Of an estimator that has broken off its next call will tell.
      this.end();
    }
  }

  #dismiss(hired: Hired): void {
    this.#hired = this.#hired.filter((other) => other !== hired);
    hired.thread.end();
  }
}
