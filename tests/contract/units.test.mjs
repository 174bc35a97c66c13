// A depth map in another unit than its own: colours that it explains after a fashion are no answer to be sure of.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, init, pair } from "./support.mjs";

before(() => init());

const found = ({ image, depth }, unit) => {
  const made = new Estimator(image, { ...depth, unit }, { start: "search" });
  while (made.report.status === "running") made.step();
  const { report } = made;
  made.free();
  return report;
};

const DEGREES = 180 / Math.PI;
const apart = ({ rotation: a }, { rotation: b }) =>
  DEGREES * Math.acos(Math.min(1, (a.reduce((sum, entry, index) => sum + entry * b[index], 0) - 1) / 2));

// The image of the bust looks like one of varying albedo.
const [BY_UNIT, BY_CONTRAST] = [
  ["ambiguous", "other-unit", 0.1],
  ["lost", "contrast-unexplained"],
];
for (const [surface, light, beta, [status, code, times]] of [
  ["ripples", "colourful", 10, BY_UNIT],
  ["ripples", "window", 30, BY_UNIT],
  ["bust", "window", 20, BY_CONTRAST],
]) {
  // The bust, and the factors below, stand for the others where time is short.
  test(`relief ten times as deep as it is, ${surface} under ${light} light`, surface === "bust" ? {} : LONG, () => {
    const made = pair({ surface, light, size: 64, angles: { beta }, noise: 0.01 });
    const right = found(made, 1);
    assert.equal(right.status, "converged", right.message);
    assert.ok(apart(right.pose, made.pose) < 1);
    const wrong = found(made, 10);
    assert.ok(apart(wrong.pose, made.pose) > 3, "nothing to be told of");
    assert.equal(wrong.status, status, wrong.message);
    assert.equal(wrong.reason.code, code, wrong.message);
    if (times !== undefined) assert.ok(Math.abs(wrong.reason.times - times) < 1e-6, wrong.message);
  });
}

// Flat relief mostly leaves the pose so open that its sigmas speak first; at 64 pixels those of this pair do.
test("relief a tenth as deep as it is", LONG, () => {
  const made = pair({ surface: "ripples", light: "colourful", size: 96, angles: { beta: 10 }, noise: 0.01 });
  const right = found(made, 1);
  assert.equal(right.status, "converged", right.message);
  assert.ok(apart(right.pose, made.pose) < 1);
  const wrong = found(made, 0.1);
  assert.ok(apart(wrong.pose, made.pose) > 3, "nothing to be told of");
  assert.equal(wrong.status, "ambiguous");
  assert.equal(wrong.reason.code, "other-unit", wrong.message);
  assert.ok(Math.abs(wrong.reason.times - 10) < 1e-6, wrong.message);
});

// What TUM's scale of 5000 makes of millimetres, what half of the resolution does, a raw number taken for another one: about half of
// such pairs ended "converged", 4 to 25 degrees off, while nothing but ten times and a tenth was tried.
// Three times is not told of this pair at 64 pixels: 0.3 times as deep leaves 0.58 of what residuals have in common, as 1/3 is no step.
for (const [unit, size, factor] of [
  [5, 64, "0.20"],
  [3, 96, "0.30"],
  [2, 64, "0.50"],
  [1.5, 64, "0.70"],
  [0.5, 64, "2.0"],
]) {
  test(`relief ${unit} times as deep as it is, which no power of ten is`, () => {
    const made = pair({ surface: "bust", light: "window", size, angles: { beta: 20 }, noise: 0.01 });
    const wrong = found(made, unit);
    assert.ok(apart(wrong.pose, made.pose) > 3, "nothing to be told of");
    assert.equal(wrong.status, "ambiguous", wrong.message);
    assert.equal(
      wrong.message,
      `relief about ${factor} times as deep fits the image better: check the unit of the depths`,
    );
  });
}

// What they leave is no noise but the error of normals of few pixels, and half or twice the relief leaves up to a fifth less of it.
test("the right relief of a view of 48 pixels without noise is doubted by no other unit", () => {
  for (const [light, beta] of [
    ["colourful", 0],
    ["window", 10],
    ["overcast", 0],
  ]) {
    const made = pair({ surface: "bust", light, size: 48, angles: { beta }, noise: 0 });
    const right = found(made, 1);
    assert.ok(apart(right.pose, made.pose) < 2);
    assert.equal(right.status, "converged", right.message);
  }
});

test("relief next to flat, by a unit a thousand times too small, is no error and no answer", LONG, () => {
  for (const surface of ["bust", "vase"]) {
    // The light that its normals ask for at first has coefficients beyond 100.
    const made = pair({ surface, light: "overcast", angles: { beta: 20 }, noise: 0.01 });
    assert.notEqual(found(made, 1e-3).status, "converged", surface);
  }
});
