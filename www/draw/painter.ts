/** Runs as many drawing jobs in an animation frame as fit; the others wait for the next frame. */

/** Milliseconds of a frame that drawing may take; the rest belongs to the browser and the visitor. */
const BUDGET = 5;
/** Largest number of pixels of canvases per frame: the browser copies them after the scripts, which cannot measure that time. */
const PIXELS = 400_000;

interface Job {
  draw(): void;
  pixels: number;
}

export class Painter {
  #jobs = new Map<object, Job>();
  #idle: (() => void)[] = [];
  #scheduled = false;

  /** Queues the painting of `owner` on a canvas with this many pixels; a newer job replaces one that has not run. */
  request(owner: object, draw: () => void, pixels = 0): void {
    this.#jobs.set(owner, { draw, pixels });
    this.#schedule();
  }

  /** Resolves in the frame in which everything queued so far has been drawn. */
  drawn(): Promise<void> {
    this.#schedule();
    return new Promise((resolve) => this.#idle.push(resolve));
  }

  #schedule(): void {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#frame());
  }

  #frame(): void {
    this.#scheduled = false;
    const until = performance.now() + BUDGET;
    let drawn = 0;
    for (const [owner, { draw, pixels }] of this.#jobs) {
      this.#jobs.delete(owner);
      draw();
      drawn += pixels;
      if (performance.now() > until || drawn > PIXELS) break;
    }
    if (this.#jobs.size > 0) {
      this.#schedule();
      return;
    }
    const waiting = this.#idle;
    this.#idle = [];
    for (const resolve of waiting) resolve();
  }
}
