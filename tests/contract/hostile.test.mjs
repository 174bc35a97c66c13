// Every export with hostile arguments: no call aborts the numerics, exhausts memory, or changes other state.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import * as files from "../../pkg/files.js";
import * as package_ from "../../pkg/index.js";
import * as rig from "../../pkg/rig.js";
import * as recordings from "../../pkg/rig-recordings.js";
import * as rigWrite from "../../pkg/rig-write.js";
import * as write from "../../pkg/write.js";
import { LIGHT, POSE } from "../../scripts/reference/run-written.mjs";
import { report } from "./rig-sample.mjs";
import { BimodalError, Estimator, estimator, init, outcome, pair } from "./support.mjs";
import { LONG } from "./long.mjs";

const MODULES = { index: package_, files, rig, "rig-recordings": recordings, "rig-write": rigWrite, write };
/** Exports with side effects: `init` loads, classes need `new`, `connectRobot` uses the network. */
const APART = new Set(["default", "BimodalError", "Estimator", "connectRobot"]);

const circle = {};
circle.self = circle;
/** A value that throws on any access. */
const trap = new Proxy(
  {},
  {
    get: () => {
      throw new Error("a getter that throws");
    },
    ownKeys: () => {
      throw new Error("keys that throw");
    },
  },
);
const HOSTILE = {
  nothing: undefined,
  null: null,
  NaN: NaN,
  infinity: -Infinity,
  zero: 0,
  huge: 1e308,
  "a large whole number": 2 ** 53,
  bigint: 10n,
  true: true,
  "an empty word": "",
  "a word": "__proto__",
  markup: "<img src=x onerror=alert(1)>",
  symbol: Symbol("s"),
  "an empty object": {},
  "an empty list": [],
  "a list of nothing": new Array(27),
  "a function": () => NaN,
  "a date": new Date(NaN),
  "a map": new Map([["width", 4]]),
  circle,
  "no bytes": new Uint8Array(0),
  "random bytes": Uint8Array.from({ length: 999 }, (_, i) => (i * 7919) % 251),
  "floats that are none": new Float32Array(27).fill(NaN),
  doubles: new Float64Array(27).fill(Infinity),
  "a length without an end": { length: 2 ** 32 },
  "sizes without data": { width: 4096, height: 4096 },
  "sizes that overflow": { width: 2 ** 32 + 1, height: 2 ** 31, data: new Uint8Array(4) },
  "a view on nothing": new DataView(new ArrayBuffer(0)),
};
const NAMES = Object.keys(HOSTILE);
/** Arguments: one hostile value in one position, in all positions, and in two neighbouring ones. */
function* given(count) {
  for (const [index, name] of NAMES.entries()) {
    yield [name, Array(count).fill(HOSTILE[name])];
    for (let place = 0; place < count; place++)
      yield [`${name}, ${place}`, Array.from({ length: count }, (_, i) => (i === place ? HOSTILE[name] : {}))];
    yield [`${name} and the next`, Array.from({ length: count }, (_, i) => HOSTILE[NAMES[(index + i) % NAMES.length]])];
  }
}

const PICTURES = [{ title: "a", dataUrl: "data:image/png;base64,AAAA" }];
const BESIDE = { title: "a", made: new Date(0), inputs: [{ name: "a", says: "b", sha256: "c" }] };
const OVERLAY = { frame: "a", width: 8, height: 6, picture: PICTURES[0].dataUrl, before: [1, 2], after: [3, 4] };
/** The texts of a report of a check. */
const CHECKED = {
  ...BESIDE,
  inputs: [{ ...BESIDE.inputs[0], bytes: 5, notes: ["a"] }],
  isEstimate: false,
  calibrations: { "factory.yaml": report().estimate },
  overlays: [OVERLAY],
  shell: { command: "a", note: "b" },
  settings: [["a", "b"]],
  versions: [["a", "b"]],
};
const CAMERA = { model: "brown", fx: 9, fy: 9, cx: 0, cy: 0, distortion: [1, 2, 3, 4] };
const CONTEXT = {
  colour: CAMERA,
  depth: CAMERA,
  sizes: { colour: [8, 6], depth: [8, 6] },
  frames: { colour: "a", depth: "b" },
};
const RUN = {
  ...BESIDE,
  tone: "good",
  status: "a",
  words: ["a"],
  pose: POSE,
  truth: POSE,
  unit: "m",
  light: LIGHT,
  numbers: [["a", "b"]],
  options: [["a", "b"]],
  pictures: PICTURES,
  link: "a",
};
const SIGMAS = { rotationDegrees: [1, 2, 3], translation: [1, 2, null], scale: null, weakest: "a" };
const levels = (data, channels = 1) => ({ width: 1, height: 1, channels, data });
/** Writers with their arguments. */
const WRITERS = {
  reportHtml: [rigWrite.reportHtml, report(), PICTURES, CHECKED],
  runReportHtml: [write.runReportHtml, RUN],
  poseJson: [write.poseJson, POSE, "m", { status: "a", message: "b", uncertainty: SIGMAS }],
  matrixText: [write.matrixText, POSE],
  lightCsv: [write.lightCsv, [...LIGHT]],
  writeNpy: [write.writeNpy, levels(new Float64Array(1))],
  writePng: [write.writePng, levels(new Uint16Array(3), 3), { Unit: "a" }],
  depthPng: [write.depthPng, levels(new Float32Array(1)), "px"],
  normalsPng: [write.normalsPng, levels(new Float32Array(3))],
  writeClouds: [
    write.writeClouds,
    [{ points: new Float32Array(3), colours: new Uint8Array(3), name: "a" }, { points: new Float32Array(3) }],
    "metres",
  ],
  ...Object.fromEntries(
    rigWrite.poseFormats.map((format) => [
      `writePose as ${format}`,
      [rigWrite.writePose, { ...POSE, scale: 1 }, format, CONTEXT],
    ]),
  ),
};
/** Copies of a value with one member, at any depth, replaced by each hostile value. */
function* changes(value, path = "") {
  if (Object(value) !== value || !(Array.isArray(value) || Object.getPrototypeOf(value) === Object.prototype)) return;
  for (const key of Object.keys(value).slice(0, 12)) {
    const inside = [
      ...NAMES.map((name) => [`${path}.${key}: ${name}`, HOSTILE[name]]),
      ...changes(value[key], `${path}.${key}`),
    ];
    for (const [words, member] of inside) {
      const copy = Array.isArray(value) ? [...value] : { ...value };
      copy[key] = member;
      yield [words, copy];
    }
  }
}

