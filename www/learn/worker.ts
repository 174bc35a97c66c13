/** The thread that computes the figures of the lessons. A newer request ends the one under way. */

import "../engine/hold";
import init, { type WasmSource } from "../../pkg/index.js";
import { faultOf } from "../engine/fault";
import { colours } from "./compute/colours";
import { failure } from "./compute/failure";
import { grey } from "./compute/grey";
import { lambert } from "./compute/lambert";
import { loop } from "./compute/loop";
import { normal } from "./compute/normal";
import { orders } from "./compute/orders";
import { paint } from "./compute/paint";
import { pixel } from "./compute/pixel";
import { pose } from "./compute/pose";
import { prior } from "./compute/prior";
import { relief } from "./compute/relief";
import { sensor } from "./compute/sensor";
import { strips } from "./compute/strips";
import { surface } from "./compute/surface";
import type { Answer, Drawing, LessonId, Loading, Request, Values } from "./protocol";

type Compute = (values: Values) => Generator<Drawing>;
const lessons: Record<LessonId, Compute> = {
  normal,
  lambert,
  relief,
  strips,
  orders,
  pixel,
  grey,
  colours,
  surface,
  prior,
  pose,
  loop,
  sensor,
  paint,
  failure,
};

let isLoaded = false;
let loading: Promise<void> | undefined;
/** Loads the numerics once; each request waits for it and reports a failure. */
function load(wasm?: WasmSource): Promise<void> {
  loading ??= init(wasm).then(() => {
    isLoaded = true;
  });
  return loading;
}

let newest: Request | undefined;
let isBusy = false;

const post = (message: Answer): void => self.postMessage(message);
/** Lets messages arrive; a timer of zero would wait four milliseconds each time. */
const channel = new MessageChannel();
let wake: (() => void) | undefined;
channel.port1.onmessage = () => wake?.();
const breathe = (): Promise<void> =>
  new Promise((resolve) => {
    wake = resolve;
    channel.port2.postMessage(null);
  });

async function answer({ id, lesson, values }: Request): Promise<void> {
  try {
    await load();
    const drawings = lessons[lesson](values);
    let last: Drawing | undefined;
    for (const drawing of drawings) {
      if (last) post({ id, drawing: last, done: false });
      last = drawing;
      await breathe();
      if (newest?.id !== id) {
        // Ends the generator, which frees its estimators. The figure follows a drag with what is drawn.
        drawings.return(undefined);
        return post({ id, drawing, done: false });
      }
    }
    if (last) post({ id, drawing: last, done: true });
  } catch (error) {
    post({ id, fault: faultOf(error, isLoaded) });
  }
}

self.onmessage = async ({ data }: MessageEvent<Request | Loading>) => {
  // The requests report its failure.
  if ("wasm" in data) return void load(data.wasm).catch(() => {});
  newest = data;
  if (isBusy) return;
  isBusy = true;
  let done = -1;
  while (newest.id !== done) {
    done = newest.id;
    await answer(newest);
  }
  isBusy = false;
};
