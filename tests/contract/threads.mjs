// Makes the package's threads observable: a test waits for their answers rather than for some time, so a slow or busy machine changes
// nothing. Importing this module suffices.
import { EventEmitter, once } from "node:events";
import { syncBuiltinESMExports } from "node:module";
import { after } from "node:test";
import threads from "node:worker_threads";

/** Limit that ends a test that hangs, milliseconds. */
const NEVER = 200_000;

/** Threads that were started and that ended; refinements that were requested and delivered. */
export const seen = { begun: 0, ended: 0, asked: 0, brought: 0 };

const living = new Set();
const news = new EventEmitter();
let tamper = (order) => order;

/** Changes each order before it is sent, until called without an argument; an order that becomes `undefined` is lost. */
export function tamperWith(change = (order) => order) {
  tamper = change;
}

class Watched extends threads.Worker {
  /** Number of unanswered orders; each order gets one answer. */
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

// The package's threads do not keep a program alive, so they would not keep a waiting test alive either.
const awake = setInterval(() => {}, 1000);
after(() => clearInterval(awake));

/** Resolves once the condition holds; it is evaluated whenever a thread gets an order, answers or ends. */
export async function until(holds) {
  const signal = AbortSignal.timeout(NEVER);
  while (!holds()) await once(news, "news", { signal });
}

/** Resolves once every thread has answered all its orders. */
export const settled = () => until(() => [...living].every(({ due }) => due === 0));

/** Runs to the end, waiting for all threads after each step; returns every report. */
export async function runSettled(estimator, step = () => estimator.run({ maxIterations: 1 })) {
  const reports = [];
  do {
    await settled();
    reports.push(await step(estimator));
  } while (reports.at(-1).status === "running");
  return reports;
}
