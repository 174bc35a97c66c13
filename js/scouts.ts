/** Other threads that take parts of the opening search off an estimator's hands. */
import { hire } from "./spawn.js";
import { READY, type Answer, type Pair, type Thread } from "./threads.js";
import type { Options } from "./types.js";

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
  readonly #pair: Pair;
  readonly #tasks: Tasks;

  constructor(count: number, pair: Pair, tasks: Tasks) {
    this.#count = count;
    this.#pair = pair;
    this.#tasks = tasks;
  }

  /** A search begins, which nobody works at yet. */
  begin(options: Options): void {
    this.end();
    for (let hired = 0; hired < this.#count; hired++) this.#hire(options);
  }

  #hire(options: Options): void {
    const thread = hire(this.#pair, options);
    if (!thread) return;
    const hired: Hired = { thread, inHand: 0 };
    this.#hired.push(hired);
    thread.onAnswer((answer) => this.#hear(hired, answer));
    thread.onFailure(() => this.#dismiss(hired));
  }

  /** Hands out tasks, as many as there are and scouts have hands for. */
  feed(): void {
    for (const hired of [...this.#hired]) {
      while (hired.inHand < IN_HAND) {
        const task = this.#tasks.take();
        if (!task) return;
        hired.inHand++;
        try {
          hired.thread.post({ kind: "task", task }, []);
        } catch {
          this.#dismiss(hired);
          break;
        }
      }
    }
  }

  /** The search is over, or they are not wanted any more. */
  end(): void {
    for (const hired of [...this.#hired]) this.#dismiss(hired);
  }

  #hear(hired: Hired, finding: Answer): void {
    if (!this.#hired.includes(hired)) return;
    if (finding === READY) return;
    if (!(finding instanceof Float64Array)) return this.#dismiss(hired);
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
