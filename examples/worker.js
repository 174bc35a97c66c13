// Runs the estimator in a separate thread, which draws on canvases that the page has transferred.
// Import maps do not apply to workers, so this is the file's path; bundlers accept "bimodal-stereo".
import init, { Estimator, sample } from "../pkg/index.js";

const stop = new AbortController();

self.addEventListener("message", async ({ data }) => {
  if (data === "stop") return stop.abort();
  try {
    await find(data);
  } catch (error) {
    self.postMessage(stop.signal.aborted ? "stopped" : error.message);
  }
});

async function find({ canvases, scene }) {
  await init();
  const { image, depth, pose: truth } = sample(scene);
  const contexts = Object.entries(canvases).map(([layer, canvas]) => [layer, canvas.getContext("2d")]);
  const estimator = new Estimator(image, depth);
  const show = ({ status, stage, pose }) => {
    for (const [layer, context] of contexts) estimator.draw(context, layer);
    self.postMessage(`${status} (${stage}): beta ${pose.angles.beta.toFixed(2)} (true: ${truth.angles.beta.toFixed(0)})`);
  };
  try {
    // Slices of the search change no picture.
    const report = await estimator.run({ signal: stop.signal, onStep: (step) => step.stage !== "search" && show(step) });
    show(report);
  } finally {
    estimator.free();
  }
}
