// The wheel for Pyodide, whose bindings call the npm package's WebAssembly. No registry has numpy for Pyodide, so a stand-in has the few
// functions that the script's calls use.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { loadPyodide } from "pyodide";
import init, { Estimator, sample } from "../../pkg/index.js";
import { pyodideWheel } from "../../scripts/pyodide.mjs";
import { inRoot } from "../../scripts/shell.mjs";

/** The lines that a Python script prints with the wheel's package. */
async function printed(script) {
  const lines = [];
  const python = await loadPyodide({ stdout: (line) => lines.push(line) });
  await python.loadPackage(await pyodideWheel(), { messageCallback: () => {} });
  const packages = python.runPython("import sysconfig; sysconfig.get_path('purelib')");
  python.FS.writeFile(`${packages}/numpy.py`, readFileSync(inRoot("tests/pyodide/numpy.py")));
  python.runPython(readFileSync(inRoot(script), "utf8"));
  return lines;
}

/** The same run by the npm package. */
async function expected() {
  await init();
  const { image, depth } = sample({ surface: "bust", light: "colourful", size: 48, angles: { beta: 20 }, noise: 0.01 });
  const estimator = new Estimator(image, depth, { start: "identity", stopDegrees: 0.01 });
  let steps = 0;
  while (estimator.report.status === "running") {
    estimator.step();
    steps++;
  }
  const { status, pose } = estimator.report;
  estimator.free();
  return `run ${status} ${pose.angles.beta} ${steps}`;
}

test("a script of Python runs in Pyodide, bit-identical to JavaScript", async () => {
  assert.deepEqual(await printed("tests/pyodide/script.py"), [
    await expected(),
    "light (3, 9) lights 3",
    "check consistent ['new'] True",
    "refused range stop_degrees True",
    "refused range surface True",
    "refused unsupported read_image True",
    "refused option no_such_option True",
  ]);
});
