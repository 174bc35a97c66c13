/** The page's side of the worker: requests as promises, one progress at a time, and a worker that can be replaced. */

import { GONE, onGone } from "../engine/alive";
import type { Fault } from "../engine/protocol";
import type { Answer, CallKind, Calls, Request } from "./protocol";

/** Milliseconds within which a cancelled check has to end by itself before its worker is terminated. */
const PATIENCE = 1500;

/** An error in the worker. */
export class RigError extends Error {
  readonly fault: Fault;
  constructor(fault: Fault) {
    super(fault.message);
    this.fault = fault;
  }
}

export const wasCancelled = (error: unknown): boolean => error instanceof RigError && error.fault.code === "aborted";

interface Waiting {
  kind: CallKind;
  ask: object;
  resolve(answer: never): void;
  reject(error: unknown): void;
  onProgress?: ((share: number, message: string) => void) | undefined;
}

/** A request that is repeated for a new worker. */
export type Read = { [K in CallKind]: { kind: K; ask: Calls[K]["ask"] } }[CallKind];

/** Requests after which the worker holds pixels. They are repeated for a new worker, except the one that ended the old worker. */
const READS: readonly CallKind[] = ["read", "folder", "example", "take"];

/** The unit of a file that was added with others is requested separately; it is remembered under the first of these files. */
function keyOf(kind: CallKind, ask: object): string {
  if ((kind === "unit" || kind === "take") && "file" in ask) return `${kind} ${ask.file}`;
  return "file" in ask ? `file ${ask.file}` : "first" in ask ? `files from ${ask.first}` : kind;
}

export class Session {
  #worker: Worker | undefined;
  #next = 1;
  #waiting = new Map<number, Waiting>();
  /** Called when a worker is replaced, because frames from a robot were only in the old one. */
  onReplaced = (): void => {};
  /** The first requests to a new worker: everything that the old one had read. */
  readonly known = new Map<string, Read>();

  call<K extends CallKind>(
    kind: K,
    ask: Calls[K]["ask"],
    onProgress?: (share: number, message: string) => void,
  ): Promise<Calls[K]["answer"]> {
    // A new worker repeats the remembered requests; this request would be one of them and run twice.
    const worker = this.#thread();
    this.#remember(kind, ask);
    const id = this.#next++;
    return new Promise<Calls[K]["answer"]>((resolve, reject) => {
      this.#waiting.set(id, { kind, ask, resolve, reject, onProgress });
      worker.postMessage({ ...ask, id, kind } as Request);
    });
  }

  /**
   * Ends the running check, whose frames may still be on their way. A worker that does not respond is replaced, and the new one reads its
   * files again.
   */
  cancel(): void {
    const checks = [...this.#waiting].filter(([, { kind }]) => kind === "check" || kind === "frames");
    if (checks.length === 0) return;
    for (const [id, { reject }] of checks) {
      this.#waiting.delete(id);
      reject(new RigError({ code: "aborted", message: "The check was cancelled.", fatal: false }));
    }
    const worker = this.#worker;
    worker?.postMessage({ kind: "cancel" } satisfies Request);
    // The worker answers a request once the check has ended.
    const id = this.#next++;
    const late = setTimeout(() => worker === this.#worker && this.#replace(), PATIENCE);
    const ended = () => clearTimeout(late);
    this.#waiting.set(id, { kind: "forget", ask: { file: -1 }, resolve: ended, reject: ended });
    worker?.postMessage({ id, kind: "forget", file: -1 } satisfies Request);
  }

  #remember(kind: CallKind, ask: object): void {
    const key = keyOf(kind, ask);
    if (kind === "forget") {
      if ("file" in ask) this.known.delete(`take ${ask.file}`);
      return void this.known.delete(key);
    }
    if (!READS.includes(kind) && kind !== "unit" && kind !== "frames") return;
    // A repeated request moves to the end, because it may refer to files that came later.
    this.known.delete(key);
    this.known.set(key, { kind, ask } as Read);
  }

  #thread(): Worker {
    if (this.#worker) return this.#worker;
    const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    onGone(worker, () => {
      if (worker === this.#worker) this.#restart(GONE);
    });
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      if (worker === this.#worker) this.#receive(data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      if (worker === this.#worker) this.#restart(event.message || "The check's worker could not be loaded.");
    };
    this.#worker = worker;
    for (const { kind, ask } of this.known.values()) worker.postMessage({ ...ask, id: 0, kind } as Request);
    return worker;
  }

  #receive(data: Answer): void {
    const waiting = this.#waiting.get(data.id);
    if (!waiting) return;
    if ("share" in data) return waiting.onProgress?.(data.share, data.message);
    this.#waiting.delete(data.id);
    if ("answer" in data) return waiting.resolve(data.answer as never);
    waiting.reject(new RigError(data.fault));
    // After a panic the numerics cannot be trusted.
    if (data.fault.fatal) this.#restart(data.fault.message);
  }

  /** Another worker takes over the requests of the old one. */
  #replace(): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    this.onReplaced();
    const worker = this.#thread();
    for (const [id, { kind, ask }] of this.#waiting) worker.postMessage({ ...ask, id, kind } as Request);
  }

  #restart(message: string): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    this.onReplaced();
    const left = [...this.#waiting.values()];
    this.#waiting.clear();
    // The file being read may have ended the worker, so no other worker reads it.
    for (const { kind, ask } of left) if (READS.includes(kind)) this.known.delete(keyOf(kind, ask));
    for (const { reject } of left) reject(new RigError({ code: "internal", message, fatal: true }));
  }
}
