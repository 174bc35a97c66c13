// A refused number is a value of the error, with its index in a list, so that programs need not parse the message.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { checkCalibration, pixelLandscape, projectFrame } from "../../pkg/index.js";
import { cameraFromFieldOfView, readRigFile, readRigFolder } from "../../pkg/rig.js";
import { writePose } from "../../pkg/rig-write.js";
import { depthPng, matrixText, poseJson, writePng } from "../../pkg/write.js";
import { BimodalError, Estimator, init, pair, sample } from "./support.mjs";

const REQUEST = { surface: "bust", light: "colourful", size: 32 };
const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];
const POSE = { scale: 1, rotation: IDENTITY, translation: [0, 0, 0] };
const CAMERA = { fx: 30, fy: 30, cx: 16, cy: 16 };
/** A list with one entry replaced. */
const but = (list, index, value) => list.with(index, value);
const matrix = (index, value) => but([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], index, value);
const frame = (depth = {}) => {
  const view = { width: 2, height: 2, camera: CAMERA };
  return {
    image: { ...view, data: new Uint8Array(16) },
    depth: { ...view, data: new Float32Array(4).fill(1), ...depth },
  };
};

let views;
before(async () => {
  await init();
  views = pair();
});
const made = (image, depth, options) =>
  new Estimator({ ...views.image, ...image }, { ...views.depth, ...depth }, options);
const options = (given) => () => made({}, {}, given);
const start = (given) => options({ start: given });
const image = (given) => () => made(given);
const depth = (given) => () => made({}, given);
const scene = (given) => () => sample({ ...REQUEST, ...given });