/** Checks the outcome of a call: a result, or an error that names the problem and is not an abort. */
async function tried(what, call) {
  try {
    const answer = await call();
    if (answer instanceof Estimator) answer.free();
  } catch (error) {
    assert.ok(
      !(error instanceof WebAssembly.RuntimeError) && !["panic", "poisoned"].includes(error?.code),
      `${what} broke the numerics off: ${error?.stack}`,
    );
    assert.ok(
      !/call stack|allocation|array length|out of memory/i.test(String(error?.message)),
      `${what} ran away: ${error?.stack}`,
    );
    assert.ok(
      error instanceof BimodalError && error.code.length > 0,
      `${what} does not say what is wrong: ${error?.stack ?? error}`,
    );
  }
}

describe("every export", () => {
  let bystander, expected;
  before(async () => {
    await init();
    bystander = estimator();
    bystander.step();
    expected = outcome(bystander);
  });
  after(() => bystander.free());

  for (const [module, exports] of Object.entries(MODULES)) {
    for (const [name, value] of Object.entries(exports)) {
      if (typeof value !== "function" || APART.has(name)) continue;
      test(`${module}: ${name}`, async () => {
        for (const [words, values] of given(value.length + 1)) await tried(`${name}(${words})`, () => value(...values));
      });
    }
  }

  for (const [name, [call, ...values]] of Object.entries(WRITERS)) {
    test(`${name}, with one member of what it takes changed`, name === "reportHtml" ? LONG : {}, async () => {
      await call(...values);
      for (const [words, changed] of changes(values)) {
        // A report shows "not known" for a missing number; bigints and symbols make JavaScript's own arithmetic throw.
        if (name === "reportHtml" && /(bigint|symbol)$/.test(words)) continue;
        await tried(`${name}(${words})`, () => call(...changed));
      }
    });
  }

  test("a new Estimator", async () => {
    const { image, depth } = pair();
    for (const [words, [first, second, third]] of given(3)) {
      await tried(`new Estimator(${words})`, () => new Estimator(first, second, third));
      await tried(`with an image of ${words}`, () => new Estimator({ ...image, data: first }, depth));
      await tried(
        `with a camera of ${words}`,
        () => new Estimator({ ...image, camera: first }, { ...depth, mask: second }),
      );
      await tried(
        `with options of ${words}`,
        () => new Estimator(image, depth, { light: first, start: second, lambda: third }),
      );
    }
  });

  test("every member of an estimator", async () => {
    const members = Object.getOwnPropertyNames(Estimator.prototype).filter(
      (name) => !["constructor", "free", "reset"].includes(name),
    );
    assert.ok(members.includes("step") && members.includes("draw") && members.includes("save"));
    const moving = ["step", "stepStage", "stepFor", "run"];
    for (const name of members.filter((name) => typeof bystander[name] === "function" && !moving.includes(name))) {
      for (const [words, values] of given(2))
        await tried(`estimator.${name}(${words})`, () => bystander[name](...values));
    }
    // An estimator that has ended, so that accepted calls cost nothing.
    const ended = estimator({ maxIterations: 1 });
    ended.step();
    for (const [words, values] of given(2)) {
      for (const name of moving) await tried(`estimator.${name}(${words})`, () => ended[name](...values));
    }
    for (const [words, [value]] of given(1)) await tried(`estimator.reset(${words})`, () => ended.reset(value));
    ended.free();
    for (const [words, [state]] of given(1)) await tried(`restore(${words})`, () => Estimator.restore(state));
  });

  test("what throws when it is looked at throws its own error, and nothing else", () => {
    assert.throws(() => new Estimator(trap, trap), /that throw/);
    assert.throws(() => package_.sample(trap), /that throw/);
  });

  test("and nothing has changed", () => {
    assert.deepEqual(outcome(bystander), expected);
    const other = estimator();
    other.step();
    assert.deepEqual(outcome(other), expected);
    other.free();
  });
});
