// The arithmetic of the tables, from rows to summaries. The method's results on the scenes are not tested here.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { missingKeys } from "../../scripts/tables/keys.mjs";
import { show, showAims } from "../../scripts/tables/print.mjs";
import { aims } from "../../protocols/aims.mjs";
import { randomRow } from "../../protocols/counts.mjs";
import { TABLES } from "../../protocols/index.mjs";
import { BLURS, bestBlur } from "../../protocols/measure-sensors.mjs";
import { chance, drawGaussian, mean, median, quantile } from "../../protocols/numbers.mjs";
import * as rotations from "../../protocols/rotations.mjs";
import { drawScene } from "../../protocols/anywhere.mjs";
import { OVERLAPS, kit } from "../../protocols/scenes.mjs";
import { init, sample } from "./support.mjs";

const near = (actual, expected, tolerance = 1e-9) =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${actual} is not ${expected}`);

describe("statistics", () => {
  test("quantiles skip what has no value", () => {
    assert.equal(median([3, null, 1, NaN, 2]), 2);
    assert.equal(quantile([0, 10], 0.25), 2.5);
    assert.equal(median([]), null);
  });

  test("chance repeats for a seed and is Gaussian", () => {
    const [first, again, other] = [1, 1, 2].map((seed) => chance(seed).uniform());
    assert.equal(first, again);
    assert.notEqual(first, other);
    const dice = chance(3);
    const draws = Array.from({ length: 20000 }, () =>
      drawGaussian(
        {
          mean: [1, 2],
          covariance: [
            [4, 1],
            [1, 1],
          ],
        },
        dice,
      ),
    );
    near(mean(draws.map(([a]) => a)), 1, 0.05);
    near(mean(draws.map(([a, b]) => (a - 1) * (b - 2))), 1, 0.05);
    near(mean(draws.map(([a]) => (a - 1) ** 2)), 4, 0.15);
  });
});

describe("rotations", () => {
  test("angles and back, as the package has them", async () => {
    await init();
    const tilted = rotations.product(rotations.aboutAxis([0.6, 0, 0.8], 70), rotations.aboutAxis([0, 0, 1], -25));
    const { pose } = sample({ surface: "bust", light: "colourful", size: 32, angles: rotations.anglesOf(tilted) });
    near(rotations.degreesBetween(pose.rotation, tilted), 0, 1e-9);
  });

  test("the paper's error is 2 sin(angle / 2)", () => {
    near(rotations.paperError(1.2993), 0.022676, 1e-5);
    near(rotations.paperDegrees(rotations.paperError(17)), 17);
  });

  test("the axes of what is left over", () => {
    const truth = rotations.aboutY(50);
    const off = rotations.offBy(rotations.product(rotations.aboutAxis([0, 0, 1], 0.25), truth), truth);
    [0, 0, 0.25].forEach((expected, axis) => near(off[axis], expected));
  });
});

describe("definitions", () => {
  for (const complete of [true, false]) {
    test(complete ? "with other people's data" : "with what the package brings", () => {
      for (const quick of [true, false]) {
        const cells = TABLES.flatMap((table) => table.cells(kit(complete), quick));
        const byId = new Map(cells.map((cell) => [cell.id, cell]));
        // Tables may share a cell, which must then be identical.
        for (const cell of cells) assert.deepEqual(cell, byId.get(cell.id));
        assert.deepEqual(JSON.parse(JSON.stringify(cells)), cells, "cells travel to other processes");
      }
    });
  }

  test("the full tables have the protocol's number of cells", () => {
    const count = (name) => TABLES.find((table) => table.name === name).cells(kit(true), false).length;
    assert.deepEqual(
      ["table1", "table2A", "table2B", "figure5", "sensors", "photographs", "conditions", "random"].map(count),
      [4, 30, 480, 72, 27, 120, 136, 300],
    );
  });

  test("random scenes keep to their limits and to their seed", () => {
    const gaussian = {
      mean: Array(27).fill(-1),
      covariance: Array.from({ length: 27 }, (_, i) => Array.from({ length: 27 }, (_, j) => Number(i === j))),
    };
    for (let seed = 1; seed <= 100; seed++) {
      const scene = drawScene(chance(seed), kit(true), gaussian);
      assert.deepEqual(scene, drawScene(chance(seed), kit(true), gaussian));
      assert.ok(scene.overlap >= 0.4 && scene.overlap <= 1 && scene.scale >= 0.8 && scene.scale <= 1.25);
      assert.equal(scene.light.length, 27);
      assert.ok(Math.abs(scene.angles.beta) <= 90);
    }
  });
});

describe("the random row", () => {
  const scene = (degrees, status, extra = {}) => ({
    degrees,
    status,
    rivals: 0,
    milliseconds: 1,
    rotationOff: [degrees, 0, 0],
    sigmas: [1, 1, 1],
    ...extra,
  });
  const row = randomRow([
    scene(0.5, "converged"),
    scene(1.5, "max-iterations"),
    scene(2.9, "ambiguous"),
    scene(40, "converged"),
    scene(40, "max-iterations"),
    scene(40, "lost"),
    scene(40, "max-iterations", { rivals: 1 }),
  ]);

  test("counts", () => {
    const { cases, found, ambiguousOrLost, confidentlyWrong, flaggedThoughFound, medianDegrees } = row;
    assert.deepEqual([cases, found, ambiguousOrLost, confidentlyWrong, flaggedThoughFound], [7, 3, 3, 2, 1]);
    assert.equal(medianDegrees, 1.5);
  });

  test("coverage is of the found", () => {
    near(row.coverage1, 7 / 9);
    assert.deepEqual(row.coverage1PerAxis, [1 / 3, 1, 1]);
    assert.equal(row.coverage3, 1);
    assert.equal(randomRow([scene(1, "converged", { sigmas: null })]).coverage3, 0);
  });
});

describe("aims", () => {
  const cell = (size, light, beta, overlap, degrees, extra = {}) => ({
    ...{
      size,
      light,
      lightName: "A",
      beta,
      overlap,
      degrees,
      error: 0,
      paper: 1,
      bound: 0.1,
      status: "converged",
      rivals: 0,
      milliseconds: 1,
    },
    ...extra,
  });
  const verdict = (json, what) => aims(json).find((aim) => aim.what.includes(what));

  test("are computed from the rows", () => {
    const table2B = [
      cell(128, "known", 20, 0.5, 0.05),
      cell(128, "known", 20, 1, 0.3),
      cell(128, "known", 20, 0.125, 5),
      cell(128, "unknown", 90, 1, 50),
      cell(128, "unknown", 90, 0.5, 50, { status: "ambiguous" }),
    ];
    assert.equal(verdict({ table2B }, "known, P_w >= 0.5: worst").ok, true);
    assert.equal(verdict({ table2B }, "known, P_w >= 0.5: median").ok, false);
    assert.equal(verdict({ table2B }, "known, P_w < 0.5: worst").ok, false);
    near(verdict({ table2B }, "known, all: median of degrees / bound").measured, 3);
    assert.equal(verdict({ table2B }, "beta = 90").measured, 0.5);
    assert.equal(verdict({ table2B }, "64x64"), undefined, "nothing is said without rows");
  });

  test("Figure 5 falls at every step, each run by itself", () => {
    const figure5 = [12, 9, 10].map((degrees, index) => ({
      size: 32,
      lightName: "A",
      shading: "pixel",
      fraction: index / 2,
      degrees,
      depthRmse: 1,
    }));
    assert.deepEqual(
      [verdict({ figure5 }, "largest rise").measured, verdict({ figure5 }, "largest rise").ok],
      [1, false],
    );
  });

  test("are printed with their verdicts", () => {
    const table2A = OVERLAPS.map((overlap) => cell(32, "known", 20, overlap, 0.1, { error: 0.001, paper: 0.5 }));
    assert.match(showAims(aims({ table2A })).at(-1), /table2A: every cell.* 0\.002 .*<= 0\.01 +ok$/);
    const table = TABLES.find(({ name }) => name === "table2A");
    assert.ok(show(table, table2A).some((line) => line.includes("0.001000")));
    assert.ok(show(table, []).includes("  nothing to show"));
  });
});

describe("the blur that refined depth is compared with", () => {
  const side = 24;
  const heights = Float64Array.from({ length: side ** 2 }, (_, index) => 50 + 0.2 * (index % side));
  const errorsTo = (truth) => (found) =>
    [...truth.keys()].filter((k) => truth[k] > 0).map((k) => Math.abs(found[k] - truth[k]));

  test("smooths noise, and leaves a map without noise as it is", () => {
    const dice = chance(5);
    const noisy = heights.map((height) => height + 0.5 * dice.gaussian());
    const best = bestBlur({ width: side, height: side, data: noisy }, errorsTo(heights));
    const plain = bestBlur({ width: side, height: side, data: heights }, errorsTo(heights));
    assert.ok(best.blurRms < 0.25 && best.blurRmsSigma > 0.5 && BLURS.includes(best.blurSigma), JSON.stringify(best));
    assert.deepEqual([plain.blur, plain.blurSigma, plain.blurRms, plain.blurRmsSigma], [0, 0, 0, 0]);
  });

  test("takes no part of what is off the mask or not measured", () => {
    const flat = heights.map(() => 50);
    const mask = flat.map((_, index) => (index % side < 12 ? 1 : 0));
    const data = flat.map((height, index) => (index % 7 === 0 ? 0 : mask[index] ? height + (index % 2) : 900));
    const truth = data.map((value, index) => (mask[index] && value > 0 ? 50.5 : NaN));
    const { blur, blurRms } = bestBlur({ width: side, height: side, mask, data }, errorsTo(truth));
    assert.ok(blur < 0.2 && blurRms < 0.2, `${blur} ${blurRms}`);
  });

  test("is judged by sensor and half, and by the RMS errors of all", () => {
    const row = (sensor, half, overBlur, rmsOverBlur) => ({
      ...{ sensor, half, overBlur, rmsOverBlur, object: "o", before: 2, after: 1, ratio: 2, meanRatio: 2 },
      ...{ blur: 1, blurSigma: 0.8, rms: 1, blurRms: 1.5, blurRmsSigma: 0.6, status: "converged" },
    });
    const rows = [
      row("mitten", "tuned", 1.2, 0.9),
      row("scan, render", "tuned", 1.9, 1.1),
      row("scan, render", "held out", 2.1, 1.1),
    ];
    const said = aims({ sensors: rows }).filter(({ what }) => what.includes("best blur"));
    const verdicts = said.map(({ what, measured, ok }) => [what.split(":")[0], measured, ok]);
    assert.deepEqual(verdicts, [
      ["mitten", 1.2, true],
      ["scan, render, tuned", 1.9, false],
      ["scan, render, held out", 2.1, true],
      ["tuned", 0.5, false],
      ["held out", 1, true],
    ]);
    const table = TABLES.find(({ name }) => name === "sensors");
    assert.ok(
      show(table, rows).some((line) => /mitten .* 1\.000 \(0\.8\) +x1\.20 .* 1\.500 \(0\.6\) +x0\.90 /.test(line)),
    );
  });
});

test("missing keys are named", () => {
  const json = Object.fromEntries(TABLES.map(({ name }) => [name, name === "random" ? {} : []]));
  const missing = missingKeys(json, { realPairs: false });
  assert.ok(
    missing.includes("rows of table1") && missing.includes("random.found") && !missing.includes("rows of table3"),
  );
  assert.ok(missingKeys(json, { realPairs: true }).includes("rows of table3"));
});
