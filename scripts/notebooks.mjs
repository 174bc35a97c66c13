// Runs the notebooks in Jupyter and marimo, which are installed into an environment below target/ with the checkout's wheel.
import { headless } from "./browser.mjs";
import { WHEELS, install as wheel, missing, once, pip, wheels } from "./python.mjs";
import { inRoot, matching, must, print, say, stamp, watch } from "./shell.mjs";

const VENV = "target/python/notebooks";
const REQUIREMENTS = "tests/notebooks/requirements.txt";
/** No test measures time; this limit, in milliseconds, ends a test that hangs. */
const HANGS = 600_000;

async function install() {
  await wheel();
  await once(VENV, ".venv-stamp", stamp([REQUIREMENTS]), async () => {
    say("notebooks: an environment with JupyterLab and marimo");
    await must("python3", ["-m", "venv", "--clear", inRoot(VENV)]);
    // The modules are not compiled at installation: most are never imported, and compiling all would take longer than the tests.
    await pip(inRoot(VENV), "install", "--no-compile", "--requirement", REQUIREMENTS);
  });
  const installed = () => pip(inRoot(VENV), "install", "--force-reinstall", "--no-deps", ...wheels());
  await once(VENV, ".wheel-stamp", stamp([WHEELS, REQUIREMENTS]), installed);
}

export async function notebooks() {
  const reason = missing();
  if (reason !== undefined) {
    const output = `skipped: the notebooks # ${reason}\n`;
    print(output);
    return { code: 0, output };
  }
  await install();
  const env = { NOTEBOOKS: inRoot(VENV, "bin"), CHROMIUM: await headless() };
  const files = matching(["tests/notebooks", "tests/pyodide"], /\.test\.mjs$/);
  const options = ["--test", "--test-reporter=spec", "--test-concurrency=2", `--test-timeout=${HANGS}`];
  return watch(process.execPath, ["--no-concurrent-recompilation", ...options, ...files], { env });
}
