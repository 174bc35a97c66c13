// Runs one cell through the public contract and measures the results. `api` is the package, `library` has the data.
import { sceneOf } from "./anywhere.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";
import { requestOf } from "./scenes.mjs";
import { measureCamera } from "./cameras.mjs";
import { measurePerturbed } from "./measure-perturbed.mjs";
import { measurePainted } from "./painted.mjs";
import { measureParts } from "./parts.mjs";
import { measureSoft } from "./soft.mjs";
import { measureHonesty } from "./honesty.mjs";
import { measureStress } from "./stress.mjs";
import { measureCapture, measurePinhole, measureStatue } from "./measure-perspective.mjs";
import { measureAlbedo, measurePair, measurePhotograph } from "./measure-reals.mjs";
import { measureKinect, measureMitten, measureScan } from "./measure-sensors.mjs";
import { measureIterations, measureRefinement, measureShading } from "./measure-shapes.mjs";

async function measurePose(cell, api, library) {
  const request = requestOf(cell.scene, library);
  const made = api.sample(request);
  const bound = cell.bound ? api.sampleBound(request, cell.options.light === "known") : null;
  const result = await withRun(api, made, optionsOf(cell.options, made), (report, _, milliseconds) =>
    judged(report, made.pose, milliseconds),
  );
  return { ...result, bound };
}

async function measureRandom(cell, api, library) {
  const scene = sceneOf(cell, library);
  const made = api.sample(requestOf(scene, library));
  const factor = cell.exposure ?? 1;
  const image = { ...made.image, data: made.image.data.map((value) => value * factor) };
  const options = optionsOf(cell.options, made);
  const pair = { image, depth: made.depth };
  const run = cell.alternations ? alternate(api, pair, options, cell.alternations) : withRun(api, pair, options, keep);
  const { report, milliseconds } = await run;
  const { surface, overlap, angles, scale } = scene;
  return { surface, overlap, trueAngles: angles, trueScale: scale, ...judged(report, made.pose, milliseconds) };
}

const keep = (report, _, milliseconds) => ({ report, milliseconds });

/** Alternates between the pose for the present light and the light for the present pose, beginning at the pose of the search. */
async function alternate(api, pair, options, rounds) {
  const start = performance.now();
  const opening = new api.Estimator(pair.image, pair.depth, options);
  let report = opening.report;
  let searching = true;
  while (searching && report.status === "running") {
    report = opening.stepStage();
    searching = report.stage === "search";
  }
  opening.free();
  for (let round = 0; round < rounds; round++) {
    const { pose } = report;
    const light = await withRun(
      api,
      pair,
      { ...options, start: pose, registration: "fixed", maxIterations: 1 },
      (_, estimator) => estimator.light(),
    );
    ({ report } = await withRun(api, pair, { ...options, start: pose, light }, keep));
  }
  return { report, milliseconds: performance.now() - start };
}

const KINDS = {
  pose: measurePose,
  random: measureRandom,
  iterations: measureIterations,
  shading: measureShading,
  refinement: measureRefinement,
  pair: measurePair,
  photograph: measurePhotograph,
  capture: measureCapture,
  pinhole: measurePinhole,
  parts: measureParts,
  statue: measureStatue,
  albedo: measureAlbedo,
  camera: measureCamera,
  painted: measurePainted,
  soft: measureSoft,
  stress: measureStress,
  honesty: measureHonesty,
  mitten: measureMitten,
  kinect: measureKinect,
  scan: measureScan,
};

/** The figures of a cell as plain JSON; any error is thrown. */
export const measure = (cell, api, library) =>
  cell.kind === "perturbed" ? measurePerturbed(cell, api, library, measure) : KINDS[cell.kind](cell, api, library);
