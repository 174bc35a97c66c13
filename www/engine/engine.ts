/** The page's side of the worker: calls that return promises, and a fresh worker when one has panicked or is too busy. */

import { GONE, onGone } from "./alive";
import type { Answer, Calls, Fault, Kind } from "./protocol";

/** An error of the library as the page receives it. */
export class EngineError extends Error {
  readonly code: string;
  readonly field: string | undefined;
  readonly fatal: boolean;

  constructor(fault: Fault) {
    super(fault.message);
    this.name = "EngineError";
    this.code = fault.code;
    this.field = fault.field;
    this.fatal = fault.fatal;
  }
}

/** How long, in milliseconds, a new request waits for the reply to an old one before the worker is replaced. */
const LONGEST_WAIT = 400;

/** The code of a worker that has ended silently. */
export const LOST = "lost";

interface Pending {
  resolve(reply: Calls[Kind]["reply"]): void;
  reject(error: EngineError): void;
}

export interface EngineHooks {
  /** Called with the number of bytes of the module that have arrived. */
  onLoad(bytes: number): void;
  /** The worker has ended and its input is lost. Pending calls are rejected with the same error. */
  onLost(error: EngineError): void;
}

export class Engine {
  #worker: Worker | undefined;
  /** Before its first answer a worker is still loading. Replacing it then would only load everything again. */
  #loaded = false;
  #pending = new Map<number, Pending>();
  /** Called when nothing is pending any more. */
  #resting: (() => void)[] = [];
  #next = 0;
  readonly #hooks: EngineHooks;

  constructor(hooks: EngineHooks) {
    this.#hooks = hooks;
  }

  /** Buffers are transferred, so the page can no longer use them. */
  call<K extends Kind>(
    kind: K,
    request: Calls[K]["request"],
    transfer: Transferable[] = [],
  ): Promise<Calls[K]["reply"]> {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#pending.set(id, { resolve, reject });
      this.#worker ??= this.#spawn();
      this.#worker.postMessage({ id, kind, ...request }, transfer);
    });
  }

  /** Resolves when nothing is under way any more. A request that takes too long is cancelled, and its promise rejected. */
  async interrupt(): Promise<void> {
    if (this.#pending.size === 0) return;
    const rest = new Promise<void>((resolve) => this.#resting.push(resolve));
    const late = setTimeout(() => {
      if (this.#loaded) this.#drop({ code: "interrupted", message: "cancelled by a newer request", fatal: false });
    }, LONGEST_WAIT);
    await rest;
    clearTimeout(late);
  }

  #spawn(): Worker {
    const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    onGone(worker, () => {
      if (worker === this.#worker) this.#drop({ code: LOST, message: `The run stopped: ${GONE}.`, fatal: true });
    });
    // Messages that a worker sent before its end may arrive afterwards.
    worker.onmessage = (event: MessageEvent<Answer>) => {
      if (worker === this.#worker) this.#receive(event.data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      if (worker === this.#worker) this.#drop(panic(event.message || "The worker could not be loaded."));
    };
    return worker;
  }

  #receive(answer: Answer): void {
    if (answer.id === null) {
      this.#hooks.onLoad(answer.loaded);
      return;
    }
    this.#loaded = true;
    const pending = this.#pending.get(answer.id);
    this.#pending.delete(answer.id);
    if (answer.ok) {
      pending?.resolve(answer.reply);
    } else {
      if (answer.fault.fatal) this.#drop(panic(answer.fault.message));
      pending?.reject(new EngineError(answer.fault));
    }
    this.#restIfIdle();
  }

  #restIfIdle(): void {
    if (this.#pending.size > 0) return;
    const resting = this.#resting;
    this.#resting = [];
    for (const resolve of resting) resolve();
  }

  /**
   * No reply of an instance that has panicked or is being replaced can be used, so all pending calls fail with the same error. The next
   * call makes a new worker. If it were made here, a worker that cannot be loaded would cause an endless loop.
   */
  #drop(fault: Fault): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#loaded = false;
    const error = new EngineError(fault);
    this.#hooks.onLost(error);
    const waiting = [...this.#pending.values()];
    this.#pending.clear();
    for (const { reject } of waiting) reject(error);
    this.#restIfIdle();
  }
}

const panic = (message: string): Fault => ({ code: "panic", message, fatal: true });
