/** Draws the clouds in a separate thread if the browser supports it, otherwise on the page. */

import { onGone } from "../engine/alive";
import { nextTask } from "../dom";
import type { Asked, Change, Told } from "./stage";

export interface Renderer {
  /** Resolves when the change is drawn. */
  draw(change: Change): Promise<void>;
  end(): void;
}

export interface CloudsHooks {
  /** WebGL was suspended, or has returned. */
  onLost(lost: boolean): void;
  /** The thread has ended, and nothing more will be drawn. */
  onGone(): void;
}

/** Rejects where the browser has no WebGL. */
export async function rendererFor(canvas: HTMLCanvasElement, hooks: CloudsHooks): Promise<Renderer> {
  if (!("transferControlToOffscreen" in canvas)) return here(canvas, hooks);
  // Creating a thread blocks the page, so it is a separate task.
  await nextTask();
  const thread = new Thread(hooks);
  // The thread and not the page tests for WebGL, because the test waits for the browser's graphics process.
  if (await thread.ask("can you draw?")) return elsewhere(thread, canvas);
  thread.end();
  return here(canvas, hooks);
}

async function elsewhere(thread: Thread, canvas: HTMLCanvasElement): Promise<Renderer> {
  const offscreen = canvas.transferControlToOffscreen();
  if (await thread.ask(offscreen, [offscreen])) return thread;
  thread.end();
  throw new Error("no WebGL in a thread");
}

/** The thread that draws. It answers every message. Once it has ended, nothing is drawn, and all waiting callers are released. */
class Thread implements Renderer {
  readonly #worker = new Worker(new URL("./stage-thread.ts", import.meta.url), { type: "module" });
  #isOver = false;
  #answer: ((isDone: boolean) => void) | undefined;

  constructor({ onLost, onGone: tell }: CloudsHooks) {
    const breakOff = (): void => {
      if (this.#isOver) return;
      this.end();
      tell();
    };
    onGone(this.#worker, breakOff);
    this.#worker.onmessage = ({ data }: MessageEvent<Told>) =>
      typeof data === "boolean" ? this.#answer?.(data) : onLost(data.lost);
    this.#worker.onerror = (event) => {
      event.preventDefault();
      breakOff();
    };
  }

  ask(message: Asked, transfer: Transferable[] = []): Promise<boolean> {
    if (this.#isOver) return Promise.resolve(false);
    return new Promise((resolve) => {
      this.#answer = resolve;
      this.#worker.postMessage(message, transfer);
    });
  }

  async draw(change: Change): Promise<void> {
    await this.ask(change);
  }

  end(): void {
    this.#isOver = true;
    this.#worker.terminate();
    this.#answer?.(false);
  }
}

async function here(canvas: HTMLCanvasElement, { onLost }: CloudsHooks): Promise<Renderer> {
  const { CloudStage } = await import("./stage");
  const stage = new CloudStage(canvas, onLost);
  return {
    async draw(change) {
      await new Promise(requestAnimationFrame);
      stage.show(change);
    },
    end() {},
  };
}
