// Runs other programs and reports to the reader; shared by all scripts.
import { AsyncLocalStorage } from "node:async_hooks";
import { spawn, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, readFileSync, readdirSync, statSync } from "node:fs";
import { basename, dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "..");
export const inRoot = (...parts) => join(root, ...parts);

/** A failure that the reader can fix, for which the message suffices. */
export class Failure extends Error {}

/** The output so far of a task that runs beside others. */
const said = new AsyncLocalStorage();

export function print(text) {
  const pieces = said.getStore();
  if (pieces) pieces.push(text);
  else process.stdout.write(text);
}

export const say = (message) => print(`> ${message}\n`);

/** Buffers a task's output until it is done, so that lines of parallel tasks don't mix. */
export async function inOnePiece(task) {
  const pieces = [];
  try {
    return await said.run(pieces, task);
  } finally {
    process.stdout.write(pieces.join(""));
  }
}

export const seconds = (since) => `${((performance.now() - since) / 1000).toFixed(1)} s`;

/** The output of a program, or undefined if it is missing or fails. */
export function ask(program, args) {
  const answer = spawnSync(program, args, { cwd: root, encoding: "utf8" });
  return answer.status === 0 ? answer.stdout.trim() : undefined;
}

/** Runs a program, shows its output as it comes and returns it; never waits for input. */
export function watch(program, args, { env = {} } = {}) {
  return new Promise((done) => {
    const child = spawn(program, args, {
      cwd: root,
      env: { ...process.env, ...env },
      stdio: ["ignore", "pipe", "pipe"],
    });
    let output = "";
    const pieces = said.getStore();
    const pass = (stream) => (chunk) => {
      output += chunk;
      if (pieces) pieces.push(chunk.toString());
      else stream.write(chunk);
    };
    child.stdout.on("data", pass(process.stdout));
    child.stderr.on("data", pass(process.stderr));
    child.on("error", (error) => done({ code: 127, output: `${output}${program}: ${error.message}\n` }));
    child.on("close", (code, signal) => done({ code: code ?? (signal ? 130 : 1), output }));
  });
}

/** Like `watch`, but a failing program ends the script. */
export async function must(program, args, options) {
  const { code } = await watch(program, args, options);
  if (code !== 0) throw new Failure(`"${[program, ...args].join(" ")}" failed (${code})`);
}

/** Every file below a folder, or the file itself. */
export function filesBelow(path) {
  if (!existsSync(path)) return [];
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path)
    .sort()
    .flatMap((name) => filesBelow(join(path, name)));
}

/** Paths below some folders whose file names match, relative to the project. */
export const matching = (folders, pattern) =>
  folders
    .flatMap((folder) => filesBelow(inRoot(folder)))
    .filter((path) => pattern.test(basename(path)))
    .map((path) => relative(root, path));

/** One hash over names and contents. Unlike time stamps, it survives a fresh checkout. */
export function stamp(paths) {
  const hash = createHash("sha256");
  for (const file of paths.flatMap((path) => filesBelow(inRoot(path)))) {
    hash.update(file.slice(root.length)).update("\0").update(readFileSync(file)).update("\0");
  }
  return hash.digest("hex");
}

export const readIfThere = (path) => (existsSync(path) ? readFileSync(path, "utf8") : undefined);

/** Runs a script's body; failures that the reader can fix are printed without a stack. */
export async function script(body) {
  try {
    await body();
  } catch (error) {
    console.error(error instanceof Failure ? `\n${error.message}` : error);
    process.exitCode = 1;
  }
}
