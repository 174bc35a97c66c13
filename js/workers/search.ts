/** Workers that do parts of the search over poses for an estimator. */
import type { PlainOptions } from "../options.js";
import { READY, type WorkerAnswer, type Views, type WorkerHandle } from "./messages.js";
import { startWorker } from "./start.js";

/** The tasks of a search: those that the estimator gives to workers, and the results that it receives. */
export interface Tasks {
  take(): Float64Array | undefined;
  accept(result: Float64Array): void;
}

/** Number of tasks in a worker's queue: enough for about ten milliseconds, in which the estimator's thread may be busy. */
const QUEUE = 3;

interface SearchWorker {
  handle: WorkerHandle;
  /** Tasks that were sent to the worker and are not answered yet. */
  queued: number;
}

/**
 * Workers affect only how long a search takes: if none can be started, or one fails, the estimator does the whole search. Messages pass
 * whenever the estimator's thread lets events through. The workers last as long as the search.
 */
export class SearchWorkers {
  #workers: SearchWorker[] = [];
  #isBegun = false;
  readonly #count: number;
  readonly #pair: Views;
  readonly #tasks: Tasks;
  readonly #unavailable: (reason: unknown) => void;

  constructor(count: number, pair: Views, tasks: Tasks, unavailable: (reason: unknown) => void) {
    this.#count = count;
    this.#pair = pair;
    this.#tasks = tasks;
    this.#unavailable = unavailable;
  }

  /** Starts the workers of a search. */
  begin(options: PlainOptions): void {
    this.end();
    this.#isBegun = true;
    for (let started = 0; started < this.#count; started++) this.#start(options);
  }

  #start(options: PlainOptions): void {
    const handle = startWorker(this.#pair, options, this.#unavailable);
    if (!handle) return;
    const worker: SearchWorker = { handle, queued: 0 };
    this.#workers.push(worker);
    handle.onAnswer((answer) => this.#receive(worker, answer));
    handle.onFailure(() => this.#drop(worker));
  }

  /** Hands out tasks until no task is left or every queue is full; a search around an initial pose starts here. */
  feed(options: PlainOptions): void {
    if (!this.#isBegun) this.begin(options);
    this.#give();
  }

  #give(): void {
    for (const worker of [...this.#workers]) {
      while (worker.queued < QUEUE) {
        const task = this.#tasks.take();
        if (!task) return;
        worker.queued++;
        try {
          worker.handle.post({ kind: "task", task }, []);
        } catch {
          this.#drop(worker);
          break;
        }
      }
    }
  }

  /** Ends the workers, because the search is over or the estimator was freed. */
  end(): void {
    this.#isBegun = false;
    for (const worker of [...this.#workers]) this.#drop(worker);
  }

  #receive(worker: SearchWorker, answer: WorkerAnswer): void {
    if (!this.#workers.includes(worker)) return;
    if (answer === READY) return;
    if (!(answer instanceof Float64Array)) return this.#drop(worker);
    worker.queued--;
    try {
      this.#tasks.accept(answer);
      this.#give();
    } catch {
      // The estimator has panicked; its next call throws the error.
      this.end();
    }
  }

  #drop(worker: SearchWorker): void {
    this.#workers = this.#workers.filter((other) => other !== worker);
    worker.handle.end();
  }
}
