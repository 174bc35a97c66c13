// The thread that fuzzes: it makes files, reads them, and keeps those that run new code. Its parent supervises it.
import { createHash } from "node:crypto";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { parentPort, workerData } from "node:worker_threads";
import { Coverage } from "./coverage.mjs";
import { mutated } from "./mutate.mjs";
import { generator } from "./random.mjs";
import { readEveryWay } from "./read.mjs";

const { seeds, seed, milliseconds, folder, findings, beat, present } = workerData;
/** Number of files read between two measurements of the coverage, each of which takes as long as the reading. */
const BATCH = 12;

const random = generator(seed);
const coverage = new Coverage();
const counts = { runs: 0, read: 0, kept: 0, found: 0 };
const told = new Set();

/** Tells the parent which file is being read, in case it hangs or fills the memory. */
function announce(file) {
  const view = new Uint8Array(present);
  view.set(file.subarray(0, view.length));
  Atomics.store(beat, 1, Math.min(file.length, view.length));
  Atomics.add(beat, 0, 1);
}

function save(where, file) {
  mkdirSync(where, { recursive: true });
  const path = join(where, createHash("sha256").update(file).digest("hex").slice(0, 16));
  writeFileSync(path, file);
  return path;
}

async function read(file) {
  announce(file);
  counts.runs++;
  try {
    counts.read += (await readEveryWay(file)) > 0 ? 1 : 0;
  } catch (error) {
    // Findings that differ only in numbers count as one kind.
    const kind = String(error.message).split("\n").slice(0, 3).join(" ").replace(/\d+/g, "#");
    if (told.has(kind)) return;
    told.add(kind);
    counts.found++;
    parentPort.postMessage({ finding: error.message, path: save(findings, file) });
  }
}

await coverage.start();
const queue = [];
for (const file of seeds) {
  await read(file);
  await coverage.grown();
  queue.push(file);
}
parentPort.postMessage({ progress: { ...counts, covered: coverage.count } });
const end = Date.now() + milliseconds;
let next = Date.now() + 10_000;
while (Date.now() < end) {
  // New files are mutated more often than old ones.
  const base = () =>
    random.chance(0.5) ? queue[queue.length - 1 - random.below(Math.min(queue.length, 50))] : random.pick(queue);
  const batch = Array.from({ length: BATCH }, () => mutated(base(), queue, random)).filter((file) => file.length > 0);
  for (const file of batch) await read(file);
  if ((await coverage.grown()) > 0) {
    coverage.forget();
    for (const file of batch) await keepIfNew(file);
  }
  if (Date.now() > next) {
    parentPort.postMessage({ progress: { ...counts, covered: coverage.count } });
    next += 10_000;
  }
}
parentPort.postMessage({ progress: { ...counts, covered: coverage.count } });

/** Keeps a file of a batch if it ran new code. */
async function keepIfNew(file) {
  await readEveryWay(file).catch(() => undefined);
  if ((await coverage.grown()) === 0) return;
  queue.push(file);
  counts.kept++;
  save(folder, file);
}
