// Real pairs with the built package: the loop ends with a status and fills the holes.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import * as files from "../../pkg/files.js";
import { PAIRS, hasData, runPair, table } from "../../scripts/real-pairs.mjs";
import { Estimator, init } from "./support.mjs";
import { longUnless } from "./long.mjs";

const ENDS = ["converged", "max-iterations", "ambiguous"];

before(() => init());

// The tests are skipped one by one, not as a group, because runners count tests.
const skip = hasData() ? false : "needs ../shared/data";

describe("real pairs", () => {
  for (const name of ["coffee_mug_1", "vase_rgbd"]) {
    // The vase takes over three seconds.
    test(name, name === "vase_rgbd" ? longUnless(skip) : { skip }, async () => {
      const result = await runPair(Estimator, PAIRS[name](files));
      console.log(table([[name, result]])[1]);
      const { report, residualBefore, residualAfter, holes, filled } = result;
      assert.ok(ENDS.includes(report.status), `${report.status}: ${report.message}`);
      assert.equal(report.pose.scale, 1, "both cameras are metric");
      assert.ok([...report.pose.rotation, ...report.pose.translation].every(Number.isFinite));
      // Texture that no light explains keeps the residual of these objects high, so it need not fall.
      assert.ok(residualBefore > 0 && residualAfter > 0 && residualAfter < Infinity);
      assert.ok(holes > 0, "there is something to fill");
      assert.equal(filled, holes);
    });
  }
});
