/**
 * Detects a worker that has ended silently. No event is fired when the browser ends a worker for lack of memory, and a caller would wait
 * for its answer forever. A worker therefore holds a lock (Web Locks) as long as it lives, and the page waits for that lock. On pages
 * without locks, such as those that are not served over https, such an end is not noticed.
 */

/** The first message of a worker: the name of its lock. */
export interface Holding {
  holds: string;
}

const isHolding = (data: unknown): data is Holding => typeof data === "object" && data !== null && "holds" in data;

/** Must be called before the worker has another listener. It also learns when the page itself ends the worker. */
export function onGone(worker: Worker, tell: () => void): void {
  worker.addEventListener("message", (event) => {
    if (!isHolding(event.data)) return;
    event.stopImmediatePropagation();
    navigator.locks?.request(event.data.holds, tell).catch(() => {});
  });
}

/** The message about a worker that has ended silently. */
export const GONE = "the browser ended the computing thread, probably because memory ran short";
