// Extreme inputs are refused with a named error or processed, without a result that claims more than it knows.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { LONG } from "./long.mjs";
import { BimodalError, Estimator, init, outcome, pair, refused, sample } from "./support.mjs";

/** Error in degrees above which a pose with the status "converged" is confidently wrong. */
const WRONG = 3;
const SIDE = 64;
/** Side of the scenes with a search. */
const SMALL = 32;
const ENDS = ["converged", "ambiguous", "lost", "max-iterations"];
/** The smallest positive float and (nearly) the largest one. */
const [DENORMAL, LARGEST] = [1.4e-45, 3.4e38];

/** The angle between two rotations, degrees. */
function degreesBetween(a, b) {
  const trace = a.reduce((sum, value, i) => sum + value * b[i], 0);
  return (180 / Math.PI) * Math.acos(Math.min(1, Math.max(-1, (trace - 1) / 2)));
}

const isFinitePose = ({ scale, rotation, translation }) => [scale, ...rotation, ...translation].every(Number.isFinite);

/** Nothing is known, so the loop begins with a search over all poses. The search takes most of the time, so only some cases use it. */
const SEARCH = { start: "search" };

/**
 * Runs to the end, or checks that the error is named. "converged" requires a known truth and a pose near it.
 */
function run({ image, depth }, { truth, ...options } = {}) {
  let made;
  try {
    made = new Estimator(image, depth, { start: "identity", maxIterations: 12, ...options });
  } catch (error) {
    assert.ok(error instanceof BimodalError && error.field !== undefined && error.code !== "panic", String(error));
    return { refused: error.code, field: error.field };
  }
  try {
    // Slices of the search and iterations are both limited, so this loop ends.
    while (made.report.status === "running") made.step();
    const { status, pose } = made.report;
    assert.ok(ENDS.includes(status), status);
    assert.ok(isFinitePose(pose), JSON.stringify(pose));
    const off = truth && degreesBetween(pose.rotation, truth.rotation);
    if (truth && status === "converged") assert.ok(off <= WRONG, `converged ${off} degrees off`);
    if (!truth) assert.notEqual(status, "converged");
    return { status, off };
  } finally {
    made.free();
  }
}

/** A scene with a known pose and one input changed in place. */
function spoiled(change, request = {}) {
  const scene = pair({ size: SIDE, light: "window", angles: { beta: 15 }, ...request });
  const { image, depth, pose } = scene;
  change(image, depth);
  return [{ image, depth }, { truth: pose }];
}

