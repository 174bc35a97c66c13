/** The page's side of the worker: only the newest request counts, and a worker that has ended is replaced. */

import { onGone } from "../engine/alive";
import type { Fault } from "../engine/protocol";
import { phrase } from "../words";
import type { Answer, Drawing, LessonId, Request, Values } from "./protocol";
import { startThread } from "./thread";

/**
 * Least time between two earlier drawings, milliseconds: so often that pictures do not turn pale during a drag, and so rarely that drawing
 * them leaves time to the slider.
 */
const FOLLOWS_EVERY = 250;

export interface Hooks {
  onDrawing(drawing: Drawing, done: boolean): void;
  /** A drawing of values before the present ones, as a drag leaves many behind. */
  onEarlier?(drawing: Drawing): void;
  onFault(fault: Fault): void;
}

export class Session {
  #worker: Worker | undefined;
  #next = 0;
  /** When an earlier drawing was last shown, milliseconds. */
  #followed = 0;
  /** Answers up to this request are no longer wanted. */
  #forgotten = 0;
  /** The lesson whose request is under way. */
  #busy: LessonId | undefined;
  readonly #hooks: Hooks;

  constructor(hooks: Hooks) {
    this.#hooks = hooks;
  }

  /** A thread that still computes another lesson is ended, because a step of its work can take seconds. */
  ask(lesson: LessonId, values: Values): void {
    if (this.#busy !== undefined && this.#busy !== lesson) this.end();
    this.#busy = lesson;
    this.#worker ??= this.#spawn();
    const request: Request = { id: ++this.#next, lesson, values };
    this.#worker.postMessage(request);
  }

  /** The answer to the request under way is no longer wanted. */
  forget(): void {
    this.#forgotten = ++this.#next;
  }

  /** Ends the request under way, which is obsolete. */
  end(): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#busy = undefined;
  }

  #spawn(): Worker {
    const worker = startThread();
    onGone(worker, () => {
      if (worker === this.#worker)
        this.#fail({
          code: "lost",
          message: phrase(
            "figure.stopped",
            "This figure stopped: the browser ended the computing thread, probably because memory ran short.",
          ),
          fatal: true,
        });
    });
    worker.onmessage = (event: MessageEvent<Answer>) => {
      const { data } = event;
      if (worker !== this.#worker || data.id <= this.#forgotten) return;
      if (data.id === this.#next) this.#receive(data);
      else if ("drawing" in data && performance.now() - this.#followed > FOLLOWS_EVERY) {
        this.#followed = performance.now();
        this.#hooks.onEarlier?.(data.drawing);
      }
    };
    worker.onerror = (event) => {
      event.preventDefault();
      if (worker === this.#worker)
        this.#fail({
          code: "panic",
          message: event.message || phrase("figure.none", "The worker could not be loaded."),
          fatal: true,
        });
    };
    return worker;
  }

  #receive(answer: Answer): void {
    if ("fault" in answer || answer.done) this.#busy = undefined;
    if ("fault" in answer) this.#fail(answer.fault);
    else this.#hooks.onDrawing(answer.drawing, answer.done);
  }

  #fail(fault: Fault): void {
    if (fault.fatal) this.end();
    this.#hooks.onFault(fault);
  }
}
