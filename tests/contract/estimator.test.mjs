// The life cycle of an estimator: its results, their types, and its end.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, estimator, init, pair, refused, sample, sampleLights, sampleSurfaces } from "./support.mjs";

const SIDE = 32;
const PIXELS = SIDE * SIDE;
const STAGES = ["light", "shading", "surface", "registration", "refinement"];

before(() => init());

const outputs = (made) => ({
  imageNormals: made.imageNormals(),
  imageDepth: made.imageDepth(),
  depthNormals: made.depthNormals(),
  refinedDepth: made.refinedDepth(),
  correspondence: made.correspondence(),
  residual: made.residual(),
  albedo: made.albedo(),
  shading: made.shading(),
  light: made.light(),
  image: made.points("image"),
  depth: made.points("depth"),
  report: { ...made.report, milliseconds: {} },
});

test("init may be called again", async () => {
  await Promise.all([init(), init()]);
});

test("built-in samples have names and shapes", () => {
  assert.ok(sampleSurfaces().length >= 3 && sampleLights().length >= 3);
  for (const surface of sampleSurfaces()) {
    for (const light of sampleLights()) {
      const made = sample({ surface, light, size: SIDE, height: 24, angles: { beta: 10 } });
      assert.deepEqual([made.image.width, made.image.height], [SIDE, 24]);
      assert.ok(made.image.data instanceof Float32Array && made.image.data.length === 3 * SIDE * 24);
      assert.ok(made.depth.data instanceof Float32Array && made.depth.data.length === SIDE * 24);
      assert.equal(made.light.length, 27);
      assert.ok(Math.abs(made.pose.angles.beta - 10) < 1e-9);
      assert.equal(made.truth.imageNormals.length, 3 * SIDE * 24);
    }
  }
});

test("getters have the contract's types and lengths", () => {
  const made = estimator();
  made.step();
  const all = outputs(made);
  for (const [name, type, length] of [
    ["imageNormals", Float32Array, 3 * PIXELS],
    ["imageDepth", Float32Array, PIXELS],
    ["depthNormals", Float32Array, 3 * PIXELS],
    ["refinedDepth", Float32Array, PIXELS],
    ["correspondence", Int32Array, PIXELS],
    ["residual", Float32Array, PIXELS],
    ["albedo", Float32Array, 3 * PIXELS],
    ["shading", Float32Array, 3 * PIXELS],
    ["light", Float64Array, 27],
  ]) {
    assert.ok(all[name] instanceof type, name);
    assert.equal(all[name].length, length, name);
  }
  for (const view of ["image", "depth"]) {
    assert.ok(all[view] instanceof Float32Array && all[view].length % 3 === 0 && all[view].length > 0, view);
    assert.ok(all[view].every(Number.isFinite), view);
  }
});

test("log S is albedo and shading and a remainder of the residual's length", async () => {
  const { image, depth, pose } = pair({ size: 64, angles: { beta: 0 }, light: "window" });
  const isPainted = (index) => (Math.floor((index % 64) / 8) + Math.floor(index / 512)) % 2 === 1;
  const data = image.data.map((value, i) => (isPainted(Math.floor(i / 3)) ? value * [0.4, 0.7, 1.3][i % 3] : value));
  const made = new Estimator({ ...image, data }, depth, { start: pose, registration: "fixed" });
  await made.run();
  const [albedo, shading, residual] = [made.albedo(), made.shading(), made.residual()];
  const sums = [0, 0, 0];
  for (let index = 0; index < 64 * 64; index++) {
    const channels = [0, 1, 2].map((c) => 3 * index + c);
    if (!image.mask[index]) {
      assert.ok(
        channels.every((at) => Number.isNaN(albedo[at]) && Number.isNaN(shading[at])) && Number.isNaN(residual[index]),
      );
      continue;
    }
    const left = channels.map((at) => Math.log(data[at]) - albedo[at] - shading[at]);
    assert.ok(Math.abs(Math.hypot(...left) - residual[index]) < 1e-4, `${index}: ${left} ${residual[index]}`);
    channels.forEach((at, c) => (sums[c] += albedo[at]));
  }
  assert.ok(
    sums.every((sum) => Math.abs(sum) < 0.05),
    `${sums}`,
  );
  assert.ok(
    albedo.some((value) => Math.abs(value) > 0.2),
    "paint is found",
  );
  made.free();
});

test("a photograph of twelve megapixels is taken with a small depth map, in its own pixels", LONG, () => {
  const { image, depth } = pair({ size: 64 });
  const [width, height, side] = [4000, 3000, 40];
  const [data, mask] = [new Uint8Array(4 * width * height), new Uint8Array(width * height)];
  const brightest = image.data.reduce((most, value) => (value > most ? value : most), 0);
  for (let index = 0; index < width * height; index++) {
    const [column, row] = [index % width, Math.floor(index / width)].map((at) => Math.floor((at - 200) / side));
    const inside = column >= 0 && row >= 0 && column < 64 && row < 64;
    const pixel = row * 64 + column;
    if (!inside || !image.mask[pixel]) continue;
    mask[index] = 255;
    for (let c = 0; c < 3; c++) data[4 * index + c] = (250 * image.data[3 * pixel + c]) / brightest;
    data[4 * index + 3] = 255;
  }
  const made = new Estimator({ width, height, data, mask, transfer: "linear" }, depth, { start: "identity" });
  made.step();
  assert.equal(made.residual().length, width * height);
  assert.equal(made.imageNormals().length, 3 * width * height);
  const { scale } = made.report.pose;
  assert.ok(scale > 0.8 * side && scale < 1.2 * side, `${scale}`);
  made.free();
});

