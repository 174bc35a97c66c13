// Poses as 4x4 matrices and cameras as 3x3 matrices, in every form, wherever a pose or a camera is accepted.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { checkCalibration, projectFrame, sampleRig } from "../../pkg/index.js";
import { readRigFile } from "../../pkg/rig.js";
import { writePose } from "../../pkg/rig-write.js";
import { matrixText, poseJson } from "../../pkg/write.js";
import { Estimator, init, outcome, pair, refused } from "./support.mjs";
import { LONG } from "./long.mjs";

const TURN = (25 * Math.PI) / 180;
const [C, S] = [Math.cos(TURN), Math.sin(TURN)];
const ROTATION = [C, 0, S, 0, 1, 0, -S, 0, C];
const [SCALE, SHIFT] = [1.25, [3, -2, 7]];
const POSE = { scale: SCALE, rotation: ROTATION, translation: SHIFT, angles: { alpha: 0, beta: 25, gamma: 0 } };
const rowsOf = (scale, r, t) => [
  ...[0, 1, 2].map((i) => [...r.slice(3 * i, 3 * i + 3).map((value) => scale * value), t[i]]),
  [0, 0, 0, 1],
];
const ROWS = rowsOf(SCALE, ROTATION, SHIFT);
const FORMS = {
  rows: ROWS,
  "a flat list": ROWS.flat(),
  "a typed array": Float64Array.from(ROWS.flat()),
  "rows of typed arrays": ROWS.map((row) => Float64Array.from(row)),
  "an object": { matrix: ROWS },
};
/** Entries agree to rounding. */
function near(found, expected) {
  assert.equal(found.length, expected.length);
  found.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 1e-12, `${found} against ${expected}`));
}

before(() => init());

describe("a pose", () => {
  test("has the same angles in a report as read from a file, also where beta is 90 degrees", async () => {
    // Rx(30) Ry(90) Rz(10), where only the sum of 30 and 10 is determined.
    const [c, s] = [Math.cos((40 * Math.PI) / 180), Math.sin((40 * Math.PI) / 180)];
    const rotation = [0, 0, 1, s, c, 0, -c, s, 0];
    const { image, depth } = pair({ size: 32 });
    const start = { scale: 1, rotation, translation: [0, 0, 0], angles: { alpha: 0, beta: 0, gamma: 0 } };
    const estimator = new Estimator(image, depth, { start, registration: "fixed" });
    const lines = rowsOf(1, rotation, [0, 0, 0]).map((row) => row.join(" "));
    const { poses } = await readRigFile({ name: "pose.txt", bytes: new TextEncoder().encode(lines.join("\n")) });
    const order = ({ alpha, beta, gamma }) => [alpha, beta, gamma];
    for (const { angles } of [estimator.report.pose, poses[0].pose])
      order(angles).forEach((value, k) => assert.ok(Math.abs(value - [0, 90, 40][k]) < 1e-9, JSON.stringify(angles)));
    estimator.free();
  });

  for (const [form, start] of Object.entries(FORMS)) {
    test(`starts a run as ${form}`, () => {
      const { image, depth } = pair({ size: 32 });
      const [given, plain] = [start, POSE].map(
        (start) => new Estimator(image, depth, { start, registration: "fixed" }),
      );
      const [a, b] = [given.report.pose, plain.report.pose];
      near([a.scale, ...a.rotation, ...a.translation], [b.scale, ...b.rotation, ...b.translation]);
      const { start: kept } = given.given.options;
      assert.deepEqual(Object.keys(kept), ["scale", "rotation", "translation"]);
    });

    test(`is written as ${form}`, () => {
      near(matrixText(start).trim().split(/\s+/).map(Number), ROWS.flat());
      const { scale, angles, matrix } = JSON.parse(poseJson(start, "px"));
      near([scale, angles.beta, ...matrix.flat()], [SCALE, 25, ...ROWS.flat()]);
    });
  }

  test("of a report has its matrix, and may be given again", async () => {
    const { image, depth } = pair({ size: 32, angles: { beta: 10 } });
    const estimator = new Estimator(image, depth, { start: "identity" });
    const { pose } = await estimator.run({ maxIterations: 2 });
    near(pose.matrix.flat(), rowsOf(pose.scale, pose.rotation, pose.translation).flat());
    const again = new Estimator(image, depth, { start: pose });
    near(again.report.pose.rotation, pose.rotation);
    const turned = new Estimator(image, depth, { start: { ...pose, rotation: ROTATION } });
    near(turned.report.pose.rotation, ROTATION);
    class Inherited {
      get rotation() {
        return ROTATION;
      }
      get matrix() {
        return "not looked at";
      }
    }
    near(new Estimator(image, depth, { start: new Inherited() }).report.pose.rotation, ROTATION);
  });

  test("of a rig: the numbers of a file of single precision stay what they are", () => {
    const single = [ROWS[0], ROWS[1], ROWS[2]].map((row) => row.map((value) => Math.fround(value / SCALE)));
    const { text } = writePose([...single, [0, 0, 0, 1]], "matrix");
    assert.deepEqual(text.trim().split(/\s+/).map(Number).slice(0, 12), single.flat());
  });

  test("that is none is refused by its field", () => {
    const { image, depth } = pair({ size: 32 });
    const start = (start) => () => new Estimator(image, depth, { start });
    const changed = (row, column, value) =>
      ROWS.map((each, i) => each.map((old, j) => (i === row && j === column ? value : old)));
    refused(start(ROWS.slice(1)), "size", "options.start");
    refused(start([1, 2, 3]), "size", "options.start");
    refused(start(changed(3, 0, 1)), "range", "options.start");
    refused(start(changed(0, 3, NaN)), "range", "options.start[0][3]");
    refused(start(changed(1, 1, "1")), "type", "options.start[1][1]");
    refused(start({ matrix: changed(1, 1, -SCALE) }), "range", "options.start.matrix");
    refused(start({ matrix: 5 }), "type", "options.start.matrix");
    // The check of matrices accepts a shear, which the check of rotations refuses.
    refused(start(changed(0, 1, 0.5)), "range", "options.start.rotation");
    refused(start({ matrix: ROWS, rotaton: ROTATION }), "option", "options.start.rotaton");
    refused(() => matrixText(ROWS.flat().slice(1)), "size", "pose");
    refused(() => writePose(ROWS, "matrix"), "range", "pose.scale");
  });
});

