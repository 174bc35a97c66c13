// The browser's half of the bench: the built package in a module worker, as on the page. Each request gets one answer.
import init, { Estimator } from "/pkg/index.js";
import { runLoop, sceneOf } from "./runs.js";

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
  scene = sceneOf(await (await fetch(path)).arrayBuffer());
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
  run: (request) => runLoop(Estimator, scene, request),
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
