/** Takes the lock by which the page knows that a worker lives (`alive.ts`). The page's workers import this file first. */

import type { Holding } from "./alive";

/** The name differs for each worker of all tabs. */
const name = `bimodal-stereo ${performance.timeOrigin} ${Math.random()}`;

// The page works without locks, too.
navigator.locks
  ?.request(name, () => {
    self.postMessage({ holds: name } satisfies Holding);
    return new Promise(() => {});
  })
  .catch(() => {});