const K = [
  [60, 0, 15.5],
  [0, 61, 16.5],
  [0, 0, 1],
];
const CAMERA = { fx: 60, fy: 61, cx: 15.5, cy: 16.5 };

describe("a camera", () => {
  const cameras = { rows: K, "a flat list": K.flat(), "a typed array": Float32Array.from(K.flat()), "{ K }": { K } };
  for (const [form, camera] of Object.entries(cameras)) {
    test(`is taken as ${form}`, async () => {
      const { image, depth } = pair({ size: 32 });
      const run = async (camera) => {
        const z = depth.data.map((value) => (value > 0 ? 0.5 + value / 2000 : NaN));
        const estimator = new Estimator({ ...image, camera }, { ...depth, data: z, camera }, { start: "identity" });
        await estimator.run({ maxIterations: 2 });
        return estimator;
      };
      const [given, plain] = [await run(camera), await run(CAMERA)];
      assert.deepEqual(outcome(given), outcome(plain));
      assert.deepEqual(given.given.image.camera, CAMERA);
      assert.deepEqual(outcome(Estimator.restore(given.save())), outcome(plain));
    });
  }

  test("keeps its distortion", () => {
    const { image, depth } = pair({ size: 32 });
    const distortion = [0.1, 0, 0, 0, 0];
    const { given } = new Estimator({ ...image, camera: { K, distortion } }, depth, { start: "identity" });
    assert.deepEqual(given.image.camera, { ...CAMERA, distortion });
  });

  test("may have any lens, as a rig's has", async () => {
    const { image, depth } = pair({ size: 32 });
    const z = depth.data.map((value) => (value > 0 ? 0.5 + value / 2000 : NaN));
    const lenses = [
      {},
      { model: "brown", distortion: [0.1, 0, 0, 0] },
      { distortion: [0.1, 0, 0, 0, 0, 0.2, 0, 0] },
      { model: "fisheye" },
      { model: "fisheye", distortion: Float64Array.of(0.1, 0, 0, 0) },
    ];
    const found = [];
    for (const lens of lenses) {
      const camera = { ...CAMERA, ...lens };
      const estimator = new Estimator({ ...image, camera }, { ...depth, data: z, camera }, { start: "identity" });
      const distortion = lens.distortion && { distortion: [...lens.distortion] };
      assert.deepEqual(estimator.given.image.camera, { ...camera, ...distortion });
      await estimator.run({ maxIterations: 2 });
      found.push(JSON.stringify(outcome(estimator)));
      assert.equal(JSON.stringify(outcome(Estimator.restore(estimator.save()))), found.at(-1));
    }
    assert.equal(new Set(found).size, lenses.length);
  });

  test("that is none is refused by its field", () => {
    const { image, depth } = pair({ size: 32 });
    const made = (camera) => () => new Estimator({ ...image, camera }, depth);
    refused(made([[60, 1, 15], K[1], K[2]]), "range", "image.camera");
    refused(made([K[0], K[1], [0, 0, 2]]), "range", "image.camera");
    refused(made({ K: K.flat().slice(1) }), "size", "image.camera.K");
    refused(made({ K, fx: 60 }), "option", "image.camera.fx");
    refused(made({ K, distorsion: [] }), "option", "image.camera.distorsion");
    refused(made([[-60, 0, 15], K[1], K[2]]), "range", "image.camera.fx");
  });
});

test("frames and candidates of a check in matrices give the report of those in members", LONG, async () => {
  const frame = await sampleRig({ kind: "objects" });
  const { fx, fy, cx, cy, ...lens } = frame.image.camera;
  const withK = { ...frame, image: { ...frame.image, camera: { K: [fx, 0, cx, 0, fy, cy, 0, 0, 1], ...lens } } };
  const { rotation, translation } = frame.pose;
  const matrix = rowsOf(1, rotation, translation);
  near(frame.pose.matrix.flat(), matrix.flat());
  const [a, b] = [await projectFrame(frame, frame.pose), await projectFrame(withK, matrix)];
  assert.deepEqual(b, a);
  assert.ok(a.points.length > 1000);
  const candidates = { given: matrix };
  const report = await checkCalibration([withK], candidates, { cues: ["edges"] });
  const plain = await checkCalibration([frame], { given: frame.pose }, { cues: ["edges"] });
  assert.deepEqual(report, plain);
  await assert.rejects(checkCalibration([frame], { given: matrix.slice(1) }), {
    code: "size",
    field: "candidates.given",
  });
  const bad = { ...frame, depth: { ...frame.depth, camera: { K: [1] } } };
  await assert.rejects(projectFrame(bad, matrix), { code: "size", field: "frames[0].depth.camera.K" });
});
