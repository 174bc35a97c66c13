// Runs of the built package on a scene of scenes.mjs, timed stage by stage: in the browser's worker, and in Node.

/** A scene from the bytes of its file. */
export function sceneOf(buffer) {
  const [width, height] = new Uint32Array(buffer, 0, 2);
  const [scale, ...rest] = new Float64Array(buffer, 8, 13);
  const views = new Float32Array(buffer, 8 + 8 * 13);
  const pixels = width * height;
  const [colours, depth] = [views.subarray(0, 3 * pixels), views.subarray(3 * pixels)];
  const mask = (inside) => Uint8Array.from({ length: pixels }, (_, index) => (inside(index) ? 255 : 0));
  return {
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
 * several workers, an iteration is one step, which waits for them; `shared` has the wall times. Other requests are options of the run.
 */
export async function runLoop(Estimator, scene, { start, most, workers = 1, ...options }) {
  const { image, depth, pose } = scene;
  const begun = performance.now();
  const estimator = new Estimator(image, depth, {
    ...{ start: start === "search" ? "search" : pose, workers },
    ...options,
  });
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
  return {
    ...{ status: report.status, iterations: report.iteration, degrees, milliseconds },
    ...{ preparation, longestSlice, stages, shared },
  };
}
