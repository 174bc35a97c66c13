// The rows of js/options.ts agree with the numerics: both refuse the same values and have the same defaults.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, describe, test } from "node:test";
import { OPTIONS, SAMPLE, paths } from "../../pkg/options.js";
import * as numerics from "../../target/wasm-bindgen/bimodal_stereo.js";
import { Estimator, init, outcome, pair, sample } from "./support.mjs";

const REQUEST = { surface: "bust", light: "window", size: 32 };

/** An object with this value at this path, such as { lambda: { prior: 1 } } for "options.lambda.prior". */
const holding = (path, value) =>
  path
    .split(".")
    .slice(1)
    .reduceRight((inner, name) => ({ [name]: inner }), value);

const bits = new DataView(new ArrayBuffer(8));
/** The floating-point number next to x towards plus infinity (`by` = 1) or minus infinity (-1). */
function neighbour(x, by) {
  if (x === 0) return by * Number.MIN_VALUE;
  bits.setFloat64(0, x);
  bits.setBigInt64(0, bits.getBigInt64(0) + BigInt(x > 0 ? by : -by));
  return bits.getFloat64(0);
}

/** Numbers at the ends of a row's range, each with whether it is inside. */
function ends({ kind, min, above, max, below }) {
  const beside = (x, by) => (kind === "number" ? neighbour(x, by) : x + by);
  return [
    ...(min === undefined
      ? []
      : [
          [min, true],
          [beside(min, -1), false],
        ]),
    ...(above === undefined
      ? []
      : [
          [above, false],
          [beside(above, 1), true],
        ]),
    ...(max === undefined
      ? []
      : [
          [max, true],
          [beside(max, 1), false],
        ]),
    ...(below === undefined
      ? []
      : [
          [below, false],
          [beside(below, -1), true],
        ]),
    ...(max === undefined && below === undefined ? [[Number.MAX_VALUE, true]] : []),
    ...[NaN, Infinity, -Infinity].map((x) => [x, false]),
  ];
}

/** Every row of both tables, by the path of its member. */
const ROWS = new Map([...paths(OPTIONS, "options"), ...paths(SAMPLE, "sample")]);
const NUMBERS = [...ROWS].filter(([, { kind }]) => ["number", "whole", "side"].includes(kind));

/** Members that the facade converts: the numerics get the rotation of the angles, a seed of 64 bits, and no threads. */
const FACADE_ALONE = /\.(angles\.\w+|workers|seed)$/;
/** In the numerics, height and width are one member. */
const NATIVE_FIELD = { "sample.height": "sample.size" };

/** The code of a call's error, or undefined; errors about other fields, such as too large a view, do not count. */
function refusal(field, call) {
  try {
    call()?.free?.();
  } catch (error) {
    return error.field === field ? error.code : undefined;
  }
  return undefined;
}

before(async () => {
  await init();
  numerics.initSync({ module: readFileSync(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)) });
});

describe("ranges", () => {
  for (const [path, row] of NUMBERS) {
    test(path, () => {
      const { image, depth } = sample(REQUEST);
      const call =
        ({ Estimator, sample }, value) =>
        () =>
          path.startsWith("options")
            ? new Estimator(image, depth, holding(path, value))
            : sample({ ...REQUEST, ...holding(path, value) });
      const native = NATIVE_FIELD[path] ?? path;
      for (const [value, inside] of ends(row)) {
        const code = refusal(path, call({ Estimator, sample }, value));
        assert.equal(code === undefined, inside, `${value}`);
        if (FACADE_ALONE.test(path)) continue;
        const nativeCode = refusal(native, call(numerics, value));
        assert.equal(nativeCode === undefined, inside, `${value}, without the facade`);
        // Only the facade distinguishes NaN and fractions from numbers out of range.
        if (Number.isFinite(value)) assert.equal(code, nativeCode, `${value}`);
      }
    });
  }

  test("a message names what is allowed", () => {
    const { image, depth } = sample(REQUEST);
    const estimator = (options) => () => new Estimator(image, depth, options);
    for (const [call, message] of [
      [estimator({ workers: 17 }), "options.workers: must be a whole number from 1 to 16 (got 17)"],
      [estimator({ scale: 0 }), "options.scale: must be a finite number above zero (got 0)"],
      [estimator({ stopDegrees: 0 }), "options.stopDegrees: must be a finite number above zero (got 0)"],
      [estimator({ maxIterations: 0 }), "options.maxIterations: must be a whole number from 1 to 100000 (got 0)"],
      [
        estimator({ lambda: { prior: -1 } }),
        "options.lambda.prior: must be a finite number, zero or above, at most 1000000 (got -1)",
      ],
      [
        estimator({ start: { angles: { beta: 500 } } }),
        "options.start.angles.beta: must be a number from -360 to 360 deg (got 500)",
      ],
      [() => sample({ ...REQUEST, holes: 1 }), "sample.holes: must be a finite number, zero or above, below 1 (got 1)"],
      [
        () => sample({ ...REQUEST, overlap: 2 }),
        "sample.overlap: must be a finite number above zero, at most 1 (got 2)",
      ],
      [() => sample({ ...REQUEST, size: 8 }), "sample.size: must be a whole number from 16 to 1024 px (got 8)"],
    ]) {
      assert.throws(call, { message });
    }
  });
});

