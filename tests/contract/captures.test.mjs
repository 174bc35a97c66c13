// The parts of npm run captures, on rendered rigs with known extrinsics: lenses, hidden truths and the costs of other methods.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { projectFrame, sampleRig } from "../../pkg/index.js";
import { costs, shading } from "../../scripts/captures/costs.mjs";
import { project, ray } from "../../scripts/captures/lens.mjs";
import { checkFrame, hide, rigSight } from "../../scripts/captures/read.mjs";
import { after, chance, inverse, mahalanobis, moved, offset, poseOf, sizes, wrong } from "../../scripts/rigs/draws.mjs";
import { IDENTITY } from "../../protocols/rotations.mjs";
import { LONG } from "./long.mjs";

const NOWHERE = poseOf(IDENTITY, [0, 0, 0]);

test("a lens's ray and projection undo each other", () => {
  const camera = { fx: 519, fy: 520, cx: 325, cy: 253, distortion: [0.21, -0.59, 0.0007, 0.001, 0.5] };
  for (const pixel of [
    [325, 253],
    [20, 30],
    [600, 460],
  ]) {
    const [x, y] = ray(camera, pixel);
    project(camera, [2 * x, 2 * y, 2]).forEach((value, k) =>
      assert.ok(Math.abs(value - pixel[k]) < 1e-3, `${pixel}: ${value}`),
    );
  }
});

test("errors are as large as they are told to be", () => {
  const { direction } = chance(1);
  const pose = wrong(NOWHERE, { degrees: 40, millimetres: 300 }, direction);
  const centre = [0.1, -0.2, 1.5];
  const off = wrong(pose, { degrees: 3, millimetres: 20 }, direction, centre);
  const { degrees, millimetres } = sizes(offset(pose, off, centre));
  assert.ok(Math.abs(degrees - 3) < 1e-9 && Math.abs(millimetres - 20) < 1e-9, `${degrees}, ${millimetres}`);
  assert.ok(sizes(offset(after(pose, inverse(pose)), NOWHERE, centre)).millimetres < 1e-9);
  const diagonal = [1, 2, 3, 4, 5, 6].flatMap((value, k) => Object.assign(Array(6).fill(0), { [k]: value }));
  assert.ok(Math.abs(mahalanobis(diagonal, [1, 2, 3, 4, 5, 6]) - 21) < 1e-9);
});

describe("a rig before boxes", () => {
  let frame, behind, motion;
  before(async () => {
    const sample = await sampleRig({ kind: "boxes", seed: 2 });
    frame = rigSight(sample, sample.pose);
    motion = wrong(NOWHERE, { degrees: 10, millimetres: 100 }, chance(3).direction);
    behind = hide(frame, motion);
  });

  test("hiding the truth moves no pixel, and the package's points fall where ours do", async () => {
    const [{ points }, hidden] = [
      await projectFrame(checkFrame(frame), frame.truth),
      await projectFrame(checkFrame(behind), behind.truth),
    ];
    assert.ok(Math.abs(points.length - hidden.points.length) < 0.001 * points.length);
    const known = [];
    for (let at = 0; at < frame.points.length; at += 3) {
      const p = moved(frame.truth, [...frame.points.subarray(at, at + 3)]);
      if (p[2] > 0) known.push([...project(frame.image.camera, p), p[2]].map((value) => value.toFixed(1)).join());
    }
    const ours = new Set(known);
    let same = 0;
    for (let at = 0; at < points.length; at += 3)
      same += ours.has([...points.subarray(at, at + 3)].map((value) => value.toFixed(1)).join());
    assert.ok(same > 0.9 * (points.length / 3), `${same} of ${points.length / 3}`);
  });

  const rivalsOf = (truth, count) => {
    const { direction } = chance(4);
    return Array.from({ length: count }, () => wrong(truth, { degrees: 5, millimetres: 60 }, direction));
  };

  test("edge alignment costs least at the truth, wherever it is hidden", () => {
    const { edges, near } = costs(behind, motion);
    for (const rival of rivalsOf(behind.truth, 4)) assert.ok(edges(rival) > edges(behind.truth));
    assert.ok(near(behind.truth) > 0.4, String(near(behind.truth)));
  });

  test(
    "information distance is least at the truth where the image is what the depth camera's lamp would show",
    LONG,
    () => {
      const { image, grid, points, truth } = frame;
      const lit = shading(points, grid, [0, 0, 0]);
      const data = new Uint8ClampedArray(image.data.length);
      for (let index = 0; index < lit.length; index++) {
        const p = moved(truth, [...points.subarray(3 * index, 3 * index + 3)]);
        if (!(p[2] > 0) || Number.isNaN(lit[index])) continue;
        const [column, row] = project(image.camera, p).map(Math.round);
        if (column >= 0 && row >= 0 && column < image.width && row < image.height)
          data.fill(255 * lit[index], 4 * (row * image.width + column), 4 * (row * image.width + column) + 3);
      }
      const { information } = costs({ ...frame, image: { ...image, data } }, NOWHERE);
      const best = information(truth);
      assert.ok(best < 0.9, String(best));
      for (const rival of rivalsOf(truth, 3))
        assert.ok(information(rival) > best + 0.02, `${information(rival)} and ${best}`);
    },
  );
});