test("outputs are copies", () => {
  const made = estimator();
  made.step();
  const first = made.refinedDepth();
  const kept = first.slice();
  made.refinedDepth().fill(0);
  made.step();
  assert.deepEqual(first, kept);
});

test("a report has every member of the contract", () => {
  const made = estimator();
  const report = made.step();
  assert.equal(report.iteration, 1);
  assert.ok(STAGES.includes(report.stage));
  assert.equal(report.pose.rotation.length, 9);
  assert.equal(report.pose.translation.length, 3);
  for (const value of [report.pose.scale, report.rotationChange, report.overlap, report.inliers, report.residual]) {
    assert.equal(typeof value, "number");
  }
  assert.deepEqual(Object.keys(report.pose.angles).sort(), ["alpha", "beta", "gamma"]);
  const { total, ...terms } = report.energy;
  assert.deepEqual(Object.keys(terms).sort(), ["prior", "refinement", "registration", "shading"]);
  assert.ok(Math.abs(Object.values(terms).reduce((a, b) => a + b) - total) < 1e-9);
  assert.ok(Object.values(report.milliseconds).every((time) => time >= 0));
  assert.deepEqual(report, made.report);
});

test("stages run in the contract's order and make up a step", () => {
  const made = estimator();
  const seen = STAGES.map(() => made.stepStage().stage);
  assert.deepEqual(seen, STAGES);
  assert.equal(made.report.iteration, 1);
});

test("the same input gives the same output", async () => {
  const first = estimator({ maxIterations: 4, seed: 7 });
  const second = estimator({ maxIterations: 4, seed: 7 });
  await first.run();
  await second.run();
  assert.deepEqual(outputs(first), outputs(second));
  first.reset();
  assert.equal(first.report.iteration, 0);
  await first.run();
  assert.deepEqual(outputs(first), outputs(second));
});

test("reset with other options uses them", () => {
  const made = estimator();
  made.step();
  made.reset({ start: { angles: { beta: 5 }, scale: 1 }, registration: "fixed", maxIterations: 2 });
  assert.equal(made.report.iteration, 0);
  assert.ok(Math.abs(made.report.pose.angles.beta - 5) < 1e-6);
  made.step();
  assert.ok(Math.abs(made.report.pose.angles.beta - 5) < 1e-6);
});

test("rotation wins over angles", () => {
  const made = estimator({ start: { rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], angles: { beta: 40 } } });
  assert.ok(Math.abs(made.report.pose.angles.beta) < 1e-9);
});

test("colours may come in every kind of array", () => {
  const { image, depth, light } = pair();
  const levels = (most) =>
    Array.from({ length: 4 * PIXELS }, (_, i) =>
      i % 4 === 3 ? most : Math.round(Math.min(1, image.data[3 * (i >> 2) + (i % 4)] * 0.9) * most),
    );
  for (const data of [
    new Uint8Array(levels(255)),
    new Uint8ClampedArray(levels(255)),
    new Uint16Array(levels(65535)),
  ]) {
    const made = new Estimator({ ...image, data, transfer: "linear" }, depth, { light, start: "identity" });
    assert.equal(made.step().iteration, 1);
  }
  const integers = new Estimator(
    image,
    { ...depth, data: new Uint16Array(depth.data.map((z) => z * 100)), unit: 0.01 },
    { light, start: "identity" },
  );
  assert.equal(integers.step().iteration, 1);
});

test("depths where a folding lens lets no ray through are left out", () => {
  const { image, depth, light } = pair({ size: 64 });
  const camera = { fx: 60, fy: 60, cx: 32, cy: 32, distortion: [-1, 0, 0, 0, 0] };
  const made = new Estimator(image, { ...depth, camera }, { light, start: "identity" });
  const { pose, stage, message } = made.step();
  assert.equal(stage, "refinement", message);
  assert.ok([pose.scale, ...pose.rotation, ...pose.translation].every(Number.isFinite));
  for (const view of ["image", "depth"]) assert.ok(made.points(view).every(Number.isFinite), view);
  assert.ok(made.refinedDepth().some(Number.isFinite));
});

test("a pose says itself as a matrix, and an end its code with its numbers", async () => {
  const { pose, reason, message } = await estimator({ registration: "fixed", maxIterations: 1 }).run();
  const [scaled, row] = [pose.rotation.map((entry) => pose.scale * entry), (i) => [3 * i, 3 * i + 3]];
  assert.deepEqual(pose.matrix, [
    ...[0, 1, 2].map((i) => [...scaled.slice(...row(i)), pose.translation[i]]),
    [0, 0, 0, 1],
  ]);
  assert.deepEqual(reason, { code: "iteration-cap", iterations: 1 });
  assert.equal(message, "the limit of 1 iterations was reached");
  assert.deepEqual(
    await estimator({ start: pose, registration: "fixed", maxIterations: 1 })
      .run()
      .then(({ reason }) => reason),
    reason,
  );
});

