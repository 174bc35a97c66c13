// Runs of the built package with nothing known: the loop begins with a search in slices, which finds the pose.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { Estimator, init, sample } from "./support.mjs";
import { aboutAxis, product } from "../../protocols/rotations.mjs";

const REQUEST = {
  surface: "bust",
  light: "window",
  size: 64,
  angles: { alpha: 10, beta: 50, gamma: 15 },
  overlap: 0.7,
  noise: 0.01,
};
const degrees = (a, b) =>
  (2 * Math.asin(Math.hypot(...a.map((value, i) => value - b[i])) / Math.SQRT2 / 2) * 180) / Math.PI;

/** R = Rx(alpha) Ry(beta) Rz(gamma). */
const rotationOf = ([alpha, beta, gamma]) =>
  product(product(aboutAxis([1, 0, 0], alpha), aboutAxis([0, 1, 0], beta)), aboutAxis([0, 0, 1], gamma));

/** Runs to the end and returns every report. */
function reports({ image, depth }, gain = 1, options = {}) {
  const estimator = new Estimator({ ...image, data: image.data.map((value) => gain * value) }, depth, options);
  const seen = [];
  do seen.push(estimator.step());
  while (seen.at(-1).status === "running");
  estimator.free();
  return seen;
}

before(() => init());

describe("search", () => {
  test("nothing known: slices of a search, then a converged loop", () => {
    const pair = sample(REQUEST);
    const seen = reports(pair);
    const search = seen.filter(({ stage }) => stage === "search");
    assert.ok(search.length > 50 && search.every(({ iteration, status }) => iteration === 0 && status === "running"));
    assert.deepEqual(search[0].reason, { code: "searching", percent: 0, activity: "preparing" });
    assert.deepEqual(search.at(-1).reason, { code: "search-done", by: "image", rivals: 0 });
    assert.match(search.at(-1).message, /^100 %: /);
    const last = seen.at(-1);
    assert.equal(last.status, "converged", last.message);
    assert.equal(last.rivals, undefined);
    assert.ok(degrees(last.pose.rotation, pair.pose.rotation) < 1);
    assert.equal(last.uncertainty.rotationDegrees.length, 3);
  });

  test("what was tried can be looked at while it fills, and the truth is where it is highest", () => {
    const pair = sample(REQUEST);
    const estimator = new Estimator(pair.image, pair.depth);
    assert.equal(estimator.searchScores().length, 0);
    let [count, best] = [0, [0, 0, 0, -Infinity]];
    while (estimator.step().stage === "search") {
      const scores = estimator.searchScores();
      if (scores.length === 0) continue;
      assert.ok(scores.length % 4 === 0 && scores.length >= count && scores.every(Number.isFinite));
      count = scores.length;
      for (let row = 0; row < count; row += 4) if (scores[row + 3] > best[3]) best = [...scores.subarray(row, row + 4)];
    }
    assert.ok(count > 4 * 300, `${count / 4} rotations`);
    // Rotations are 16 degrees apart; registration refines the pose.
    assert.ok(degrees(rotationOf(best), pair.pose.rotation) < 15, String(best));
    while (estimator.step().status === "running");
    assert.equal(estimator.searchScores().length, 0);
    estimator.free();
  });

  test("the exposure changes nothing", () => {
    const pair = sample(REQUEST);
    const [dark, bright] = [0.1, 10].map((gain) => reports(pair, gain).at(-1).pose.rotation);
    assert.ok(degrees(dark, bright) < 0.01, `${degrees(dark, bright)}`);
  });

  test("one colour everywhere is no answer and no exception", () => {
    const { image, depth } = sample(REQUEST);
    for (const value of [0.5, 1e30, 3e38]) {
      const last = reports({ image: { ...image, data: image.data.fill(value) }, depth }).at(-1);
      assert.equal(last.status, "lost");
      const { code, error } = last.reason;
      assert.deepEqual([code, error.code, error.field], ["stage-failed", "degenerate", "image"], `${value}`);
    }
  });

  test("where nothing is found, the scales that were compared are named, if there were any", () => {
    const { image, depth } = sample({ ...REQUEST, size: 32 });
    const last = (data, options) => reports({ image, depth: { ...depth, data } }, 1, options).at(-1);
    const free = last(depth.data.map(() => 20));
    assert.deepEqual(free.reason, { code: "no-pose", scaleIsHeld: false });
    assert.match(free.message, / 0\.7 to 1\.4 /);
    const held = last(depth.data, { scale: 10 });
    assert.deepEqual(held.reason, { code: "no-pose", scaleIsHeld: true });
    assert.doesNotMatch(held.message, / 0\.7 /);
  });
});
