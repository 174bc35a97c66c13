// The other side of `npm run bench -- --beside`: scripts/reference/beside as a process that waits for requests.
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import { missing, once, pip } from "../python.mjs";
import { Failure, inRoot, must, say, stamp } from "../shell.mjs";

const VENV = "target/tools/beside";
const FOLDER = "scripts/reference/beside";
const OPEN3D = `${FOLDER}/requirements-open3d.txt`;

/** Installs numpy and scipy, which are needed, and Open3D, without which its rows are left out. */
async function install() {
  const reason = missing();
  if (reason !== undefined) throw new Failure(`The comparison ${reason}.`);
  await once(VENV, ".venv-stamp", stamp([`${FOLDER}/requirements.txt`]), async () => {
    say("numpy and scipy: an environment for the comparison");
    await must("python3", ["-m", "venv", "--clear", inRoot(VENV)]);
    await pip(inRoot(VENV), "install", "--requirement", `${FOLDER}/requirements.txt`);
  });
  try {
    await once(VENV, ".open3d-stamp", stamp([OPEN3D, `${FOLDER}/requirements.txt`]), async () => {
      say("Open3D: installing it beside them (1.3 GB, once)");
      await pip(inRoot(VENV), "install", "--requirement", OPEN3D);
    });
  } catch {
    say("Open3D cannot be installed for this Python: its rows are left out");
  }
}

/** Stands for an answer that did not come in time. */
const OVER = Symbol("over the limit");

/**
 * Starts the process. A measurement that takes more than `limit` seconds ends the process and is answered by null; the next one starts
 * another process with the same scene.
 */
export async function theirSide({ limit, python = inRoot(VENV, "bin/python"), prepare = install }) {
  await prepare();
  let child;
  let lines;
  let scene;

  /** The next line; without a limit if this is no measurement. */
  async function answer(most) {
    let timer;
    const late = new Promise((done) => {
      if (most) timer = setTimeout(done, 1000 * most, OVER);
    });
    const got = await Promise.race([lines.next(), late]);
    clearTimeout(timer);
    if (got === OVER) {
      child.kill("SIGKILL");
      child = undefined;
      return null;
    }
    if (got.done) throw new Failure(`${FOLDER} ended early; see its message above.`);
    return JSON.parse(got.value);
  }

  async function start() {
    child = spawn(python, [FOLDER], { cwd: inRoot(), stdio: ["pipe", "pipe", "inherit"] });
    child.on("error", ({ message }) => say(`${python}: ${message}`));
    lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
    return answer();
  }

  async function ask(request, most) {
    if (!child) {
      await start();
      if (scene && request !== scene) await ask(scene);
    }
    child.stdin.write(`${request}\n`);
    return answer(most);
  }

  const hello = await start();
  if (hello.missing) {
    say(`Open3D cannot be loaded, so its rows are left out: ${hello.missing}`);
    // The wheel does not bring these libraries of the system.
    if (/\.so\b/.test(hello.missing)) say("Debian has its libraries: apt-get install libusb-1.0-0 libgl1 libgomp1");
  }
  return {
    limit,
    hasOpen3d: !hello.missing,
    async open({ path }) {
      scene = `scene ${path}`;
      return ask(scene);
    },
    step: () => ask("step", limit),
    answer: () => ask("answer", limit),
    close: () => child?.stdin.end(),
  };
}
