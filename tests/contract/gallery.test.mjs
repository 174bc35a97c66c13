// The gallery: each rendered pair ends as its card says, with the options of the page. The suggestion of masks for the page's tool is
// tested here, too.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import init, { Estimator, samplePair, suggestMask } from "../../pkg/index.js";
import { GALLERY } from "../../protocols/gallery.mjs";
import { middleOf, moved } from "../../protocols/perspective.mjs";
import { aboutAxis, degreesBetween, product } from "../../protocols/rotations.mjs";
import { LONG } from "./long.mjs";
import { BimodalError } from "./support.mjs";

/** How a pair ends, in the units of its card. */
async function endOf(kind) {
  const { image, depth, pose } = await samplePair(kind);
  const estimator = new Estimator(image, depth);
  await estimator.run();
  const { status, pose: found } = estimator.report;
  estimator.free();
  return {
    status,
    degrees: degreesBetween(found.rotation, pose.rotation),
    millimetres: 1000 * Math.hypot(...found.translation.map((value, k) => value - pose.translation[k])),
  };
}

/** Cards state two digits; builds with and without SIMD differ in the third. */
const SLACK = 0.1;

function isAsSaid({ status, degrees, millimetres }, { kind, ends }) {
  const found = `${kind}: ${status}, ${degrees.toFixed(2)} degrees, ${millimetres.toFixed(1)} mm`;
  assert.equal(status, ends.status, found);
  assert.ok(Math.abs(degrees - ends.degrees) <= Math.max(0.1, SLACK * ends.degrees), found);
  assert.ok(Math.abs(millimetres - ends.millimetres) <= Math.max(1, SLACK * ends.millimetres), found);
}

describe("the gallery", () => {
  before(() => init());

  test("an easy pair ends as its card says", async () => {
    const card = GALLERY.find(({ kind }) => kind === "knot");
    isAsSaid(await endOf("knot"), card);
  });

  for (const card of GALLERY)
    test(`${card.name} ends as its card says`, LONG, async () => isAsSaid(await endOf(card.kind), card));

  test(
    "a bowl whose colours fit better elsewhere is placed by its silhouette, from an inaccurate pose",
    LONG,
    async () => {
      const { image, depth, pose } = await samplePair("bowl");
      const middle = middleOf(depth);
      const rotation = product(pose.rotation, aboutAxis([0, 0.6, 0.8], 3));
      const start = {
        scale: 1,
        rotation,
        translation: [0, 1, 2].map((k) => pose.translation[k] + [0.015, -0.01, 0.008][k]),
      };
      const estimator = new Estimator(image, depth, { start });
      await estimator.run();
      const found = estimator.report.pose;
      estimator.free();
      const across = (end) => {
        const [there, here] = [moved(end, middle), moved(pose, middle)];
        return 1000 * Math.hypot(there[0] - here[0], there[1] - here[1]);
      };
      assert.ok(across(start) > 30, `${across(start)} mm`);
      assert.ok(across(found) < 15, `${across(found)} mm`);
    },
  );

  test("levels are those of the ends: what converges is near the truth, and what fails is far off and not converged", () => {
    for (const { kind, level, ends } of GALLERY) {
      if (level === "easy") assert.ok(ends.status === "converged" && ends.degrees < 3, kind);
      if (level === "hard" || level === "fails") assert.ok(ends.status !== "converged" && ends.degrees > 5, kind);
    }
    assert.ok(GALLERY.some(({ level }) => level === "fails"));
    assert.equal(new Set(GALLERY.map(({ kind }) => kind)).size, 6);
  });

  test("a pair has masks, cameras, metric depth and a pose; an unknown kind is refused", async () => {
    const { image, depth, pose } = await samplePair("bowl");
    assert.equal(image.data.length, 4 * image.width * image.height);
    assert.equal(image.mask.length, image.width * image.height);
    assert.equal(depth.mask.length, depth.data.length);
    assert.ok(depth.data instanceof Uint16Array && depth.unit === 0.001 && depth.camera.fx > 0);
    assert.equal(pose.scale, 1);
    await assert.rejects(samplePair("dog"), (error) => error instanceof BimodalError && error.field === "kind");
  });
});

describe("a suggested mask", () => {
  const [width, height] = [90, 60];
  const isInside = (index) => Math.hypot((index % width) - 44.5, Math.floor(index / width) - 29.5) < 20;
  const image = {
    width,
    height,
    data: Uint8ClampedArray.from({ length: 4 * width * height }, (_, at) => {
      const index = Math.floor(at / 4);
      const grain = ((index * 7919) % 31) - 15;
      return at % 4 === 3 ? 255 : grain + (isInside(index) ? [180, 90, 60] : [70, 110, 140])[at % 4];
    }),
  };
  const marks = Uint8Array.from({ length: width * height }, (_, index) => {
    const [column, row] = [index % width, Math.floor(index / width)];
    return column > 15 && column < 74 && row > 4 && row < 55 ? 3 : 0;
  });

  test("from a rectangle it is the object, and each round is reported", async () => {
    const rounds = [];
    const {
      mask,
      share,
      changed: last,
      rounds: count,
    } = await suggestMask(image, marks, {
      onProgress: (changed, round) => rounds.push([round, changed]),
    });
    const [both, either] = [0, 0].map((_, k) =>
      mask.reduce((sum, value, index) => {
        const [a, b] = [value > 0, isInside(index)];
        return sum + Number(k === 0 ? a && b : a || b);
      }, 0),
    );
    assert.ok(both / either > 0.97, `${both} of ${either}`);
    assert.ok(last < 0.001 && Math.abs(share - both / mask.length) < 0.02);
    assert.deepEqual(
      rounds.map(([round]) => round),
      Array.from({ length: count }, (_, k) => k + 1),
    );
  });

  test("it can be aborted before and between rounds", async () => {
    const aborted = { name: "AbortError" };
    await assert.rejects(suggestMask(image, marks, { signal: AbortSignal.abort() }), aborted);
    const ending = new AbortController();
    await assert.rejects(
      suggestMask(image, marks, { signal: ending.signal, onProgress: () => ending.abort() }),
      aborted,
    );
  });

  test("what it cannot use is refused with its field", async () => {
    const refused = async (field, ...given) =>
      assert.rejects(suggestMask(...given), (error) => error instanceof BimodalError && error.field === field);
    await refused("marks", image, marks.subarray(1));
    await refused("marks", image, new Uint8Array(marks.length));
    await refused("marks", image, [...marks]);
    await refused("image.data", { ...image, width: 91 }, new Uint8Array(91 * 60));
    await refused("image.width", { ...image, width: -1 }, marks);
    await refused("options.signal", image, marks, { signal: 1 });
  });
});