/** Call, code of the error, field, number and, for a list, index. */
const CALLS = [
  [options({ maxIterations: 1.5 }), "range", "options.maxIterations", 1.5],
  [options({ maxIterations: 0 }), "range", "options.maxIterations", 0],
  [options({ seed: -1 }), "range", "options.seed", -1],
  [options({ workers: 17 }), "range", "options.workers", 17],
  [options({ scale: NaN }), "range", "options.scale", NaN],
  [options({ lambda: { prior: -1 } }), "range", "options.lambda.prior", -1],
  [options({ lambda: { light: 1e300 } }), "range", "options.lambda.light", 1e300],
  [options({ stopDegrees: 0 }), "range", "options.stopDegrees", 0],
  [options({ correspondenceDistance: -1 }), "range", "options.correspondenceDistance", -1],
  [options({ startTolerance: { degrees: -2 } }), "range", "options.startTolerance.degrees", -2],
  [options({ light: but(new Array(27).fill(0.1), 5, 1e300) }), "range", "options.light", 1e300, 5],
  [options({ light: but(new Array(27).fill(0.1), 4, NaN) }), "range", "options.light", NaN, 4],
  [options({ trim: 1 }), "type", "options.trim", 1],
  [options({ registration: 3 }), "type", "options.registration", 3],
  [start({ angles: { beta: 500 } }), "range", "options.start.angles.beta", 500],
  [start({ scale: -1 }), "range", "options.start.scale", -1],
  [start(matrix(3, Infinity)), "range", "options.start[3]", Infinity],
  [start(matrix(15, 2)), "range", "options.start", 2, 15],
  [start({ matrix: matrix(12, 0.5) }), "range", "options.start.matrix", 0.5, 12],

  [image({ width: 32.5 }), "range", "image.width", 32.5],
  [image({ width: -32 }), "range", "image.width", -32],
  [image({ width: 2 ** 32 + 32 }), "size", "image.width", 2 ** 32 + 32],
  [image({ camera: { ...CAMERA, fy: -1 } }), "range", "image.camera.fy", -1],
  [image({ camera: { ...CAMERA, cx: NaN } }), "range", "image.camera.cx", NaN],
  [image({ camera: but([30, 0, 16, 0, 30, 16, 0, 0, 1], 1, 9) }), "range", "image.camera", 9, 1],
  [image({ camera: but([30, 0, 16, 0, 30, 16, 0, 0, 1], 7, 3) }), "range", "image.camera", 3, 7],
  [depth({ camera: { ...CAMERA, fx: 0 } }), "range", "depth.camera.fx", 0],
  [depth({ unit: 0 }), "range", "depth.unit", 0],

  [scene({ size: 8 }), "size", "sample.size", 8],
  [scene({ holes: 1 }), "range", "sample.holes", 1],
  [scene({ noise: -0.1 }), "range", "sample.noise", -0.1],
  [scene({ angles: { beta: -400 } }), "range", "sample.angles.beta", -400],
  [() => pixelLandscape({ log: [0, 0, 0], light: new Array(27).fill(0), side: 513 }), "size", "landscape.side", 513],
  [() => pixelLandscape({ log: [0, 1e7, 0], light: new Array(27).fill(0) }), "range", "landscape.log[1]", 1e7],
  [() => made().stepFor(NaN), "type", "milliseconds", NaN],
  [() => made().reset({ workers: 2 }), "unsupported", "options.workers", 2],

  [() => checkCalibration([frame()], { a: { ...POSE, scale: 2 } }), "range", "candidates.a.scale", 2],
  [() => checkCalibration([frame()], {}, { workers: 0 }), "range", "options.workers", 0],
  [() => projectFrame(frame(), { ...POSE, scale: 1.5 }), "range", "pose.scale", 1.5],
  [() => cameraFromFieldOfView(640, 480, 180), "range", "degrees", 180],
  [() => cameraFromFieldOfView(640, 0.5, 90), "size", "height", 0.5],
  [() => readRigFile({ name: "a", bytes: new Uint8Array(1) }, { unit: -1 }), "option", "options.unit", -1],
  [() => readRigFolder([], { frames: 0 }), "option", "options.frames", 0],

  [() => writePose({ ...POSE, scale: 2 }, "matrix"), "range", "pose.scale", 2],
  [() => writePose({ ...POSE, translation: [0, NaN, 0] }, "matrix"), "range", "pose.translation", NaN, 1],
  [() => writePose(POSE, "kalibr", { colour: { ...CAMERA, fy: -3 } }), "range", "context.colour", -3],
  [
    () => writePose(POSE, "kalibr", { colour: CAMERA, sizes: { colour: [640, 0] } }),
    "size",
    "context.sizes.colour",
    0,
    1,
  ],
  [() => matrixText({ ...POSE, scale: 0 }), "range", "pose.scale", 0],
  [() => poseJson({ ...POSE, rotation: but(IDENTITY, 4, NaN) }, "m"), "range", "pose.rotation", NaN, 4],
  [() => depthPng({ width: 2, height: 1, data: Float32Array.of(1, -2) }, "px"), "range", "depth.data[1]", -2],
  [() => writePng({ width: 1, height: 1, channels: 5, data: new Uint8Array(5) }), "unsupported", "raster.channels", 5],
  [() => writePng({ width: 1, height: 1, data: new Uint8Array(1) }, { ["n".repeat(80)]: "" }), "range", "texts", 80],
];

describe("the number at fault", () => {
  for (const [call, code, field, value, index] of CALLS)
    test(`${code} ${field} ${value}`, async () => {
      await assert.rejects(
        async () => call(),
        (error) => {
          assert.ok(error instanceof BimodalError, String(error));
          assert.deepEqual([error.code, error.field, error.value], [code, field, value], error.message);
          assert.equal(error.index, index, error.message);
          assert.equal("index" in error, index !== undefined, "absent rather than undefined");
          return true;
        },
      );
    });

  test("is absent where none is refused", () => {
    for (const call of [options({ trim: "yes" }), options({ start: "serch" }), image({ data: undefined })])
      assert.throws(call, (error) => error instanceof BimodalError && !("value" in error));
  });
});