/** The same random numbers in each run. */
function randoms(seed) {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

const inside = (mask) => [...mask.keys()].filter((i) => mask[i] !== 0);

describe("faults", () => {
  before(() => init());

  test("the scene that is spoiled here is found as it is", () => {
    const { status } = run(...spoiled(() => {}));
    assert.equal(status, "converged");
  });

  for (const [name, value] of [
    ["NaN", NaN],
    ["infinity", Infinity],
    ["minus infinity", -Infinity],
    ["the largest float", LARGEST],
    ["its negative", -LARGEST],
    ["a denormal", DENORMAL],
    ["zero", 0],
  ]) {
    test(`${name} in one of ten pixels of either view`, () => {
      const random = randoms(7);
      const [input, options] = spoiled((image, depth) => {
        for (const { data, mask } of [image, depth]) {
          for (const i of inside(mask))
            if (random() < 0.1)
              data.fill(value, i * (data.length / mask.length), (i + 1) * (data.length / mask.length));
        }
      });
      run(input, options);
    });

    test(`${name} everywhere`, LONG, () => {
      for (const side of ["image", "depth"]) {
        const [input] = spoiled((image, depth) => ({ image, depth })[side].data.fill(value));
        run(input);
      }
    });
  }

  test("colours a hundred orders of magnitude apart, all of them denormal, or all of them as large as can be", () => {
    for (const factor of [1e-40, 1e-30, 1e30]) {
      const [input, options] = spoiled((image) => image.data.forEach((value, i) => (image.data[i] = value * factor)));
      run(input, options);
    }
    const random = randoms(3);
    const [input, options] = spoiled((image) =>
      image.data.forEach((value, i) => (image.data[i] = value * 10 ** (60 * random() - 30))),
    );
    run(input, options);
  });

  test("depths all denormal, or all as large as can be", LONG, () => {
    for (const factor of [1e-42, 1e9, 1e30]) {
      const [input] = spoiled((_, depth) => depth.data.forEach((value, i) => (depth.data[i] = value * factor)));
      run(input);
    }
  });

  test("objects of one pixel, two, a row and a column", () => {
    const masks = [
      [500],
      [500, 501],
      Array.from({ length: SIDE }, (_, i) => 15 * SIDE + i),
      Array.from({ length: SIDE }, (_, i) => 15 + SIDE * i),
    ];
    for (const pixels of masks) {
      for (const side of ["image", "depth"]) {
        const [input] = spoiled((image, depth) => {
          const { mask } = { image, depth }[side];
          mask.fill(0);
          for (const pixel of pixels) mask[pixel] = 1;
        });
        run(input);
      }
    }
  });

  test("views that show nothing in common", LONG, () => {
    // Two different objects: neither view shows anything of the other.
    const front = pair({ size: SMALL, light: "window" });
    const back = pair({ size: SMALL, light: "window", surface: "ripples", seed: 5 });
    run({ image: front.image, depth: back.depth }, SEARCH);
    run({ image: back.image, depth: front.depth });
  });

  test("a sphere, whose turns no view can tell, and a plane", LONG, () => {
    const middle = 31.5;
    const ball = Float32Array.from({ length: 64 * 64 }, (_, i) => {
      const squared = 28 ** 2 - ((i % 64) - middle) ** 2 - (Math.floor(i / 64) - middle) ** 2;
      return squared > 0 ? Math.sqrt(squared) : NaN;
    });
    const round = sample({ surface: { width: 64, height: 64, heights: ball }, light: "window", size: SMALL });
    run({ image: round.image, depth: round.depth }, SEARCH);
    // The image is of one colour, and the depth map is a plane.
    const count = SIDE * SIDE;
    const flat = {
      image: { width: SIDE, height: SIDE, data: new Float32Array(3 * count).fill(0.5) },
      depth: { width: SIDE, height: SIDE, data: new Float32Array(count).fill(100) },
    };
    run(flat);
    const tilted = {
      ...flat,
      depth: { ...flat.depth, data: Float32Array.from({ length: count }, (_, i) => 100 + 0.5 * (i % SIDE)) },
    };
    run(tilted);
  });

  test("duplicated points: a cloud of one point, and one whose points come in fours", () => {
    const {
      depth: { width, height, mask, data },
    } = pair({ size: SIDE });
    const { image } = pair({ size: SIDE, light: "window" });
    const same = new Float32Array(3 * width * height);
    for (let i = 0; i < width * height; i++) same.set([10, 20, 30], 3 * i);
    run({ image, depth: { width, height, mask, points: same } });
    const four = new Float32Array(3 * width * height).fill(NaN);
    for (let i = 0; i < width * height; i++) {
      const [column, row] = [2 * Math.floor((i % width) / 2), 2 * Math.floor(Math.floor(i / width) / 2)];
      const from = row * width + column;
      if (mask[from]) four.set([column, row, data[from]], 3 * i);
    }
    run({ image, depth: { width, height, mask, points: four } });
  });

  test("saturated colours, black ones, and a light that does not vary", LONG, () => {
    const count = SIDE * SIDE;
    for (const level of [255, 0, 1]) {
      const [{ depth, image }] = spoiled(() => {});
      run({
        image: { width: SIDE, height: SIDE, mask: image.mask, data: new Uint8Array(4 * count).fill(level) },
        depth,
      });
    }
    const [{ depth, image }] = spoiled(() => {});
    run({ image: { ...image, data: new Float32Array(3 * count).fill(0.25) }, depth });
    // Half of the object saturates the camera.
    const [clipped, options] = spoiled(({ data }) => {
      const middle = [...data].filter((value) => value > 0).sort((a, b) => a - b);
      const most = middle[Math.floor(middle.length / 2)];
      data.forEach((value, i) => (data[i] = Math.min(value, most)));
    });
    run(clipped, options);
  });

  test("a light of zeros, and one of the largest numbers that are taken", () => {
    const [input] = spoiled(() => {});
    for (const value of [0, 1e-300, 100]) run(input, { light: new Array(27).fill(value) });
  });

  test("19 of 20 depths are holes", () => {
    const random = randoms(11);
    const [input, options] = spoiled((_, { data }) => data.forEach((_, i) => random() < 0.95 && (data[i] = NaN)));
    run(input, options);
    const [blocks, same] = spoiled((_, { data }) => data.fill(NaN, 0, Math.floor(0.6 * data.length)));
    run(blocks, same);
  });

  test("4096 x 4096 pixels are refused by name, or worked on at the depth map's resolution", LONG, () => {
    const [width, height] = [4096, 4096];
    const { depth } = pair({ size: 32, light: "window" });
    const large = { width, height, data: new Uint8Array(4 * width * height).fill(90) };
    refused(
      () =>
        new Estimator(
          { width: 32, height: 32, data: new Float32Array(3 * 1024).fill(0.5) },
          { width, height, data: new Float32Array(width * height).fill(2) },
        ),
      "memory",
      "depth",
    );
    refused(
      () => new Estimator({ width: 4097, height, data: new Uint8Array(4 * 4097 * height) }, depth),
      "size",
      "image",
    );
    run({ image: large, depth });
  });

  test("two estimators whose steps take turns give the bits that each gives alone", () => {
    const scenes = [
      pair({ size: 32, light: "window" }),
      pair({ size: 40, surface: "vase", light: "window", angles: { beta: 20 } }),
    ];
    const make = ({ image, depth }) =>
      new Estimator(image, depth, { start: { angles: { beta: 10 } }, maxIterations: 6 });
    const isRunning = (made) => made.report.status === "running";
    const alone = scenes.map((scene) => {
      const made = make(scene);
      while (isRunning(made)) made.step();
      const result = outcome(made);
      made.free();
      return result;
    });
    const together = scenes.map(make);
    while (together.some(isRunning)) for (const made of together) if (isRunning(made)) made.step();
    assert.deepEqual(together.map(outcome), alone);
    for (const made of together) made.free();
  });
});
