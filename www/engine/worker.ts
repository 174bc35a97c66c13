/** The thread that owns the estimator. It answers one request at a time and sends copies, never views on its memory. */

import "./hold";
import init, {
  BimodalError,
  Estimator,
  sample,
  sampleLights,
  sampleSurfaces,
  turnLight,
  wasmUrl,
} from "../../pkg/index.js";
import type { Options, Pose, Sample, SampleRequest, StepReport } from "../../pkg/index.js";
import type {
  Answer,
  Calls,
  Frame,
  Kind,
  KnownLight,
  Look,
  Request,
  Input as Source,
  LabOptions,
  Preview,
  SampleSource,
  Drawings,
} from "./protocol";
import { faultOf } from "./fault";
import { Numbers } from "./numbers";
import { probe } from "./probe";
import { ViewPainter, type Run } from "./drawings";
import { lit, ratio } from "./sphere";

interface Input extends Pick<Run, "image" | "depth"> {
  light?: Float64Array;
  truth: Pose | null;
  /** The ground truth of a sample. */
  shapes?: Sample["truth"];
}

interface OpenInput extends Input, Run {
  /** The scores of the poses that the search tried. The library forgets them once it has chosen a pose. */
  scores: Float32Array;
  /** The initial pose, and the position to which it maps the first point of the depth map. */
  start: { pose: Pose; first: readonly number[] };
}

let experiment: OpenInput | undefined;
let isLoaded = false;
const ready = load();
// Each request waits for the module and reports its failure. Before the first request, a rejection must not count as unhandled.
ready.catch(() => {});

async function load(): Promise<void> {
  const response = await fetch(wasmUrl());
  if (!response.ok || !response.body) throw new Error(`status ${response.status}`);
  let loaded = 0;
  const counted = response.body.pipeThrough(
    new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        loaded += chunk.length;
        post({ id: null, loaded }, []);
        controller.enqueue(chunk);
      },
    }),
  );
  await init(new Response(counted, { headers: { "content-type": "application/wasm" } }));
  isLoaded = true;
}

/** More threads do not make a search much shorter, and each takes memory. */
const MOST_WORKERS = 4;

function resolve({ light, start, ...rest }: LabOptions, input: Input): Options {
  if (start === "truth" && !input.truth) {
    throw new BimodalError("option", "options.start: the true pose is known only for a sample", "options.start");
  }
  return {
    ...rest,
    workers: Math.min(navigator.hardwareConcurrency || 1, MOST_WORKERS),
    light: light === "known" ? (input.light ?? "estimate") : light,
    start: start === "truth" ? (input.truth ?? "search") : start,
  };
}

const firstOf = (points: Float32Array): number[] => [...points.subarray(0, 3)];

const startOf = (estimator: Estimator, numbers: Numbers): OpenInput["start"] => ({
  pose: estimator.report.pose,
  first: firstOf(numbers.points("depth")),
});

function drawings(run: OpenInput, look: Look, anew = false): Drawings {
  const { estimator, numbers, painter, start } = run;
  const { pose } = estimator.report;
  const isAtStart = firstOf(numbers.points("depth")).every((value, i) => value === start.first[i]);
  return painter.show(run, look, { points: isAtStart ? start.pose : pose, seen: pose }, anew);
}

function frame(run: OpenInput, look: Look, reports: StepReport[], anew = false): Frame {
  const found = run.estimator.light();
  return {
    ...drawings(run, look, anew),
    reports,
    scores: run.scores.slice(),
    light: { found: lit(found), difference: run.light ? ratio(found, run.light) : null },
  };
}

const known = (light: Float64Array): KnownLight => ({ ball: lit(light), coefficients: light.slice() });

/** The new input replaces the old one only after it has been accepted, so that a refusal loses nothing. */
async function open({ source, options, look }: Calls["open"]["request"]): Promise<Calls["open"]["reply"]> {
  const { estimator, ...opened } = source.kind === "saved" ? await fromSaved(source.file) : prepared(source, options);
  experiment?.estimator.free();
  const numbers = new Numbers(estimator);
  experiment = {
    ...opened,
    estimator,
    numbers,
    scores: new Float32Array(),
    start: startOf(estimator, numbers),
    painter: new ViewPainter(opened, opened.shapes),
  };
  return {
    units: { image: opened.image.camera ? "m" : "px", depth: opened.depth.camera ? "m" : "px" },
    notes: opened.notes,
    truth: opened.truth,
    trueLight: opened.light ? known(opened.light) : null,
    measured: opened.shapes !== undefined,
    options: source.kind === "saved" ? estimator.given.options : null,
    frame: frame(experiment, look, [estimator.report], true),
  };
}

type Prepared = Input & Pick<Calls["open"]["reply"], "notes">;

function prepared(
  source: Exclude<Source, { kind: "saved" }>,
  options: LabOptions,
): Prepared & { estimator: Estimator } {
  const input = source.kind === "sample" ? fromSample(source) : { ...source.pair, truth: source.pair.truth ?? null };
  return { ...input, estimator: new Estimator(input.image, input.depth, resolve(options, input)) };
}