test("a start of an absurd scale is kept and lost", async () => {
  const { status, reason, pose, uncertainty } = await estimator({ start: { scale: 1e-9 }, scale: "free" }).run();
  assert.equal(status, "lost");
  assert.deepEqual(reason, { code: "initial-pose-kept" });
  assert.equal(pose.scale, 1e-9);
  assert.equal(uncertainty, undefined);
});

test("stepFor does at least one step and stops at the end", () => {
  const made = estimator({ maxIterations: 3 });
  assert.equal(made.stepFor(0).iteration, 1);
  assert.notEqual(made.stepFor(Infinity).status, "running");
  assert.ok(made.report.iteration <= 3);
  refused(() => made.stepFor("soon"), "type", "milliseconds");
});

describe("run", () => {
  test("reports each step, leaves room for events and honours maxIterations", async () => {
    const made = estimator({ stopDegrees: 1e-12 });
    const seen = [];
    let events = 0;
    const onStep = ({ iteration }) => {
      seen.push(iteration);
      // This runs in the next turn of the event loop, that is, within two steps.
      if (iteration === 1) setImmediate(() => events++);
      if (iteration === 3) assert.equal(events, 1);
    };
    const last = await made.run({ maxIterations: 3, onStep });
    assert.deepEqual(seen, [1, 2, 3]);
    assert.equal(last.iteration, 3);
  });

  test("ends by itself", async () => {
    const made = estimator();
    assert.notEqual((await made.run()).status, "running");
  });

  test("an abort rejects with its reason and keeps what was reached", async () => {
    const made = estimator();
    const reason = new Error("enough");
    const control = new AbortController();
    const running = made.run({ signal: control.signal, onStep: () => control.abort(reason) });
    await assert.rejects(running, (error) => error === reason);
    assert.equal(made.report.iteration, 1);
    await assert.rejects(made.run({ signal: AbortSignal.abort() }), { name: "AbortError" });
    assert.equal(made.report.iteration, 1);
    assert.equal(made.step().iteration, 2);
  });

  test("refuses what it does not know", async () => {
    const made = estimator();
    await assert.rejects(made.run({ maxIterations: -1 }), { code: "range", field: "run.maxIterations" });
    await assert.rejects(made.run({ maxIteration: 2 }), { name: "BimodalError", field: "run.maxIteration" });
    await assert.rejects(made.run({ onStep: 2 }), { name: "BimodalError", field: "run.onStep" });
  });

  test("freed on the way, it says so", async () => {
    const made = estimator();
    await assert.rejects(made.run({ onStep: () => made.free() }), { name: "BimodalError", code: "freed" });
  });
});

describe("for await", () => {
  test("gives a report for each step, the last one with the status that the loop ends with", async () => {
    const [made, other] = [estimator({ stopDegrees: 0.1 }), estimator({ stopDegrees: 0.1 })];
    const reports = [];
    for await (const report of made) reports.push(report);
    const expected = [];
    await other.run({ onStep: (report) => expected.push(report) });
    const alone = ({ milliseconds, ...rest }) => rest;
    assert.deepEqual(reports.map(alone), expected.map(alone));
    assert.ok(reports.length > 1 && reports.slice(0, -1).every(({ status }) => status === "running"));
    assert.notEqual(reports.at(-1).status, "running");
    assert.deepEqual(reports.at(-1), made.report);
    // The loop is over, so there is no further step.
    for await (const report of made) assert.fail(report.status);
  });

  test("lets events through, and goes on after a break where it was left", async () => {
    const made = estimator({ stopDegrees: 1e-12 });
    let events = 0;
    for await (const { iteration } of made) {
      if (iteration === 1) setImmediate(() => events++);
      if (iteration === 3) break;
    }
    assert.equal(events, 1);
    assert.equal(made.report.iteration, 3);
    for await (const { iteration } of made) {
      assert.equal(iteration, 4);
      break;
    }
  });

  test("ends with the caller's error, or with the estimator", async () => {
    const made = estimator({ stopDegrees: 1e-12 });
    const error = new Error("of the caller");
    const each = async (body) => {
      for await (const report of made) body(report);
    };
    const broken = each(() => {
      throw error;
    });
    await assert.rejects(broken, (thrown) => thrown === error);
    assert.equal(made.report.iteration, 1);
    const freed = each(() => made.free());
    await assert.rejects(freed, { code: "freed" });
  });
});

test("after free nothing works but free", () => {
  const made = estimator();
  made.free();
  made.free();
  for (const call of [
    () => made.step(),
    () => made.report,
    () => made.light(),
    () => made.reset(),
    () => made.points("image"),
  ]) {
    refused(call, "freed", undefined);
  }
});

test("Symbol.dispose frees", () => {
  const made = estimator();
  made[Symbol.dispose]();
  refused(() => made.step(), "freed", undefined);
});
