// Fuzzes the readers of files: mutates the fixtures, guided by V8's coverage of pkg/. `node scripts/fuzz-readers.mjs` takes ten minutes;
// --minutes N, --seed N, --minimise (writes fuzz/corpus/readers, the files that run code which the fixtures do not). Inputs that break a
// promise are saved in target/fuzz/findings, and the exit code is 1.
//
// The fuzzer is hand-written, because @jazzer.js/core 4.0.0, libFuzzer for Node, brings 105 packages and binaries for glibc 2.38 and newer.
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename } from "node:path";
import { parseArgs } from "node:util";
import { Worker } from "node:worker_threads";
import { build } from "./build.mjs";
import { Coverage } from "./fuzz/coverage.mjs";
import { readEveryWay } from "./fuzz/read.mjs";
import { setup } from "./setup.mjs";
import { filesBelow, inRoot, say, script } from "./shell.mjs";

const CORPUS = inRoot("fuzz/corpus/readers");
const GROWN = inRoot("target/fuzz/readers");
const FINDINGS = inRoot("target/fuzz/findings");
const FIXTURES = [inRoot("tests/fixtures/rig"), inRoot("tests/fixtures/run")];
/** Limits of the thread: megabytes of heap, and milliseconds after which a reading counts as hanging. */
const MOST_MEGABYTES = 1024;
const HANGS = 20_000;
const LONGEST = 65_536;

const filesOf = (...folders) =>
  folders.flatMap(filesBelow).map((path) => ({ path, bytes: new Uint8Array(readFileSync(path)) }));

/** Runs one thread until its time is over or a file stops it; returns the milliseconds that it ran. */
function run(options, told) {
  const [beat, present] = [new Int32Array(new SharedArrayBuffer(8)), new SharedArrayBuffer(LONGEST)];
  const start = Date.now();
  return new Promise((done) => {
    const workerData = { ...options, beat, present, folder: GROWN, findings: FINDINGS };
    const thread = new Worker(new URL("fuzz/thread.mjs", import.meta.url), {
      workerData,
      resourceLimits: { maxOldGenerationSizeMb: MOST_MEGABYTES },
    });
    let [last, since, stopped] = [-1, Date.now(), undefined];
    const stop = (why) => {
      stopped = why;
      const file = new Uint8Array(present).slice(0, Atomics.load(beat, 1));
      mkdirSync(FINDINGS, { recursive: true });
      const path = `${FINDINGS}/${why.replaceAll(" ", "-")}-${Date.now()}`;
      writeFileSync(path, file);
      told({ finding: why, path });
      return thread.terminate();
    };
    const watch = setInterval(() => {
      const now = Atomics.load(beat, 0);
      if (now !== last) [last, since] = [now, Date.now()];
      else if (Date.now() - since > HANGS) void stop("hangs");
    }, 1000);
    thread.on("message", told);
    thread.on(
      "error",
      (error) =>
        void stop(error.code === "ERR_WORKER_OUT_OF_MEMORY" ? "fills the memory" : `stops the thread ${error.message}`),
    );
    thread.on("exit", () => {
      clearInterval(watch);
      done({ spent: Date.now() - start, stopped });
    });
  });
}

async function fuzz(minutes, seed) {
  const findings = [];
  let [sum, latest] = [0, { runs: 0 }];
  const told = ({ finding, path, progress }) => {
    if (progress) latest = progress;
    if (finding) findings.push(`${basename(path)}: ${finding}`);
    if (finding) console.log(`FOUND ${path}: ${finding}`);
    else
      say(
        `${sum + latest.runs} files read, ${latest.read} of the last ${latest.runs} of use, ${latest.kept} kept, ${latest.covered} characters of pkg/ run`,
      );
  };
  for (let left = minutes * 60_000, round = 0; left > 0; round++) {
    const seeds = filesOf(...FIXTURES, CORPUS, GROWN)
      .map(({ bytes }) => bytes)
      .filter((bytes) => bytes.length > 0 && bytes.length < LONGEST);
    const { spent, stopped } = await run({ seeds, seed: seed + round, milliseconds: left }, told);
    left = stopped ? left - spent : 0;
    sum += latest.runs;
    latest = { runs: 0 };
  }
  console.log(`${sum} files read in ${minutes} minutes from seed ${seed}; ${findings.length} findings`);
  if (findings.length > 0) process.exitCode = 1;
}

/** Keeps all findings. Then goes through the other files, the smallest first, and keeps those that run code which no earlier file ran. */
async function minimise() {
  const coverage = new Coverage();
  await coverage.start();
  for (const { bytes } of filesOf(...FIXTURES)) await readEveryWay(bytes);
  await coverage.grown();
  const isFinding = ({ path }) => basename(path).startsWith("found-");
  const found = filesOf(CORPUS, GROWN).sort((a, b) => a.bytes.length - b.bytes.length || (a.path < b.path ? -1 : 1));
  const kept = found.filter(isFinding);
  for (const file of found.filter((file) => !isFinding(file))) {
    await readEveryWay(file.bytes);
    if ((await coverage.grown()) > 0) kept.push(file);
  }
  rmSync(CORPUS, { recursive: true, force: true });
  mkdirSync(CORPUS, { recursive: true });
  for (const { path, bytes } of kept) writeFileSync(`${CORPUS}/${basename(path)}`, bytes);
  say(`${kept.length} of ${found.length} files kept, ${kept.reduce((sum, { bytes }) => sum + bytes.length, 0)} bytes`);
}

await script(async () => {
  const { values } = parseArgs({
    options: {
      minutes: { type: "string", default: "10" },
      seed: { type: "string", default: "1" },
      minimise: { type: "boolean", default: false },
    },
  });
  await setup();
  await build();
  if (values.minimise) await minimise();
  else await fuzz(Number(values.minutes), Number(values.seed));
});
