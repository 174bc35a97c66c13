// Workers share a search; only the time depends on their number.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, init, outcome, pair, refused } from "./support.mjs";
import { runSettled, seen, settled, until } from "./threads.mjs";

const scene = (request = {}) =>
  pair({ light: "window", size: 48, angles: { alpha: 10, beta: 40 }, noise: 0.01, ...request });

/** Runs to the end and returns the number of search slices in this thread. */
async function slicesOf(estimator) {
  return (await runSettled(estimator)).filter(({ stage }) => stage === "search").length;
}

before(() => init());

describe("search workers", () => {
  test("any number of them finds the same to the bit", LONG, async () => {
    const scenes = [
      [scene(), true],
      [scene({ surface: "ripples", scale: 1.1, overlap: 0.7 }), false],
    ];
    for (const [{ image, depth, light }, known] of scenes) {
      for (const options of [known ? { light } : {}]) {
        const alone = new Estimator(image, depth, options);
        const all = await slicesOf(alone);
        for (const workers of [2, 4]) {
          const together = new Estimator(image, depth, { ...options, workers });
          const slices = await slicesOf(together);
          assert.ok(slices < all, `${slices} of ${all} slices`);
          assert.deepEqual(outcome(together), outcome(alone));
          // The next search starts new workers.
          together.reset();
          assert.ok((await slicesOf(together)) < all);
          assert.deepEqual(outcome(together), outcome(alone));
        }
        alone.free();
      }
    }
  });

  test("a reset in the middle leaves no trace of the search before it", LONG, async () => {
    const { image, depth, light } = scene();
    const other = new Estimator(image, depth, { light });
    await other.run();
    const together = new Estimator(image, depth, { workers: 2 });
    await settled();
    await together.run({ maxIterations: 100 });
    together.reset({ light });
    await together.run();
    assert.deepEqual(outcome(together), outcome(other));
    together.reset({ light, start: "identity" });
    other.reset({ light, start: "identity" });
    await Promise.all([together.run(), other.run()]);
    assert.deepEqual(outcome(together), outcome(other));
  });

  test("what is changed after it was handed over changes nothing", async () => {
    const { image, depth, light } = scene();
    const alone = new Estimator(image, depth, { light });
    await alone.run();
    const options = { light: light.slice(), workers: 2 };
    const own = { ...image, data: image.data.slice() };
    const together = new Estimator(own, depth, options);
    options.light.fill(0);
    own.data.fill(0.5);
    await runSettled(together);
    assert.deepEqual(outcome(together), outcome(alone));
  });

  test("inputs of any make look the same in every thread, and stay their owner's", LONG, async () => {
    const { image, depth, light } = scene();
    const bytes = Buffer.alloc(4 * image.width * image.height);
    image.data.forEach((value, index) => (bytes[4 * Math.floor(index / 3) + (index % 3)] = Math.min(254, 160 * value)));
    for (let pixel = 0; pixel < image.width * image.height; pixel++) bytes[4 * pixel + 3] = 255;
    const shared = new Float64Array(new SharedArrayBuffer(8 * 27));
    shared.set(light);
    class Settings {
      get light() {
        return new Proxy([...shared], {});
      }
    }
    class Photo {
      constructor() {
        Object.assign(this, { width: image.width, height: image.height, data: bytes, transfer: "linear" });
      }
      get mask() {
        return image.mask;
      }
    }
    const alone = new Estimator(new Photo(), depth, new Settings());
    await alone.run();
    for (const options of [
      { workers: 3, light: new Proxy([...light], {}) },
      { workers: 3, light: shared },
    ]) {
      const together = new Estimator(new Photo(), depth, options);
      assert.equal(bytes.length, 4 * image.width * image.height);
      shared.fill(0);
      await runSettled(together);
      assert.deepEqual(outcome(together), outcome(alone));
      together.free();
      shared.set(light);
    }
    alone.free();
  });

  test("a reset that is refused in the middle leaves the search as it is", async () => {
    const { image, depth } = scene();
    const alone = new Estimator(image, depth);
    await alone.run();
    const together = new Estimator(image, depth, { workers: 2 });
    await settled();
    await together.run({ maxIterations: 50 });
    refused(() => together.reset({ light: new Float64Array(27).fill(NaN) }), "range", "options.light");
    await together.run();
    assert.deepEqual(outcome(together), outcome(alone));
    alone.free();
    together.free();
  });

  test("steps without a pause do all of it themselves", () => {
    const { image, depth } = scene({ size: 32 });
    const alone = new Estimator(image, depth);
    const together = new Estimator(image, depth, { workers: 3 });
    for (const estimator of [alone, together]) while (estimator.step().status === "running");
    assert.deepEqual(outcome(together), outcome(alone));
  });

  test("freed in the middle, they end", async () => {
    const { image, depth } = scene();
    const together = new Estimator(image, depth, { workers: 3 });
    await settled();
    await together.run({ maxIterations: 20 });
    together.free();
    await until(() => seen.ended === seen.begun);
    assert.throws(() => together.step(), { code: "freed" });
  });

  test("a program ends though they are never freed", () => {
    const folder = mkdtempSync(join(tmpdir(), "bimodal-stereo-"));
    const program = join(folder, "program.mjs");
    const support = JSON.stringify(new URL("./support.mjs", import.meta.url).href);
    writeFileSync(
      program,
      `import { Estimator, init, pair } from ${support};
      await init();
      const { image, depth } = pair();
      await new Estimator(image, depth, { workers: 3 }).run({ maxIterations: 3 });
      console.log("done");`,
    );
    const { status, stdout, stderr } = spawnSync(process.execPath, [program], { encoding: "utf8", timeout: 200_000 });
    rmSync(folder, { recursive: true });
    assert.deepEqual([status, stdout.trim()], [0, "done"], stderr);
  });

  test("their number is checked, and stays", () => {
    const { image, depth } = scene({ size: 32 });
    for (const workers of [0, 1.5, 17, -1, NaN])
      refused(() => new Estimator(image, depth, { workers }), "range", "options.workers");
    refused(() => new Estimator(image, depth, { workers: "2" }), "type", "options.workers");
    const estimator = new Estimator(image, depth);
    refused(() => estimator.reset({ workers: 2 }), "unsupported", "options.workers");
    estimator.reset({ workers: 1 });
    refused(() => estimator.reset(null), "type", "options");
  });
});
