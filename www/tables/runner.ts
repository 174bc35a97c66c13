/** Runs cells one after the other in a separate worker, and keeps the results for as long as the page is open. */

import { GONE, onGone } from "../engine/alive";
import type { CellAnswer, Task } from "./messages";
import type { Cell, Result } from "./protocol";

export type State =
  | { kind: "waiting" }
  | { kind: "running"; words: string; share: string }
  | { kind: "done"; result: Result }
  | { kind: "failed"; message: string };

export class Runner {
  #states = new Map<string, State>();
  #queue: Cell[] = [];
  #running: Cell | undefined;
  #worker: Worker | undefined;
  /** The earlier result of a cell that is run again, which a stop must not lose. */
  #before = new Map<string, State>();
  readonly #onChange: (id: string) => void;

  constructor(onChange: (id: string) => void) {
    this.#onChange = onChange;
  }

  /** The state of a cell; undefined if the cell has not been run. */
  stateOf(id: string): State | undefined {
    return this.#states.get(id);
  }

  get busy(): boolean {
    return this.#running !== undefined;
  }

  /** The cells that have ended successfully. */
  results(cells: readonly Cell[]): { cell: Cell; result: Result }[] {
    return cells.flatMap((cell) => {
      const state = this.#states.get(cell.id);
      return state?.kind === "done" ? [{ cell, result: state.result }] : [];
    });
  }

  /** Runs one cell before all others, whether or not it has a result. */
  runFirst(cell: Cell): void {
    if (this.#running?.id === cell.id) return;
    const rest = this.#queue.filter(({ id }) => id !== cell.id);
    this.#queue = [cell, ...rest];
    this.#await(cell);
    this.#next();
  }

  /** Queues cells that have no result yet, after those that already wait. */
  runAll(cells: readonly Cell[]): void {
    for (const cell of cells) {
      const kind = this.#states.get(cell.id)?.kind;
      if (kind === "done" || kind === "waiting" || kind === "running") continue;
      this.#queue.push(cell);
      this.#await(cell);
    }
    this.#next();
  }

  /** Ends the worker, which may be in the middle of a cell; finished results stay. */
  stop(): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    const left = [...(this.#running ? [this.#running] : []), ...this.#queue];
    this.#running = undefined;
    this.#queue = [];
    for (const { id } of left) this.#forget(id);
  }

  #await({ id }: Cell): void {
    const state = this.#states.get(id);
    if (state?.kind === "done") this.#before.set(id, state);
    this.#become(id, { kind: "waiting" });
  }

  #forget(id: string): void {
    const before = this.#before.get(id);
    this.#before.delete(id);
    if (before) this.#states.set(id, before);
    else this.#states.delete(id);
    this.#onChange(id);
  }

  #become(id: string, state: State): void {
    this.#states.set(id, state);
    this.#onChange(id);
  }

  #next(): void {
    if (this.#running) return;
    const cell = this.#queue.shift();
    this.#running = cell;
    if (!cell) return;
    const fresh = this.#worker === undefined;
    this.#worker ??= this.#spawn();
    this.#become(cell.id, { kind: "running", words: fresh ? "loading" : "starting", share: "" });
    const task: Task = { cell };
    this.#worker.postMessage(task);
  }

  #spawn(): Worker {
    const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    onGone(worker, () => {
      if (worker === this.#worker) this.#breakDown(GONE);
    });
    // Messages that a worker sent before its end may arrive afterwards.
    worker.onmessage = (event: MessageEvent<CellAnswer>) => {
      if (worker === this.#worker) this.#receive(event.data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      if (worker === this.#worker) this.#breakDown(event.message || "The worker could not be loaded.");
    };
    return worker;
  }

  #receive(answer: CellAnswer): void {
    const { id } = answer;
    if (this.#running?.id !== id) return;
    if ("progress" in answer) {
      this.#become(id, { kind: "running", words: answer.progress, share: answer.share });
    } else if ("fault" in answer && answer.fault.fatal) {
      this.#breakDown(answer.fault.message);
    } else {
      this.#end(
        id,
        "fault" in answer ? { kind: "failed", message: answer.fault.message } : { kind: "done", result: answer.result },
      );
    }
  }

  /** An instance that has panicked cannot measure any more; the next cell gets a new one. */
  #breakDown(message: string): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    const id = this.#running?.id;
    if (id !== undefined) this.#end(id, { kind: "failed", message });
  }

  #end(id: string, state: State): void {
    this.#before.delete(id);
    this.#running = undefined;
    this.#become(id, state);
    this.#next();
    // Reported once more after the run has ended.
    if (!this.#running) this.#onChange(id);
  }
}
