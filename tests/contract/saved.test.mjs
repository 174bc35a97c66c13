// A run saved as bytes continues to the same bits, and anything else is refused by name.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { crc32 } from "node:zlib";
import { Estimator, estimator, init, outcome, pair, refused } from "./support.mjs";
import { LONG } from "./long.mjs";

before(() => init());

/** Runs to the end and returns the results. */
function ended(run) {
  while (run.report.status === "running") run.step();
  const out = outcome(run);
  run.free();
  return out;
}

/** An estimator after some calls. */
function after(run, ...calls) {
  for (const call of calls) run[call]();
  return run;
}

const same = (run, other) => assert.deepEqual(outcome(run), outcome(other));

describe("goes on to the same bits", () => {
  const knowing = (options) => () => estimator({ maxIterations: 4, ...options });
  const cases = {
    "before the first step": [knowing()],
    "after iterations": [knowing(), "step", "step"],
    "within an iteration": [knowing(), "step", "stepStage", "stepStage"],
    "after a first stage": [knowing(), "stepStage"],
    "at the end": [knowing({ maxIterations: 2 }), "step", "step"],
    "with the paper's registration": [knowing({ registration: "icp", shading: "pixel" }), "step"],
    "within a search": [
      () => estimator({ start: "search", light: "estimate", maxIterations: 1 }),
      "step",
      "step",
      "step",
    ],
    "after a reset": [knowing(), "step", "reset", "step"],
  };
  for (const [name, [make, ...calls]] of Object.entries(cases)) {
    test(name, name === "within a search" ? LONG : {}, () => {
      const run = after(make(), ...calls);
      const other = Estimator.restore(run.save());
      same(run, other);
      assert.deepEqual(ended(run), ended(other));
    });
  }

  test("with room for events, which may break it off", async () => {
    const run = after(estimator({ maxIterations: 4 }), "step", "step");
    const state = run.save();
    let events = 0;
    const count = setInterval(() => events++, 0);
    const other = await Estimator.restoreAsync(state);
    clearInterval(count);
    same(run, other);
    other.free();
    const control = new AbortController();
    const reason = new Error("enough");
    const broken = Estimator.restoreAsync(state, { signal: control.signal });
    control.abort(reason);
    await assert.rejects(broken, (error) => error === reason);
    await assert.rejects(Estimator.restoreAsync(state, { signal: AbortSignal.abort() }), { name: "AbortError" });
    await assert.rejects(Estimator.restoreAsync(new Uint8Array(3)), { code: "state", field: "state" });
    await assert.rejects(Estimator.restoreAsync(state, { signl: 1 }), { code: "option", field: "options.signl" });
    assert.ok(events > 0);
    run.free();
  });

  test("after a search that threads have shared", async () => {
    const run = estimator({ start: "search", workers: 2, maxIterations: 2 });
    await run.run();
    const other = Estimator.restore(run.save());
    same(run, other);
    run.free();
    other.free();
  });

  test("with all that views may have", () => {
    const { image, depth, light } = pair();
    const camera = { fx: 90, fy: 90, cx: 15.5, cy: 15.5 };
    const colours = new Uint16Array(4 * 32 * 32).map((_, i) =>
      i % 4 === 3 ? 65535 : 65535 * Math.min(1, image.data[3 * (i >> 2) + (i % 4)]),
    );
    const run = new Estimator(
      { width: 32, height: 32, data: colours, mask: image.mask, camera, transfer: "linear" },
      {
        width: 32,
        height: 32,
        mask: depth.mask,
        data: depth.data.map((z) => (40 + z) / 400),
        camera: { ...camera, distortion: [0.01, 0, 0, 0, 0] },
        unit: 1.5,
      },
      {
        light: Float64Array.from(light),
        start: { angles: { beta: 15 } },
        startTolerance: { degrees: 20 },
        lambda: { prior: 2 },
        maxIterations: 2,
      },
    );
    run.step();
    same(run, Estimator.restore(run.save()));
  });

  test("from a file as Node reads it", () => {
    // A small file lies within a larger buffer, and a slice of a Buffer is a view of it.
    for (const size of [16, 32]) {
      const run = estimator({ maxIterations: 2 }, pair({ size }));
      same(run, Estimator.restore(Buffer.concat([Buffer.from("before"), run.save()]).subarray(6)));
    }
  });

  test("whatever becomes of the arrays that it was given", () => {
    const given = pair();
    const run = estimator({ maxIterations: 2 }, given);
    const state = run.save();
    given.image.data.fill(1);
    given.depth.data.fill(NaN);
    assert.deepEqual(run.save(), state);
    run.step();
    same(run, Estimator.restore(run.save()));
  });
});

