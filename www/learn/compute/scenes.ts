/** Scenes of the lessons, rendered by the library and kept while they are shown. */

import { Estimator, sample, type Options, type Sample, type SampleRequest } from "../../../pkg/index.js";
import type { Values } from "../protocol";
import { statusIn, type Status } from "./status";

/** Number of scenes that are kept, so that a scene is not rendered again while a control that does not affect it is dragged. */
const MOST_KEPT = 8;
const kept = new Map<string, Sample>();

export function scene(request: SampleRequest, key = ""): Sample {
  const name =
    key +
    JSON.stringify({
      ...request,
      surface: typeof request.surface === "string" ? request.surface : "own",
      light: Array.from(request.light as never),
    });
  const known = kept.get(name);
  if (known) return known;
  const made = sample(request);
  kept.set(name, made);
  const oldest = kept.keys().next().value;
  if (kept.size > MOST_KEPT && oldest !== undefined) kept.delete(oldest);
  return made;
}

export const numberOf = (values: Values, name: string): number => Number(values[name] ?? 0);
export const isOn = (values: Values, name: string): boolean => numberOf(values, name) === 1;

const lights = new Map<string, Float64Array>();
/** The 27 coefficients of a built-in light. */
export function lightNamed(name: string): Float64Array {
  const known = lights.get(name) ?? sample({ surface: "bust", light: name, size: 16 }).light;
  lights.set(name, known);
  return known;
}

/** Coefficients of one channel. */
const ORDERS = 9;

/** The light with its three colours moved toward their mean: 0 is grey, 1 the light itself. */
export function saturated(light: Float64Array, share: number): Float64Array {
  return light.map((value, index) => {
    const k = index % ORDERS;
    const mean = ((light[k] ?? 0) + (light[k + ORDERS] ?? 0) + (light[k + 2 * ORDERS] ?? 0)) / 3;
    return mean + share * (value - mean);
  });
}

/** The part of a light that is of one order in the normal: 0, 1 or 2. */
export function ofOrder(light: Float64Array, order: 0 | 1 | 2): Float64Array {
  const [first, end] = (
    [
      [0, 1],
      [1, 4],
      [4, ORDERS],
    ] as const
  )[order];
  return light.map((value, index) => (index % ORDERS >= first && index % ORDERS < end ? value : 0));
}

/** The normal at the pointer; beyond the ball's edge, the nearest normal on the edge. */
export function normalAt(x: number, y: number): [number, number, number] {
  const length = Math.hypot(x, y);
  const shrink = length > 0.98 ? 0.98 / length : 1;
  const [a, b] = [x * shrink, y * shrink];
  return [a, b, -Math.sqrt(1 - a * a - b * b)];
}

/** The pixel of a mask that is nearest to a place given as shares of the sides. */
export function pixelAt(mask: Uint8Array | undefined, width: number, height: number, x: number, y: number): number {
  let [best, least] = [0, Infinity];
  for (let index = 0; index < width * height; index++) {
    if (mask && !mask[index]) continue;
    const distance = Math.hypot((index % width) + 0.5 - x * width, Math.floor(index / width) + 0.5 - y * height);
    if (distance < least) [best, least] = [index, distance];
  }
  return best;
}

export const vectorAt = (field: ArrayLike<number>, index: number): [number, number, number] => [
  field[3 * index] ?? NaN,
  field[3 * index + 1] ?? NaN,
  field[3 * index + 2] ?? NaN,
];

/** The logarithm of a pixel's colour. */
export const logAt = ({ image }: Sample, index: number): [number, number, number] =>
  vectorAt(image.data, index).map((value) => Math.log(value)) as [number, number, number];

/** Runs a loop to its end or for a number of steps, and frees it in any case. */
export function* running(
  made: Pick<Sample, "image" | "depth">,
  options: Options,
  steps = Infinity,
): Generator<Estimator> {
  const estimator = new Estimator(made.image, made.depth, options);
  try {
    for (let step = 0; step < steps && estimator.report.status === "running"; step++) {
      estimator.step();
      yield estimator;
    }
  } finally {
    estimator.free();
  }
}

/** A result of an estimator after a number of stages of its first iteration. */
export function afterStages<T>(
  made: Pick<Sample, "image" | "depth">,
  options: Options,
  stages: number,
  ask: (estimator: Estimator) => T,
): T {
  const estimator = new Estimator(made.image, made.depth, options);
  try {
    for (let stage = 0; stage < stages; stage++) estimator.stepStage();
    return ask(estimator);
  } finally {
    estimator.free();
  }
}

/** A result of an estimator after a number of steps. */
export function after<T>(
  made: Pick<Sample, "image" | "depth">,
  options: Options,
  steps: number,
  ask: (estimator: Estimator) => T,
): T {
  const estimator = new Estimator(made.image, made.depth, options);
  try {
    for (let step = 0; step < steps && estimator.report.status === "running"; step++) estimator.step();
    return ask(estimator);
  } finally {
    estimator.free();
  }
}

/** Milliseconds between two pictures of a run: drawing must not slow the search down by much. */
const PICTURE_EVERY = 150;
/** Slices and iterations after which a run is stopped; the longest searches of such scenes take five thousand. */
const MOST_STEPS = 12_000;

/** Runs an estimator from search to verdict. Yields a state to draw at intervals, and at the end one with the status. */
export function* watched(
  made: Pick<Sample, "image" | "depth">,
  options: Options,
): Generator<{ estimator: Estimator; status: Status; done: boolean }> {
  const estimator = new Estimator(made.image, made.depth, options);
  try {
    let shown = -Infinity;
    for (let step = 0; step < MOST_STEPS && estimator.report.status === "running"; step++) {
      const report = estimator.step();
      if (performance.now() - shown < PICTURE_EVERY) continue;
      yield { estimator, status: statusIn(report), done: false };
      shown = performance.now();
    }
    yield { estimator, status: statusIn(estimator.report), done: true };
  } finally {
    estimator.free();
  }
}
