/** The thread that measures cells, one after the other. The protocol determines what is measured and how. */

import "../engine/hold";
import init, { Estimator, sample, sampleBound } from "../../pkg/index.js";
import type { RunOptions, StepReport } from "../../pkg/index.js";
import { measure } from "../../protocols/measure.mjs";
import { faultOf } from "../engine/fault";
import { searched } from "../engine/searched";
import type { CellAnswer, Task } from "./messages";
import { library, type Result } from "./protocol";

/** Milliseconds between two reports of a cell's progress. */
const TELL_EVERY = 100;

let isLoaded = false;
const ready = init().then(() => (isLoaded = true));
// Each request waits for it and reports a failure; before the first request its rejection must not count as unhandled.
ready.catch(() => {});

let current = "";
let told = 0;

function tell(report: StepReport): void {
  const { stage, iteration } = report;
  const now = performance.now();
  if (now - told < TELL_EVERY) return;
  told = now;
  const share = stage === "search" ? searched(report) : "";
  post({ id: current, progress: share ? `search ${share}` : `iteration ${iteration}`, share });
}

/** The run of the protocol, with reports while it lasts. */
class Watched extends Estimator {
  override run(options: RunOptions = {}): Promise<StepReport> {
    return super.run({ ...options, onStep: tell });
  }
}

const api = { Estimator: Watched, sample, sampleBound };

function post(answer: CellAnswer): void {
  self.postMessage(answer);
}

async function handle({ cell }: Task): Promise<void> {
  const { id } = cell;
  try {
    await ready;
    current = id;
    post({ id, result: (await measure(cell, api, library)) as Result });
  } catch (error) {
    post({ id, fault: faultOf(error, isLoaded) });
  }
}

/** Messages arrive while a run is under way, so each task waits for the previous one. */
let last: Promise<void> = Promise.resolve();
self.onmessage = (event: MessageEvent<Task>) => {
  last = last.then(() => handle(event.data));
};