/** Noise, an unknown light and outlying depths, so that most options have an effect. */
function noisy(base = { start: "identity" }, size = 40) {
  const { image, depth } = pair({
    size,
    light: "window",
    angles: { beta: 8 },
    noise: 0.02,
    depthNoise: 0.1,
    holes: 0.05,
  });
  depth.data.forEach((z, index) => (depth.data[index] = index % 41 === 0 ? z + 6 : z));
  return { image, depth, base };
}

/** A pose that keeps changing slightly, so that the loop's settings end it. */
function slow(base = {}) {
  const { image, depth, light } = pair({ angles: { beta: 8 } });
  return {
    image,
    depth,
    base: { light, scale: 1, start: "identity", registration: "icp", shading: "pixel", lambda: { prior: 0 }, ...base },
  };
}

const turned = { given: () => noisy({ start: { angles: {} } }) };
/** For options whose effect the noisy pair does not show, another run or another value that shows it. */
const SHOWN = {
  "options.light": { other: new Array(27).fill(0.1) },
  "options.start": { given: () => noisy({}), steps: 1, other: "identity" },
  "options.start.angles.alpha": turned,
  "options.start.angles.beta": turned,
  "options.start.angles.gamma": turned,
  // The noisy pair is 8 degrees from its initial pose.
  "options.startTolerance.degrees": { given: () => noisy({ start: { angles: {} } }), other: 0.01 },
  "options.scale": { other: 1.1 },
  "options.stopDegrees": { given: slow, other: 0.02 },
  "options.tolerance": { given: sure, other: 1e-6 },
  "options.maxIterations": { given: () => slow({ stopDegrees: 1e-300 }), other: 61 },
  "options.seed": { given: () => noisy({}, 24), other: 2 },
};

/** Another value of the row's kind. */
function another({ kind, words, max = Infinity, default: value }) {
  if (kind === "flag") return !value;
  if (kind === "word") return Object.keys(words).find((word) => word !== value);
  return value === 0 ? 0.25 : 2 * value > max ? value / 2 : 2 * value;
}

describe("defaults", () => {
  for (const [path, row] of ROWS) {
    // Additional threads do not change the result: tests/contract/search-workers.test.mjs.
    if (row.default === undefined || path === "options.workers") continue;
    const { given = noisy, steps, other = another(row) } = SHOWN[path] ?? {};
    test(path, async () => {
      const made = path.startsWith("options") ? loops(given(), steps, path) : samples(path);
      const absent = await made(undefined);
      assert.deepEqual(await made(row.default), absent);
      assert.notDeepEqual(await made(other), absent);
    });
  }

  test("where no angles are given, beta is what the page starts with", () => {
    const { initial } = SAMPLE.angles.members.beta.page;
    assert.deepEqual(sample({ ...REQUEST, angles: { beta: initial } }), sample(REQUEST));
    assert.notDeepEqual(sample({ ...REQUEST, angles: {} }), sample(REQUEST));
  });
});

/** A run whose pose converges. */
function sure() {
  const { image, depth } = pair({ size: 40, light: "window", angles: { beta: 8 } });
  return { image, depth, base: { start: "identity" } };
}

/** The result of a loop in which the option has a value. */
const loops =
  ({ image, depth, base }, steps, path) =>
  async (value) => {
    const estimator = new Estimator(image, depth, { ...base, ...holding(path, value) });
    await estimator.run({ maxIterations: steps });
    const end = outcome(estimator);
    estimator.free();
    return end;
  };

/** The sample for a value of the request's member; noise and holes make the seed matter. */
const samples = (path) => (value) => {
  const flaws = path === "sample.protocol" ? {} : { noise: 0.01, holes: 0.1 };
  return sample({ surface: "bust", light: "window", ...flaws, ...holding(path, value) });
};
