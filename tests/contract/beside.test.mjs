// The comparison of `npm run bench -- --beside`: its arithmetic and its text. Neither side is timed here.
import assert from "node:assert/strict";
import { writeFileSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { ANSWER, ICP, iterationOf, rowOf } from "../../scripts/bench/beside.mjs";
import { besideReport } from "../../scripts/bench/print-beside.mjs";
import { theirSide } from "../../scripts/bench/theirs.mjs";
import { besideLines } from "../../scripts/docs.mjs";

const times = (ours, theirs, ourDegrees = [], theirDegrees = []) => ({ ours, theirs, ourDegrees, theirDegrees });
const rows = [
  rowOf("light", "64x64", times([1, 2, 3], [10, 20, 30]), 300),
  rowOf(ICP, "64x64", times([50], [5], [0.5], [0.7]), 300),
  rowOf(ANSWER, "64x64", times([1000], [2500], [0.25], [12]), 300),
  rowOf(ANSWER, "640x480", times([3000], [null], [0.1], []), 300),
];
const random = [
  {
    ...{ size: "64x64", scenes: 8 },
    ours: { found: 8, medianDegrees: 0.5, milliseconds: 1500 },
    theirs: { found: 6, medianDegrees: 0.75, milliseconds: 3000 },
  },
];
const result = { rows, random, limit: 300, surface: "bust", lightName: "A", machine: "m, load 9.0", quick: true };

test("a row has medians and the ratio of theirs to ours", () => {
  const { ours, theirs, ratio, over } = rows[0];
  assert.deepEqual([ours, theirs, ratio, over], [2, 20, 10, null]);
});

test("our iteration has the first registration and the last shapes that were not kept", () => {
  const iteration = (index, registration, shape) =>
    ["light", "shading", "surface", "registration", "refinement"].map((stage) => ({
      ...{ stage, iteration: index },
      milliseconds: stage === "registration" ? registration : shape,
    }));
  const stages = [iteration(0, 90, 20), iteration(1, 1, 10), iteration(2, 1, 8), iteration(3, 0, 0.01)].flat();
  const { light, registration, step, preparation } = iterationOf({ stages, preparation: 5 });
  assert.deepEqual([preparation, light, registration, step], [5, 8, 90, 122]);
});

test("a measurement over the limit bounds the ratio from below", () => {
  const { theirs, over, ratio, theirDegrees } = rows[3];
  assert.deepEqual([theirs, over, ratio, theirDegrees], [null, 300_000, 100, null]);
});

test("the report names both sides' times, ratios and errors", () => {
  const text = besideReport(result).join("\n");
  assert.match(text, /light +64x64 +3 +2\.00 +20\.0 +10\b/);
  assert.match(text, /registration by ICP +64x64 +1 +50\.0 +5\.00 +0\.10 +0\.500 +0\.700/);
  assert.match(text, /answer +640x480 +1 +3000 +over 300 s +> 100 +0\.100/);
  assert.match(text, /64x64 +8 +theirs +6 +0\.750 +3\.00/);
});

test("the document's region has a row for each stage and both errors of an answer", () => {
  const lines = besideLines(result);
  assert.match(lines[0], /^Version .*quick selection.*load 9\.0/);
  assert.ok(lines.includes("| light | 2.00 / 20.0 | **10** | - | **-** |"), lines.join("\n"));
  assert.ok(lines.includes("| answer | 1000 / 2500 | **2.50** | 3000 / over 300 s | **> 100** |"));
  assert.ok(lines.some((line) => line.includes("0.250 and 12.000 at 64x64")));
  assert.ok(lines.some((line) => /Of 8 random scenes of 64x64, ours finds 8 .* theirs 6 /.test(line)));
});

test("a request over the limit ends the other side, and the next one begins with its scene", async () => {
  const folder = mkdtempSync(join(tmpdir(), "beside-"));
  try {
    // A stand-in for Python: it says that Open3D is missing, never answers "step" and repeats the scene for "answer".
    const program = join(folder, "stand-in.mjs");
    writeFileSync(
      program,
      `#!${process.execPath}
import { createInterface } from "node:readline";
let scene;
const say = (value) => console.log(JSON.stringify(value));
say({ missing: "No module named 'open3d'" });
createInterface({ input: process.stdin }).on("line", (line) => {
  if (line.startsWith("scene ")) say((scene = { scene: line.slice(6) }));
  if (line === "answer") say(scene);
});
`,
      { mode: 0o755 },
    );
    const side = await theirSide({ limit: 1, python: program, prepare: () => {} });
    assert.equal(side.hasOpen3d, false);
    await side.open({ path: "a.bin" });
    assert.equal(await side.step(), null);
    assert.deepEqual(await side.answer(), { scene: "a.bin" });
    side.close();
  } finally {
    rmSync(folder, { recursive: true });
  }
});
