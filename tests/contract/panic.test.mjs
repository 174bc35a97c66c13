// A panic makes one estimator unusable and no other. The package does not panic on demand, so a trap is built into its module.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import binaryen from "binaryen";
import { estimator, init, refused } from "./support.mjs";

/** The module with one exported function replaced by a trap, which is what a panic compiles to. */
async function trapped(name) {
  const module = binaryen.readBinary(await readFile(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)));
  const inner = binaryen.getExportInfo(module.getExport(name)).value;
  binaryen.Function.setBody(module.getFunction(inner), module.unreachable());
  const bytes = module.emitBinary();
  module.dispose();
  return bytes;
}

test("a panic poisons its own estimator alone", async () => {
  await init(await trapped("estimator_stepStage"));
  const broken = estimator();
  const other = estimator();
  assert.equal(broken.report.iteration, 0);
  refused(() => broken.stepStage(), "panic", undefined);
  for (const call of [() => broken.report, () => broken.step(), () => broken.refinedDepth(), () => broken.reset()]) {
    refused(call, "poisoned", undefined);
  }
  assert.doesNotThrow(() => broken.free());
  refused(() => broken.report, "freed", undefined);

  assert.equal(other.report.iteration, 0);
  assert.ok(other.refinedDepth().length > 0);
  assert.equal(other.step().iteration, 1);
  const another = estimator();
  assert.equal(another.step().iteration, 1);
});
