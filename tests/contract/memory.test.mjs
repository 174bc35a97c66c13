// Memory that the numerics allocate and free. The module's memory never shrinks, so its size is the largest amount ever used.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, estimator, init, pair, sample } from "./support.mjs";

/** Budget for one pixel of either view, bytes: BYTES_PER_PIXEL of src/estimator/memory.rs. */
const BUDGET = 220;
const ROUNDS = 100;
const STEPS = 10_000;

let memory;
const instantiate = WebAssembly.instantiate;
WebAssembly.instantiate = async (...given) => {
  const made = await instantiate(...given);
  memory = (made.instance ?? made).exports.memory;
  return made;
};
await init();
const size = () => memory.buffer.byteLength;

const dome = (column, row) =>
  20 + 25 * Math.exp(-((column - 64) ** 2) / 1500 - (row - 45) ** 2 / 900) + 3 * Math.sin(column / 9 + row / 23);

describe("memory", () => {
  test("a pair keeps to its budget, the search included", LONG, (t) => {
    // The object is as wide as the frame, so that the estimator needs more memory than the renderer, whose freed memory it reuses.
    const relief = {
      width: 128,
      height: 96,
      heights: Float32Array.from({ length: 128 * 96 }, (_, k) => dome(k % 128, Math.floor(k / 128))),
    };
    const [width, height] = [640, 480];
    const { image, depth } = sample({
      surface: relief,
      light: "window",
      size: width,
      height,
      noise: 0.01,
      angles: { beta: 8 },
    });
    const made = new Estimator(image, depth);
    for (let iterations = 0; iterations < 4 && made.report.status === "running"; iterations = made.step().iteration);
    made.free();
    const bytes = size() / (2 * width * height);
    t.diagnostic(`${bytes.toFixed(0)} bytes for each pixel of either view`);
    assert.ok(bytes <= BUDGET, `${bytes} bytes`);
  });

  test(`${ROUNDS} estimators leave nothing behind`, LONG, () => {
    const input = pair();
    const round = () => {
      const made = estimator({}, input);
      made.step();
      made.imageDepth();
      made.free();
    };
    for (let k = 0; k < 5; k++) round();
    const before = size();
    for (let k = 0; k < ROUNDS; k++) round();
    assert.equal(size(), before);
  });

  test(`${STEPS} steps take no more than the first`, LONG, () => {
    const { image, depth, light } = pair({ size: 16 });
    // The loop with ICP runs as long as allowed. Photometric registration would end at once on so small a view. A reset takes as long as
    // ten steps.
    const options = { light, start: "identity", scale: 1, registration: "icp", stopDegrees: 1e-9, maxIterations: 100 };
    const made = new Estimator(image, depth, options);
    const steps = (count) => {
      for (let k = 0; k < count; k++) {
        if (made.step().status !== "running") made.reset(options);
        if (k % 100 === 0) made.imageNormals();
      }
    };
    steps(100);
    const before = size();
    steps(STEPS);
    assert.equal(size(), before);
    made.free();
  });
});
