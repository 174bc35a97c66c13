// A worker refines the depth view beside the image surface, and nothing but the time it takes depends on it.
import assert from "node:assert/strict";
import { syncBuiltinESMExports } from "node:module";
import { before, describe, test } from "node:test";
import { setTimeout as wait } from "node:timers/promises";
import threads from "node:worker_threads";
import { Estimator, init, outcome, pair } from "./support.mjs";

/** Until the worker is there, milliseconds. */
const ARRIVAL = 1000;

/** Refinements that workers were asked for, and made. */
const told = { asked: 0, brought: 0 };
/** What becomes of an order before it is sent. */
let tamper = (order) => order;
/** Workers that were started, and those of them that ended. */
const made = { begun: 0, ended: 0 };

class Watched extends threads.Worker {
  constructor(...args) {
    super(...args);
    made.begun++;
    this.on("exit", () => made.ended++);
    this.on("message", (answer) => (told.brought += answer instanceof Float32Array ? 1 : 0));
  }

  postMessage(order, transfer) {
    if (order.kind === "refine") told.asked++;
    super.postMessage(tamper(order), transfer);
  }
}

/** Large enough to be shared; the pose that is to be found stands from the second iteration on. */
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

/** As many steps, with time for messages between them. */
async function pacedEnd(estimator, step) {
  while (step(estimator).status === "running") await wait(20);
  const end = outcome(estimator);
  estimator.free();
  return end;
}

before(async () => {
  await init();
  threads.Worker = Watched;
  syncBuiltinESMExports();
});

describe("a refinement worker", () => {
  test("refines the same to the bit, whatever kind of step is taken", async () => {
    for (const given of [scene(), scene({ registration: "fixed" }), scene({}, { depthNoise: 0.1, holes: 0.1 })]) {
      const expected = await endOf(alone(given));
      const ways = [
        (estimator) => endOf(estimator),
        (estimator) => pacedEnd(estimator, (e) => e.step()),
        (estimator) => pacedEnd(estimator, (e) => e.stepStage()),
      ];
      for (const way of ways) {
        const before = { ...told };
        const estimator = together(given);
        await wait(ARRIVAL);
        assert.deepEqual(await way(estimator), expected);
        assert.ok(told.brought > before.brought, `${told.brought - before.brought} of ${told.asked - before.asked}`);
      }
    }
  });

  test("follows a search", async () => {
    const given = scene({ start: "search", stopDegrees: 1e-12 });
    const before = told.brought;
    assert.deepEqual(await endOf(together(given, 3)), await endOf(alone(given)));
    assert.ok(told.brought > before);
  });

  test("is not waited for by steps without a pause", async () => {
    const given = scene();
    const estimator = together(given);
    await wait(ARRIVAL);
    while (estimator.step().status === "running");
    assert.deepEqual(outcome(estimator), await endOf(alone(given)));
    estimator.free();
  });

  test("a report's times are those of a whole iteration", async () => {
    const estimator = together(scene());
    await wait(ARRIVAL);
    const stages = [];
    await estimator.run({ onStep: ({ milliseconds }) => stages.push(Object.keys(milliseconds).sort().join()) });
    assert.deepEqual(new Set(stages), new Set(["light,refinement,registration,shading,surface"]));
    estimator.free();
  });

  test("that answers nonsense, or dies, changes nothing", async () => {
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
      tamper = (order) => (order.kind === "refine" ? death(order) : order);
      const estimator = together(given);
      await wait(ARRIVAL);
      const before = made.begun;
      assert.deepEqual(await endOf(estimator), expected);
      // After a failure none is started again in this loop.
      assert.equal(made.begun, before);
    }
    tamper = (order) => order;
  });

  test("that cannot be given its pair is ended", async () => {
    const given = scene();
    const expected = await endOf(alone(given));
    tamper = () => {
      throw new RangeError("no memory for it");
    };
    const before = { ...made };
    assert.deepEqual(await endOf(together(given)), expected);
    tamper = (order) => order;
    await wait(200);
    assert.deepEqual([made.begun - before.begun, made.ended - before.ended], [1, 1]);
  });

  test("is not started for a loop whose pose changes to the end", async () => {
    const before = made.begun;
    await endOf(together(scene({ registration: "icp", maxIterations: 3 })));
    assert.equal(made.begun, before);
  });

  test("goes when the loop begins anew or the estimator is freed, also while somebody waits", async () => {
    const given = scene();
    const expected = await endOf(alone(given));
    const estimator = together(given);
    await wait(ARRIVAL);
    const first = estimator.run();
    await wait(5);
    estimator.reset();
    await first;
    estimator.reset();
    await estimator.run();
    assert.deepEqual(outcome(estimator), expected);
    estimator.reset();
    await wait(ARRIVAL);
    const [one, two] = [estimator.run(), estimator.run()];
    await Promise.all([one, two]);
    assert.deepEqual(outcome(estimator), expected);
    estimator.reset();
    await wait(ARRIVAL);
    const last = estimator.run();
    await wait(5);
    estimator.free();
    await assert.rejects(last, { code: "freed" });
  });
});
