// Installs the checkout's Python package into an environment below target/ and runs its tests.
import { existsSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { NOTICES } from "./notices/text.mjs";
import { ask, inRoot, must, print, readIfThere, say, stamp, watch } from "./shell.mjs";

const VENV = "target/python/venv";
/** Folder of the wheel that was installed last. */
export const WHEELS = "target/python/wheels";
const inVenv = (name) => inRoot(VENV, "bin", name);
/** The oldest Python that the tests' pinned numpy supports; the package itself supports older ones. */
const OLDEST = [3, 11];
const REQUIREMENTS = "python/tests/requirements.txt";
const PACKAGE = ["src", "bimodal_stereo", "README.md", "Cargo.toml", "Cargo.lock", NOTICES].map(
  (name) => `python/${name}`,
);
const SOURCES = [
  "src",
  "files/src",
  "files/Cargo.toml",
  "Cargo.toml",
  "rust-toolchain.toml",
  "pyproject.toml",
  ...PACKAGE,
];

/** Why Python can't be used here; undefined if it can. */
export function missing() {
  const version = ask("python3", ["-c", "import venv, ensurepip, sys; print(*sys.version_info[:2])"]);
  if (version === undefined) return "needs python3 with its module venv (Debian: apt-get install python3-venv)";
  const [major, minor] = version.split(" ").map(Number);
  const isOld = major < OLDEST[0] || (major === OLDEST[0] && minor < OLDEST[1]);
  return isOld ? `needs Python ${OLDEST.join(".")}, this is ${version.replace(" ", ".")}` : undefined;
}

/** Runs a step of an environment's set-up if its stamp has changed; a step that fails leaves no stamp. */
export async function once(venv, mark, wanted, step) {
  const path = inRoot(venv, mark);
  const interpreter = ask("python3", ["-c", "import sys; print(sys.version, sys.prefix)"]);
  if (readIfThere(path) === `${wanted} ${interpreter}` && existsSync(inRoot(venv, "bin/python"))) return;
  rmSync(path, { force: true });
  await step();
  writeFileSync(path, `${wanted} ${interpreter}`);
}

export const pip = (venv, ...args) =>
  must(join(venv, "bin/python"), ["-m", "pip", "--disable-pip-version-check", "--quiet", ...args]);

/** The wheels to install. */
export const wheels = () => readdirSync(inRoot(WHEELS)).map((name) => join(WHEELS, name));

/** The environment of the package's tests, which also builds its wheel. */
export async function install() {
  await once(VENV, ".venv-stamp", stamp([REQUIREMENTS]), async () => {
    say("Python: an environment for its tests");
    await must("python3", ["-m", "venv", "--clear", inRoot(VENV)]);
    await pip(inRoot(VENV), "install", "--requirement", REQUIREMENTS);
  });
  await once(VENV, ".package-stamp", stamp([...SOURCES, REQUIREMENTS]), async () => {
    say("Python: pip install ., by way of its wheel");
    rmSync(inRoot(WHEELS), { recursive: true, force: true });
    // Cargo's output stays in python/target.
    await pip(inRoot(VENV), "wheel", "--no-deps", "--wheel-dir", WHEELS, ".");
    await pip(inRoot(VENV), "install", "--force-reinstall", "--no-deps", ...wheels());
  });
}

/** Checks format, lints, types and tests, and stops at the first failure. */
export async function python() {
  const reason = missing();
  if (reason !== undefined) {
    const output = `skipped: the Python package # ${reason}\n`;
    print(output);
    return { code: 0, output };
  }
  await install();
  const manifest = ["--manifest-path", "python/Cargo.toml"];
  const guard = inRoot("target/python/guard");
  const steps = [
    ["cargo", "fmt", "--check", ...manifest],
    // The build has the release profile, for which pip has already compiled the macros.
    ["cargo", "clippy", "--release", "--locked", ...manifest, "--", "-D", "warnings"],
    // This file needs only the standard library, so the test does not link Python.
    ["rustc", "--edition", "2024", "--test", "python/src/guard.rs", "-o", guard],
    [guard],
    [inVenv("mypy"), "--strict", "--cache-dir", "target/python/mypy", "python/bimodal_stereo", "python/tests/typed.py"],
    [inVenv("pytest")],
  ];
  let output = "";
  // Other packages in the environment, such as those of Open3D, may bring plugins that this pytest rejects.
  const env = { PYTEST_DISABLE_PLUGIN_AUTOLOAD: "1" };
  for (const [program, ...args] of steps) {
    const result = await watch(program, args, { env });
    output += result.output;
    if (result.code !== 0) return { code: result.code, output };
  }
  return { code: 0, output };
}
