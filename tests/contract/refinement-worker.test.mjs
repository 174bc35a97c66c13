// A worker refines the depth view while the image surface is computed; only the time depends on it.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, init, outcome, pair } from "./support.mjs";
import { runSettled, seen, settled, tamperWith, until } from "./threads.mjs";

/** The pair is large enough for two threads, and the pose stops moving after the first iteration. */
function scene(options = {}, request = {}) {
  const { image, depth, pose } = pair({ light: "window", size: 112, noise: 0.01, angles: { beta: 20 }, ...request });
  return { image, depth, options: { start: pose, stopDegrees: 1e-12, ...options } };
}

const alone = ({ image, depth, options }) => new Estimator(image, depth, options);
const together = ({ image, depth, options }, workers = 2) => new Estimator(image, depth, { ...options, workers });

async function endOf(estimator) {
  await estimator.run();
  const end = outcome(estimator);
  estimator.free();
  return end;
}

/** The end of a run in steps of one kind. Each step begins after all threads have answered. */
async function settledEnd(estimator, step) {
  await runSettled(estimator, step);
  const end = outcome(estimator);
  estimator.free();
  return end;
}

/** Longest wait of the estimator for an answer, milliseconds: LONGEST_WAIT of js/workers/refinement.ts. */
const LONGEST_WAIT = 2000;

/** Stops the timer that limits the estimator's wait, so that it waits for the other thread as long as necessary. */
const withoutHaste = (t) => t.mock.timers.enable({ apis: ["setTimeout"] });

/** Resolves once a run waits for a refinement that never comes. */
async function lostInWaiting() {
  const before = seen.asked;
  tamperWith((order) => (order.kind === "refine" ? undefined : order));
  await until(() => seen.asked > before);
  tamperWith();
  // The run continues to the place where it waits.
  for (let turns = 0; turns < 10; turns++) await new Promise(setImmediate);
}

before(() => init());

describe("a refinement worker", () => {
  test("refines the same to the bit, whatever kind of step is taken", LONG, async (t) => {
    withoutHaste(t);
    for (const given of [scene(), scene({ registration: "fixed" }), scene({}, { depthNoise: 0.1, holes: 0.1 })]) {
      const expected = await endOf(alone(given));
      const ways = [
        (estimator) => endOf(estimator),
        (estimator) => settledEnd(estimator, (e) => e.step()),
        (estimator) => settledEnd(estimator, (e) => e.stepStage()),
      ];
      for (const way of ways) {
        const before = { ...seen };
        const estimator = together(given);
        await settled();
        assert.deepEqual(await way(estimator), expected);
        assert.ok(seen.brought > before.brought, `${seen.brought - before.brought} of ${seen.asked - before.asked}`);
      }
    }
  });

  test("follows a search", LONG, async (t) => {
    withoutHaste(t);
    const given = scene({ start: "search", stopDegrees: 1e-12 });
    const before = seen.brought;
    assert.deepEqual(await settledEnd(together(given, 3)), await endOf(alone(given)));
    assert.ok(seen.brought > before);
  });

  test("is not waited for by steps without a pause", async () => {
    const given = scene();
    const estimator = together(given);
    await settled();
    while (estimator.step().status === "running");
    assert.deepEqual(outcome(estimator), await endOf(alone(given)));
    estimator.free();
  });

  test("a report's times are those of a whole iteration", async () => {
    const estimator = together(scene());
    await settled();
    const stages = [];
    await estimator.run({ onStep: ({ milliseconds }) => stages.push(Object.keys(milliseconds).sort().join()) });
    assert.deepEqual(new Set(stages), new Set(["light,refinement,registration,shading,surface"]));
    estimator.free();
  });

  test("that answers nonsense, or dies, changes nothing", LONG, async () => {
    const given = scene();
    const expected = await endOf(alone(given));
    const deaths = [
      (order) => ({ ...order, numbers: order.numbers.slice(1) }),
      (order) => ({ ...order, numbers: null }),
      (order) => ({ ...order, planes: order.planes.slice(0, -1) }),
      () => ({ kind: "nothing of the kind" }),
      () => {
        throw new RangeError("no memory for it");
      },
    ];
    for (const death of deaths) {
      tamperWith((order) => (order.kind === "refine" ? death(order) : order));
      const estimator = together(given);
      await settled();
      const before = { ...seen };
      assert.deepEqual(await endOf(estimator), expected);
      // After a failure, no further refinement is requested and no thread started in this loop.
      assert.deepEqual([seen.asked - before.asked, seen.begun - before.begun], [1, 0]);
    }
    tamperWith();
  });

  test("that is late is waited for in vain once", async (t) => {
    withoutHaste(t);
    const given = scene();
    const expected = await endOf(alone(given));
    const estimator = together(given);
    await settled();
    let ended = false;
    const end = endOf(estimator).finally(() => (ended = true));
    await lostInWaiting();
    const { asked } = seen;
    // Only the mocked timer ends the wait.
    for (; !ended; t.mock.timers.tick(LONGEST_WAIT)) await new Promise(setImmediate);
    assert.deepEqual(await end, expected);
    assert.equal(seen.asked, asked, "it is not asked again");
  });

  test("that cannot be given its pair is ended", async () => {
    const given = scene();
    const expected = await endOf(alone(given));
    tamperWith(() => {
      throw new RangeError("no memory for it");
    });
    const before = seen.begun;
    assert.deepEqual(await endOf(together(given)), expected);
    tamperWith();
    assert.equal(seen.begun - before, 1);
    await until(() => seen.ended === seen.begun);
  });

  test("is not started for a loop whose pose changes to the end", async () => {
    const before = seen.begun;
    await endOf(together(scene({ registration: "icp", maxIterations: 3 })));
    assert.equal(seen.begun, before);
  });

  test("goes when the loop begins anew or the estimator is freed, also while a run waits", LONG, async (t) => {
    withoutHaste(t);
    const given = scene();
    const expected = await endOf(alone(given));
    const estimator = together(given);
    await settled();
    const first = estimator.run();
    await lostInWaiting();
    estimator.reset();
    await first;
    estimator.reset();
    await estimator.run();
    assert.deepEqual(outcome(estimator), expected);
    estimator.reset();
    await settled();
    const [one, two] = [estimator.run(), estimator.run()];
    await Promise.all([one, two]);
    assert.deepEqual(outcome(estimator), expected);
    estimator.reset();
    await settled();
    const last = estimator.run();
    await lostInWaiting();
    estimator.free();
    await assert.rejects(last, { code: "freed" });
  });
});
