// The browser's half of the bench: the built package in a module worker, as on the page. Each request gets one answer.
import init, { Estimator } from "/pkg/index.js";

/** The module's memory, captured during instantiation, because the package does not expose it. */
let memory;
for (const name of ["instantiate", "instantiateStreaming"]) {
  const original = WebAssembly[name];
  WebAssembly[name] = async (...given) => {
    const result = await original.apply(WebAssembly, given);
    memory = (result.instance ?? result).exports.memory;
    return result;
  };
}

let scene;

/** Reads a file written by scenes.mjs. */
async function read(path) {
  const buffer = await (await fetch(path)).arrayBuffer();
  const [width, height] = new Uint32Array(buffer, 0, 2);
  const [scale, ...rest] = new Float64Array(buffer, 8, 13);
  const views = new Float32Array(buffer, 8 + 8 * 13);
  const pixels = width * height;
  const [colours, depth] = [views.subarray(0, 3 * pixels), views.subarray(3 * pixels)];
  const mask = (inside) => Uint8Array.from({ length: pixels }, (_, index) => (inside(index) ? 255 : 0));
  scene = {
    image: { width, height, data: colours, mask: mask((index) => !Number.isNaN(colours[3 * index])) },
    depth: { width, height, data: depth, mask: mask((index) => !Number.isNaN(depth[index])) },
    pose: { scale, rotation: rest.slice(0, 9), translation: rest.slice(9) },
  };
}

/** Angle between two rotations. */
function degreesBetween(a, b) {
  const distance = Math.hypot(...a.map((value, index) => value - b[index]));
  return (2 * Math.asin(Math.min(1, distance / Math.sqrt(8))) * 180) / Math.PI;
}

/** Yields to the event loop, so that messages of the workers that share a search can arrive. */
const breathe = () =>
  new Promise((resume) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = resume;
    port2.postMessage(null);
  });

/**
 * Runs a loop to its end or through `most` iterations, as `run` of benches/common does. Stages carry the package's own times. With
 * several workers, an iteration is one step, which waits for them; `shared` has the wall times.
 */
async function run({ start, shading, most, workers }) {
  const { image, depth, pose } = scene;
  const begun = performance.now();
  const estimator = new Estimator(image, depth, { start: start === "search" ? "search" : pose, shading, workers });
  let { report } = estimator;
  const preparation = performance.now() - begun;
  const [stages, shared] = [[], []];
  let longestSlice = 0;
  while (report.status === "running" && report.iteration < most) {
    const { iteration } = report;
    const before = performance.now();
    if (workers > 1 && !(start === "search" && report.iteration === 0)) {
      report = await estimator.run({ maxIterations: 1 });
      shared.push({ iteration, milliseconds: performance.now() - before });
      continue;
    }
    report = estimator.stepStage();
    // Wall time of the call, during which no other event is handled.
    if (report.stage === "search") longestSlice = Math.max(longestSlice, performance.now() - before);
    stages.push({ stage: report.stage, iteration, milliseconds: report.milliseconds[report.stage] });
    if (workers > 1 && report.stage === "search") await breathe();
  }
  const milliseconds = performance.now() - begun;
  estimator.free();
  const degrees = degreesBetween(report.pose.rotation, pose.rotation);
  return { status: report.status, iterations: report.iteration, degrees, milliseconds, preparation, longestSlice, stages, shared };
}

/** Time from loading the package to the first report. */
async function firstReport() {
  const begun = performance.now();
  await init();
  const estimator = new Estimator(scene.image, scene.depth);
  const { iteration } = estimator.report;
  const milliseconds = performance.now() - begun;
  estimator.free();
  return { milliseconds, iteration };
}

/** Copies and posts all arrays of a full-sized frame; returns the time of the copies and the time of posting. Also times painting four views. */
async function frame() {
  const estimator = new Estimator(scene.image, scene.depth, { start: scene.pose });
  const before = performance.now();
  const arrays = [
    ...[estimator.imageNormals(), estimator.imageDepth(), estimator.residual(), estimator.refinedDepth()],
    ...[estimator.depthNormals(), estimator.points("image"), estimator.points("depth")],
  ];
  const copying = performance.now() - before;
  const { width, height } = scene.image;
  const context = new OffscreenCanvas(width, height).getContext("2d");
  const began = performance.now();
  for (const layer of ["normals", "depth", "residual", "refined"]) estimator.draw(context, layer);
  const painting = performance.now() - began;
  estimator.free();
  return { arrays, copying, painting, posted: performance.timeOrigin + performance.now() };
}

const ANSWERS = {
  scene: ({ path }) => read(path),
  init: () => init(),
  run,
  firstReport,
  frame,
  memory: () => memory.buffer.byteLength,
  clock: () => self.crossOriginIsolated,
};

self.onmessage = async ({ data: { kind, ...request } }) => {
  try {
    const answer = await ANSWERS[kind](request);
    self.postMessage({ answer }, answer?.arrays?.map(({ buffer }) => buffer) ?? []);
  } catch (error) {
    self.postMessage({ failure: `${kind}: ${error.message}` });
  }
};
