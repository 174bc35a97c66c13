/** Work for the screen, done in animation frames and never more of it than fits: what does not fit waits for the next. */

/** Milliseconds of a frame that drawing may take; the rest belongs to the browser and the visitor. */
const BUDGET = 5;

type Job = () => void;

export class Painter {
  #jobs = new Map<object, Job>();
  #idle: (() => void)[] = [];
  #scheduled = false;

  /** Queues the painting of `owner`; a newer job replaces one that has not run. */
  request(owner: object, job: Job): void {
    this.#jobs.set(owner, job);
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
    for (const [owner, job] of this.#jobs) {
      this.#jobs.delete(owner);
      job();
      if (performance.now() > until) break;
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