/** The run is repeated up to the step that it had reached. */
async function fromSaved(file: File): Promise<Prepared & { estimator: Estimator }> {
  const estimator = Estimator.restore(new Uint8Array(await file.arrayBuffer()));
  const { image, depth } = estimator.given;
  return { image, depth, estimator, truth: null, notes: {} };
}

/** The light requested from the library: its own, or the rotated one. */
function requestOf({ request, turn }: SampleSource): SampleRequest {
  return turn.alpha === 0 && turn.beta === 0 ? request : { ...request, light: turnLight(request.light, turn) };
}

function fromSample(source: SampleSource): Prepared {
  const { image, depth, light, pose, truth } = sample(requestOf(source));
  return { image, depth, light, truth: pose, shapes: truth, notes: {} };
}

function take(): Calls["take"]["reply"] {
  const { estimator, image, depth } = opened();
  return {
    pose: estimator.report.pose,
    unit: image.camera ? "m" : "px",
    depthUnit: depth.camera ? "m" : "px",
    light: estimator.light(),
    imagePoints: estimator.points("image"),
    depthPoints: estimator.points("depth"),
    image: { width: image.width, height: image.height, normals: estimator.imageNormals() },
    depth: {
      width: depth.width,
      height: depth.height,
      refined: estimator.refinedDepth(),
      normals: estimator.depthNormals(),
    },
  };
}

function preview({ source }: Calls["preview"]["request"]): Preview {
  const { image, depth, light } = sample(requestOf(source));
  return { picture: new ViewPainter({ image, depth }).given(), trueLight: known(light) };
}

function reset({ options, look }: Calls["reset"]["request"]): Frame {
  const current = opened();
  current.estimator.reset(resolve(options, current));
  current.numbers.forget();
  current.scores = new Float32Array();
  current.start = startOf(current.estimator, current.numbers);
  return frame(current, look, [current.estimator.report]);
}

/** Shortest and longest time spent on one frame of the search, milliseconds. A pause must take effect at once. */
const SEARCHING = [30, 250] as const;
let answered = Infinity;

async function advance({ by, milliseconds, look }: Calls["advance"]["request"]): Promise<Frame> {
  const current = opened();
  const { estimator } = current;
  const began = performance.now();
  const reports: StepReport[] = [];
  // The end of the search ends a frame, so that a stage ends there and its pose is seen.
  const isSearch = () => {
    const last = reports.at(-1);
    return last?.stage === "search" && last.reason?.code !== "search-done";
  };
  // A slice of the search shows too little progress, so several slices make a frame with the report of the last one. If drawing is slow,
  // the search gets as much time as the page.
  const searching = Math.min(Math.max(began - answered, SEARCHING[0]), SEARCHING[1]);
  try {
    do {
      if (isSearch()) reports.pop();
      // Unlike `step`, this call lets messages of the other threads arrive.
      reports.push(by === "stage" ? estimator.stepStage() : await estimator.run({ maxIterations: 1 }));
      const scores = estimator.searchScores();
      if (scores.length > 0) current.scores = scores;
    } while (
      performance.now() - began < (isSearch() ? searching : milliseconds) &&
      estimator.report.status === "running"
    );
  } finally {
    current.numbers.forget();
  }
  answered = performance.now();
  return frame(current, look, reports);
}

function opened(): OpenInput {
  if (!experiment) throw new Error("No input is open.");
  return experiment;
}

function catalogue(): Calls["catalogue"]["reply"] {
  return { surfaces: sampleSurfaces(), lights: sampleLights() };
}

function answer(request: Request): Promise<Calls[Kind]["reply"]> | Calls[Kind]["reply"] {
  switch (request.kind) {
    case "catalogue":
      return catalogue();
    case "open":
      return open(request);
    case "take":
      return take();
    case "save":
      return opened().estimator.save();
    case "preview":
      return preview(request);
    case "reset":
      return reset(request);
    case "look":
      return drawings(opened(), request.look, true);
    case "probe":
      return probe(opened(), request.side, request.pixel);
    case "advance":
      return advance(request);
  }
}

/** Every array and picture of a reply is a separate copy, so all of them may be transferred. */
function belongings(value: unknown, found = new Set<Transferable>()): Set<Transferable> {
  if (value instanceof ImageBitmap) found.add(value);
  else if (ArrayBuffer.isView(value)) {
    if (value.buffer instanceof ArrayBuffer) found.add(value.buffer);
  } else if (typeof value === "object" && value !== null) {
    for (const inner of Object.values(value)) belongings(inner, found);
  }
  return found;
}

function post(message: Answer, transfer: Transferable[]): void {
  self.postMessage(message, { transfer });
}

async function handle(request: Request): Promise<void> {
  const { id } = request;
  try {
    await ready;
    const reply = await answer(request);
    post({ id, ok: true, reply }, [...belongings(reply)]);
  } catch (error) {
    post({ id, ok: false, fault: faultOf(error, isLoaded) }, []);
  }
}

/** Decoding is asynchronous, so requests are queued. No request may see an input that another has half opened. */
let last: Promise<void> = Promise.resolve();
self.onmessage = (event: MessageEvent<Request>) => {
  last = last.then(() => handle(event.data));
};
