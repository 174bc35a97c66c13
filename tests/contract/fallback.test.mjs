// A machine without SIMD loads only the other file and finds the same answer.
import assert from "node:assert/strict";
import { once } from "node:events";
import { before, describe, test } from "node:test";
import { Worker } from "node:worker_threads";

const SIMD = "bimodal_stereo_bg.wasm";
const SCALAR = "bimodal_stereo_scalar_bg.wasm";
/** Limit of the difference between the rotations: rounding may differ where a compiler reorders sums. */
const DEGREES = 0.001;
/** No pose or light is known, so that the whole method runs, including the search. */
const REQUEST = {
  surface: "bust",
  light: "window",
  size: 64,
  angles: { alpha: 10, beta: 50, gamma: 15 },
  overlap: 0.7,
  noise: 0.01,
};

/**
 * With smooth albedo, so that local contrast and the registration in the gradient domain decide. An engine that ran the optimised
 * SIMD module wrongly made that registration fail, and nothing else showed it.
 */
const PAINTS = 4;

async function start(inNode, knowsSimd, paints) {
  const workerData = { inNode, knowsSimd, request: REQUEST, paints };
  const [result] = await once(new Worker(new URL("start.mjs", import.meta.url), { workerData }), "message");
  return result;
}

const degrees = (a, b) =>
  (2 * Math.asin(Math.hypot(...a.map((value, i) => value - b[i])) / Math.SQRT2 / 2) * 180) / Math.PI;

for (const inNode of [true, false]) {
  describe(`init() in ${inNode ? "Node" : "a browser"}`, () => {
    let usual;
    let fallback;
    before(async () => {
      [usual, fallback] = await Promise.all([start(inNode, true), start(inNode, false)]);
    });

    test("reads one file: with SIMD the default, else the scalar one", () => {
      assert.deepEqual(usual.opened, [SIMD]);
      assert.deepEqual(fallback.opened, [SCALAR]);
    });

    test("finds the same pose with either", (t) => {
      const apart = degrees(fallback.pose.rotation, usual.pose.rotation);
      t.diagnostic(`${apart} degrees apart`);
      assert.deepEqual([usual.status, fallback.status], ["converged", "converged"]);
      assert.ok(apart < DEGREES, `${apart} degrees apart`);
      assert.ok(Math.abs(fallback.pose.scale - usual.pose.scale) < 1e-5);
      assert.ok(degrees(fallback.pose.rotation, fallback.truth.rotation) < 1);
    });
  });
}

test("finds the same pose with either if the albedo varies smoothly", async (t) => {
  const [usual, fallback] = await Promise.all([start(true, true, PAINTS), start(true, false, PAINTS)]);
  const apart = degrees(fallback.pose.rotation, usual.pose.rotation);
  const [sigmas, others] = [usual, fallback].map(({ uncertainty }) => uncertainty.rotationDegrees);
  t.diagnostic(`${apart} degrees apart, sigmas ${sigmas} and ${others}`);
  assert.equal(usual.status, fallback.status);
  assert.ok(apart < 0.1 * Math.max(...sigmas), `${apart} degrees apart`);
  for (const [axis, sigma] of sigmas.entries())
    assert.ok(Math.abs(others[axis] / sigma - 1) < 0.02, `${sigma} ${others[axis]}`);
});
