// The threads that the package makes, in the test's sight: a test waits until they have answered instead of for some time, so
// that a machine that is slow or busy changes nothing. To import this module is enough.
import { EventEmitter, once } from "node:events";
import { syncBuiltinESMExports } from "node:module";
import { after } from "node:test";
import threads from "node:worker_threads";

/** Ends what hangs, milliseconds. */
const NEVER = 200_000;

/** Threads that were made, and those of them that ended; refinements that they were asked for, and brought. */
export const seen = { begun: 0, ended: 0, asked: 0, brought: 0 };

const living = new Set();
const news = new EventEmitter();
let tamper = (order) => order;

/** What becomes of each order before it is sent, until it is called without one; `undefined` is an order that gets lost. */
export function tamperWith(change = (order) => order) {
  tamper = change;
}

class Watched extends threads.Worker {
  /** Orders without an answer: each of them gets one. */
  due = 0;

  constructor(...args) {
    super(...args);
    seen.begun++;
    living.add(this);
    this.on("message", (answer) => {
      this.due--;
      if (answer instanceof Float32Array) seen.brought++;
      news.emit("news");
    });
    this.on("exit", () => {
      seen.ended++;
      living.delete(this);
      news.emit("news");
    });
  }

  postMessage(order, transfer) {
    if (order.kind === "refine") seen.asked++;
    news.emit("news");
    const sent = tamper(order);
    if (sent === undefined) return;
    super.postMessage(sent, transfer);
    this.due++;
  }

  terminate() {
    this.due = 0;
    return super.terminate();
  }
}

threads.Worker = Watched;
syncBuiltinESMExports();

// The package's threads keep no program from ending, and so no test that waits for one.
const awake = setInterval(() => {}, 1000);
after(() => clearInterval(awake));

/** Until this holds; asked whenever a thread is told something, answers or ends. */
export async function until(holds) {
  const signal = AbortSignal.timeout(NEVER);
  while (!holds()) await once(news, "news", { signal });
}

/** Until every thread has answered all that it was told. */
export const settled = () => until(() => [...living].every(({ due }) => due === 0));

/** Runs to the end, and lets all threads answer after each step; every report on the way. */
export async function runSettled(estimator, step = () => estimator.run({ maxIterations: 1 })) {
  const reports = [];
  do {
    await settled();
    reports.push(await step(estimator));
  } while (reports.at(-1).status === "running");
  return reports;
}
