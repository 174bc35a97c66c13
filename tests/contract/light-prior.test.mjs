// The option `prior`: as a list or as rows it is accepted and has an effect; invalid values are refused by name.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, describe, test } from "node:test";
import { Estimator, init, refused, sample } from "./support.mjs";

/** The crate's own prior to six digits, written by scripts/reference/light-prior.py next to the Rust table. */
const KEPT = JSON.parse(readFileSync(new URL("../../scripts/reference/light-prior.json", import.meta.url), "utf8"));
const OWN = { mean: KEPT.mean, covariance: KEPT.covariance };
/** A prior that allows only grey light from the viewer. */
const narrow = {
  mean: Float64Array.from({ length: 27 }, (_, at) => [-1, 0, -0.5][at % 9] ?? 0),
  covariance: Float64Array.from({ length: 729 }, (_, at) => (at % 28 === 0 ? 1e-10 : 0)),
};

let pair;
before(async () => {
  await init();
  pair = sample({ surface: "bust", light: "window", size: 32, angles: { beta: 20 } });
});

/** The light at the true pose after one iteration. */
function light(options) {
  const fixed = { start: pair.pose, scale: 1, registration: "fixed", maxIterations: 1 };
  const estimator = new Estimator(pair.image, pair.depth, { ...fixed, ...options });
  estimator.step();
  const found = estimator.light();
  estimator.free();
  return found;
}
const off = (a, b) => Math.max(...a.map((value, index) => Math.abs(value - b[index])));

describe("a prior over lights", () => {
  test("of the kept file is the default", () => {
    assert.ok(off(light({ prior: OWN }), light({})) < 1e-3);
  });

  test("is a list of numbers or of rows", () => {
    assert.deepEqual(light({ prior: { ...OWN, covariance: OWN.covariance.flat() } }), light({ prior: OWN }));
    const rows = OWN.covariance.map((row) => Float32Array.from(row));
    assert.ok(off(light({ prior: { ...OWN, covariance: rows } }), light({ prior: OWN })) < 1e-4);
  });

  test("is followed where it is narrow", () => {
    const found = light({ prior: narrow });
    assert.ok(Math.abs(found[2] + 0.5) < 0.01 && Math.abs(found[3]) < 0.01, `${found}`);
    assert.ok(off(found, light({})) > 0.1);
  });

  test("goes with a saved run", () => {
    const run = new Estimator(pair.image, pair.depth, { prior: OWN, start: pair.pose, registration: "fixed" });
    run.step();
    const restored = Estimator.restore(run.save());
    assert.deepEqual(restored.light(), run.light());
    for (const estimator of [run, restored]) estimator.free();
  });

  test("is refused by name", () => {
    const bad = (prior, code, field) => refused(() => light({ prior }), code, `options.prior${field}`);
    const changed = (change) => ({ ...OWN, covariance: OWN.covariance.map((row, at) => change(row, at)) });
    bad([1, 2], "type", "");
    bad({ mean: OWN.mean }, "missing", ".covariance");
    bad({ ...OWN, variance: 1 }, "option", ".variance");
    bad({ ...OWN, mean: OWN.mean.slice(1) }, "size", ".mean");
    bad({ ...OWN, mean: OWN.mean.map(() => NaN) }, "range", ".mean");
    bad({ ...OWN, covariance: OWN.mean }, "size", ".covariance");
    bad({ ...OWN, covariance: OWN.covariance.slice(1) }, "size", ".covariance");
    bad(
      changed((row, at) => (at === 3 ? [1] : row)),
      "size",
      ".covariance[3]",
    );
    bad(
      changed((row) => row.map((value) => -value)),
      "range",
      ".covariance",
    );
    bad(
      changed((row, at) => row.map((value, of) => value + (at < of ? 0.1 : 0))),
      "range",
      ".covariance",
    );
  });
});
