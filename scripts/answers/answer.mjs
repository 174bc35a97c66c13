// Runs one scene with one package and collects all results.
import { createHash } from "node:crypto";
import { usesOf } from "./contract.mjs";
import { optionsOf, pairOf } from "./pairs.mjs";
import { checkOf } from "./rigs.mjs";

/** Limit of iterations unless a scene sets another; a scene that has not converged by then is compared in that state. */
const MOST_ITERATIONS = 25;
/** Steps before a reset. */
const BEFORE_RESET = 12;

const steps = {
  step: (estimator) => estimator.step(),
  stage: (estimator) => estimator.stepStage(),
  time: (estimator) => estimator.stepFor(Infinity),
};

async function drive(estimator, way, options) {
  if (way.reset) {
    await estimator.run({ maxIterations: BEFORE_RESET });
    estimator.reset(options);
  }
  if (way.stop) return estimator.run({ maxIterations: way.stop });
  if (!steps[way]) return estimator.run();
  let report = estimator.report;
  while (report.status === "running") report = steps[way](estimator);
  return report;
}

/** Size of a pixel at the depth of the surface's middle, in the view's units; 1 in an orthographic view. */
const pixelOf = ({ camera }, middle) => (camera ? middle / camera.fx : 1);
/** Lengths in pixels; returned unchanged, bit by bit, where the pixel is the unit. */
const inPixels = (lengths, pixel) => (pixel === 1 ? lengths : Float64Array.from(lengths, (length) => length / pixel));

/** A hash of the estimator's input. */
function fingerprint(views) {
  const hash = createHash("sha256");
  for (const view of views) {
    for (const array of [view.data, view.points, view.normals, view.mask].filter(Boolean)) {
      hash.update(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
    }
  }
  return hash.digest("hex").slice(0, 12);
}

function everything(estimator, { image, depth, middle }) {
  const { milliseconds, ...report } = estimator.report;
  const pixels = { image: pixelOf(image, middle), depth: pixelOf(depth, middle) };
  return {
    report,
    // Older packages do not report the registration.
    endedBy: report.status === "running" ? undefined : estimator.registeredBy,
    light: [...estimator.light()],
    pixel: pixels.image,
    correspondence: estimator.correspondence(),
    rasters: {
      imageDepth: inPixels(estimator.imageDepth(), pixels.image),
      refinedDepth: inPixels(estimator.refinedDepth(), pixels.depth),
      imageNormals: estimator.imageNormals(),
      depthNormals: estimator.depthNormals(),
      residual: estimator.residual(),
      imagePoints: inPixels(estimator.points("image"), pixels.image),
      depthPoints: inPixels(estimator.points("depth"), pixels.image),
    },
  };
}

/** Size of a colour pixel at the depth of the middle of a rig's scene, metres. */
const rigPixelOf = ({ middle }, { image }) => middle[2] / (image.camera?.fx ?? image.width);

/** The same package renders the rig, so that the rendering is compared as well. */
async function checkAnswerOf({ rig }, api) {
  const { frames, report } = await checkOf(rig, api);
  const input = fingerprint(frames.flatMap(({ image, depth }) => [image, depth]));
  return { input, uses: [], report, pixel: rigPixelOf(report, frames[0]) };
}

/** The same package renders the pair, so that the results of `sample` are compared as well. */
export async function answerOf(scene, api) {
  if (scene.rig) return checkAnswerOf(scene, api);
  const made = pairOf(scene, api);
  const options = { maxIterations: MOST_ITERATIONS, ...optionsOf(scene.options ?? {}, made) };
  const way = scene.drive ?? "run";
  const first = way.reset ? { ...options, ...optionsOf(way.reset, made) } : options;
  const estimator = new api.Estimator(made.image, made.depth, first);
  try {
    await drive(estimator, way, options);
    const answer = everything(estimator, made);
    return {
      input: fingerprint([made.image, made.depth]),
      uses: usesOf({ ...made, albedo: scene.albedo }, options, way, answer.endedBy),
      ...answer,
    };
  } finally {
    estimator.free();
  }
}