describe("is refused", () => {
  let state;
  before(() => (state = after(estimator({ maxIterations: 2 }), "step").save()));
  const bad = (bytes, words) => {
    refused(() => Estimator.restore(bytes), "state", "state");
    assert.throws(() => Estimator.restore(bytes), words);
  };
  /** The same state with another header and a valid checksum. */
  function changed(change) {
    const view = Buffer.from(state);
    const length = view.readUInt32LE(16);
    const header = JSON.parse(view.subarray(20, 20 + length).toString());
    const text = Buffer.from(JSON.stringify(change(header) ?? header));
    const all = Buffer.concat([
      view.subarray(0, 16),
      Buffer.from(Uint32Array.of(text.length).buffer),
      text,
      view.subarray(20 + length, -4),
    ]);
    return new Uint8Array(Buffer.concat([all, Buffer.from(Uint32Array.of(crc32(all)).buffer)]));
  }

  test("what is no state", () => {
    for (const value of [undefined, null, "state", [1, 2], new ArrayBuffer(8)])
      refused(() => Estimator.restore(value), "type", "state");
    for (const bytes of [[], [1, 2, 3], Buffer.from("\x89PNG\r\n\x1a\n and so on"), new Uint8Array(1000)])
      bad(Uint8Array.from(bytes), /not a saved run/);
  });

  test("one that is cut off, anywhere", () => {
    for (let length = 15; length < state.length; length += 1 + (length >> 3)) bad(state.slice(0, length), /cut off/);
  });

  test("one with a wrong byte, anywhere", () => {
    for (let at = 16; at < state.length; at += 1 + (at >> 3))
      bad(
        state.map((byte, i) => (i === at ? byte ^ 16 : byte)),
        /damaged/,
      );
  });

  test("another format", () =>
    bad(
      state.map((byte, i) => (i === 15 ? 2 : byte)),
      /format 2; this version reads format 1/,
    ));

  test("a header that says something else, though its checksum is right", () => {
    bad(
      changed((header) => void (header.options.lamda = {})),
      /lamda/,
    );
    bad(
      changed((header) => void (header.image.width = 31)),
      /image\.mask/,
    );
    bad(
      changed((header) => void (header.arrays[0].type = "constructor")),
      /arrays.*type|type.*unknown/s,
    );
    bad(
      changed((header) => void (header.arrays[0].length = 2 ** 40)),
      /cut off/,
    );
    bad(
      changed((header) => void header.arrays.pop()),
      /longer than it declares/,
    );
    bad(
      changed((header) => void (header.arrays = { length: 3 })),
      /must be a list/,
    );
    bad(
      changed((header) => void (header.reached.iteration = -1)),
      /iteration/,
    );
    bad(
      changed(() => [1]),
      /header/,
    );
    bad(
      changed(() => 5),
      /header/,
    );
    bad(
      changed((header) =>
        JSON.parse(JSON.stringify(header).replace('"image":{', '"image":{"__proto__":{"camera":1},')),
      ),
      /__proto__/,
    );
  });

  test("one whose numbers come out otherwise", () =>
    bad(
      changed((header) => void (header.found = (header.found ^ 1) >>> 0)),
      /computes different digits/,
    ));

  test("an end that is never reached does not take for ever", () => {
    bad(
      changed((header) => void Object.assign(header.reached, { iteration: 1e9, slices: 1e9 })),
      /computes different digits/,
    );
  });
});
