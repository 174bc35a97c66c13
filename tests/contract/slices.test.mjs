// However the steps of a run are sliced, its end is the same to the bit: by iterations, by stages, by milliseconds of any number.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { LONG } from "./long.mjs";
import { Estimator, init, outcome, pair } from "./support.mjs";

before(() => init());

/** Nothing told: the search is sliced as well. */
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
