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
 * Seed of a smooth albedo, so that local contrast and the registration in the gradient domain decide. If an engine compiles the
 * SIMD module wrongly, that registration can fail without an error, and only the pose shows it.
 */
const ALBEDO_SEED = 4;
/** Limit of the difference between the sigmas, as a share of them. */
const SHARE = 0.001;

async function start(inNode, knowsSimd, albedoSeed) {
  const workerData = { inNode, knowsSimd, request: REQUEST, albedoSeed };
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
  const [usual, fallback] = await Promise.all([true, false].map((knowsSimd) => start(true, knowsSimd, ALBEDO_SEED)));
  const apart = degrees(fallback.pose.rotation, usual.pose.rotation);
  const [sigmas, others] = [usual, fallback].map(({ uncertainty }) => uncertainty.rotationDegrees);
  t.diagnostic(`${apart} degrees apart, sigmas ${sigmas} and ${others}`);
  assert.equal(usual.status, fallback.status);
  assert.ok(apart < DEGREES, `${apart} degrees apart`);
  for (const [axis, sigma] of sigmas.entries())
    assert.ok(Math.abs(others[axis] / sigma - 1) < SHARE, `${sigma} ${others[axis]}`);
});
