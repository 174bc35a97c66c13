// Unorganised LiDAR clouds become range images: simulated scanners in a simulated room, with known rays.
import assert from "node:assert/strict";
import { test } from "node:test";
import { rangeImage } from "../../pkg/rig.js";
import { measured } from "../../scripts/lidar/measures.mjs";
import { OPTICAL, VIEW, accumulated, rosette, shuffled, spinning, turned } from "./scanners.mjs";

/** Aims: a point lies within half the sampling of its pixel's ray, and nearly all points in view are kept. */
function holds(found, name) {
  assert.ok(found.kept >= 0.99, `${name}: ${(100 * found.kept).toFixed(2)} % of ${found.count} points are kept`);
  assert.ok(
    found.ofSampling <= 0.5,
    `${name}: points lie ${found.ofSampling.toFixed(2)} of the sampling from their rays`,
  );
}

for (const lasers of [16, 32, 64])
  test(`${lasers} rings are the rows of a range image, by the file's rings or without them`, async () => {
    const scan = spinning({ lasers });
    const mixed = shuffled(scan);
    const { points } = scan;
    for (const [how, given] of [
      ["ring", mixed],
      ["order", { points }],
      ["elevation", { points: mixed.points }],
    ]) {
      const image = await rangeImage(given, VIEW);
      assert.equal(image.how, how);
      const whole = await rangeImage(given);
      assert.equal(whole.height, lasers, how);
      assert.ok(Math.abs(whole.width / 1800 - 1) < 0.05, `${how}: ${whole.width} columns`);
      holds(measured(given, VIEW, image), how);
    }
  });

test("lasers above each other and a coarse clock cost neither rows nor points", async () => {
  const scan = spinning({ lasers: 64, offset: 0.2, tick: 0.09, step: 0.1728 });
  const image = await rangeImage({ points: scan.points }, VIEW);
  assert.equal(image.how, "order");
  const found = measured(scan, VIEW, image);
  holds(found, "64 lasers in two blocks");
  // The two blocks of lasers are 0.1 m apart in height. A row's elevation therefore differs by about a degree, twice the spacing of rows,
  // between points at 3 and at 9 m.
  assert.ok(found.ofColumn < 0.5, `${found.ofColumn}`);
});

test("a scan turned to a camera's axes, or tilted, keeps its rows", async () => {
  const scan = turned(shuffled(spinning({ lasers: 32 })), OPTICAL);
  const view = { ...VIEW, rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1] };
  for (const given of [scan, { points: scan.points }]) {
    const image = await rangeImage(given, view);
    assert.equal(image.how, given.ring ? "ring" : "elevation");
    holds(measured(given, view, image), image.how);
  }
  const [sine, cosine] = [Math.sin(0.2), Math.cos(0.2)];
  const tilted = spinning({ lasers: 32 });
  for (let at = 0; at < tilted.points.length; at += 3) {
    const [x, , z] = tilted.points.subarray(at, at + 3);
    tilted.points[at] = cosine * x + sine * z;
    tilted.points[at + 2] = cosine * z - sine * x;
  }
  const image = await rangeImage(tilted, VIEW);
  assert.equal(image.how, "ring");
  holds(measured(tilted, VIEW, image), "tilted");
});

test("neighbours of a range image are neighbours in the room", async () => {
  const image = await rangeImage({ points: spinning({ lasers: 64 }).points }, VIEW);
  let [jumps, pairs] = [0, 0];
  for (let pixel = 0; pixel < image.width * image.height - 1; pixel++) {
    if (pixel % image.width === image.width - 1) continue;
    const [a, b] = [
      image.points.subarray(3 * pixel, 3 * pixel + 3),
      image.points.subarray(3 * pixel + 3, 3 * pixel + 6),
    ];
    if (Number.isNaN(a[0]) || Number.isNaN(b[0])) continue;
    // From left to right, the scanner's y falls.
    assert.ok(Math.atan2(a[1], a[0]) > Math.atan2(b[1], b[0]) - 1e-6);
    pairs++;
    if (Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > 0.3) jumps++;
  }
  assert.ok(jumps < 0.02 * pairs, `${jumps} of ${pairs} neighbours are far apart`);
});

test("a rosette and sweeps from several places fill a z-buffer at their own density", async () => {
  for (const [name, scan] of [
    ["rosette", rosette({ count: 30_000 })],
    ["accumulated", accumulated()],
  ]) {
    const image = await rangeImage(scan, VIEW);
    assert.equal(image.how, "sphere", name);
    const found = measured(scan, VIEW, image);
    holds({ ...found, kept: found.stood }, name);
    // The rosette is a circle, which covers four fifths of its bounding square.
    assert.ok(found.filled > 0.3, `${name}: ${found.filled}`);
  }
});

test("what the camera cannot see is left out, and points without measurements are none", async () => {
  const scan = spinning({ lasers: 16 });
  const image = await rangeImage(scan, VIEW);
  for (let at = 0; at < image.points.length; at += 3)
    if (!Number.isNaN(image.points[at])) assert.ok(image.points[at] > 0);
  assert.equal(await rangeImage({ points: new Float32Array(3000) }), undefined);
  const holed = { points: scan.points.map((value, at) => (at % 30 < 3 ? 0 : value)), ring: scan.ring };
  assert.equal((await rangeImage(holed)).height, 16);
});
