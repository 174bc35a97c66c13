// A run ends the same, bit by bit, however its steps are sliced: by iterations, by stages, or by any number of milliseconds.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, init, outcome, pair } from "./support.mjs";

before(() => init());

/** Nothing is known, so that the search is also sliced. */
function end(advance) {
  const { image, depth } = pair({ size: 24, noise: 0.01 });
  const estimator = new Estimator(image, depth, { maxIterations: 6 });
  for (let turn = 0; estimator.report.status === "running"; turn++) advance(estimator, turn);
  const found = outcome(estimator);
  estimator.free();
  return found;
}

test("iterations, stages and milliseconds by turns end at the same bits as iterations", LONG, () => {
  const byTurns = end((estimator, turn) =>
    [() => estimator.step(), () => estimator.stepStage(), () => estimator.stepFor(0), () => estimator.stepFor(3)][
      turn % 4
    ](),
  );
  assert.deepEqual(
    byTurns,
    end((estimator) => estimator.step()),
  );
});
