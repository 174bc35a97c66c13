/** Other threads that take parts of the opening search off an estimator's hands. */
import { compiled, spawn } from "./engine.js";
import { copyOf } from "./plain.js";
import type { Answer, Thread } from "./scouting.js";
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

/**
 * Scouts change how long a search takes, and nothing else: where none can be had, or one fails, the estimator does all
 * of it. They hear of new tasks and are heard whenever their estimator's thread lets events through. Their threads last as
 * long as the search.
 */
export class Scouts {
  #hired: Hired[] = [];
  readonly #count: number;
  readonly #image: ColorImage;
  readonly #depth: DepthMap;
  readonly #tasks: Tasks;

  /** For one pair, of which it keeps a copy: its owner may change it before the next search. */
  constructor(count: number, image: ColorImage, depth: DepthMap, tasks: Tasks) {
    this.#count = count;
    this.#image = copyOf(image, []);
    this.#depth = copyOf(depth, []);
    this.#tasks = tasks;
  }

  /** A search begins, which nobody works at yet. */
  begin(options: Options): void {
    this.end();
    try {
      for (let hired = 0; hired < this.#count; hired++) this.#hire(options);
    } catch {
      // A page may forbid workers, a system may be out of threads or of memory for them.
    }
  }

  #hire(options: Options): void {
    const thread = spawn();
    if (!thread) return;
    const hired: Hired = { thread, inHand: 0 };
    this.#hired.push(hired);
    thread.onAnswer((answer) => this.#hear(hired, answer));
    thread.onFailure(() => this.#dismiss(hired));
    const transfer: ArrayBuffer[] = [];
    const [image, depth] = [copyOf(this.#image, transfer), copyOf(this.#depth, transfer)];
    thread.post({ kind: "search", module: compiled(), image, depth, options }, transfer);
  }

  /** Hands out tasks, as many as there are and scouts have hands for. */
  feed(): void {
    for (const hired of this.#hired) {
      while (hired.inHand < IN_HAND) {
        const task = this.#tasks.take();
        if (!task) return;
        hired.inHand++;
        hired.thread.post({ kind: "task", task }, []);
      }
    }
  }

  /** The search is over, or they are not wanted any more. */
  end(): void {
    for (const hired of [...this.#hired]) this.#dismiss(hired);
  }

  #hear(hired: Hired, finding: Answer): void {
    if (!this.#hired.includes(hired)) return;
    if (finding === null) return this.#dismiss(hired);
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
