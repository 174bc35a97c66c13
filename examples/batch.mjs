// Finds the poses of many pairs of a colour image and a depth map, on all processors, and writes them to a table.
//
// npm run build && node examples/batch.mjs --help
import { appendFileSync, existsSync, readFileSync, readdirSync, statSync, truncateSync, writeFileSync } from "node:fs";
import { availableParallelism } from "node:os";
import { join, relative } from "node:path";
import { parseArgs } from "node:util";
import { Worker, isMainThread, parentPort, workerData } from "node:worker_threads";
import init, { Estimator } from "bimodal-stereo";
import { decodeColour, decodeDepth, decodeMask } from "bimodal-stereo/files";
import { progress } from "./progress.mjs";

const HELP = `Usage: node examples/batch.mjs FOLDER --csv OUT.csv [options]

Registers every pair of a colour image and a depth map below FOLDER and writes a line for each into OUT.csv as soon as it is done.
A pair has one name but for a word that tells which is which: bust-colour.png and bust-depth.npy, or colour/07.png and depth/07.png;
bust-mask.png is the colour image's mask. PNG of 8 and 16 bits and .npy are read.

Broken off, the same command goes on where it was. A pair that fails has the status "error" and the reason in its line.

  --csv OUT.csv    the table; pairs that are in it already are left out
  --settings FILE  JSON for all pairs: { "image": { "camera": .. }, "depth": { "camera": .., "unit": .. }, "options": .. }, as new Estimator takes them
  --threads N      pairs at the same time; default: one for each processor, here ${availableParallelism()}
  --retry          pairs that failed are tried again
  --help

Exit code: 0 every pair has its line and none failed, 1 some failed, 3 the input is bad, 130 interrupted.
`;

const FAILED = 1;
const BAD = 3;
const INTERRUPTED = 130;

const COLUMNS = [
  ...["name", "status", "scale", "alpha", "beta", "gamma", "x", "y", "z"],
  ...["sigma_x_degrees", "sigma_y_degrees", "sigma_z_degrees", "iterations", "residual", "message"],
];

/** An error that the user can fix; its message suffices. */
class Mistake extends Error {}

function parsed(args) {
  const text = { type: "string" };
  const flag = { type: "boolean" };
  try {
    return parseArgs({
      args,
      options: { csv: text, settings: text, threads: text, retry: flag, help: { ...flag, short: "h" } },
      allowPositionals: true,
    });
  } catch (error) {
    throw new Mistake(error.message);
  }
}

const PICTURE = /\.(png|npy)$/i;
const ROLES = { depth: /depth/i, mask: /mask/i, colour: /colou?r|rgb|image/i };
/** The kind of a file, from its own name or else its folder's, and the pair's name: the rest of the path without that word. */
function told(path) {
  const parts = path.replace(PICTURE, "").split("/");
  for (let k = parts.length - 1; k >= 0; k--) {
    const role = Object.keys(ROLES).find((each) => ROLES[each].test(parts[k]));
    if (!role) continue;
    parts[k] = parts[k].replace(ROLES[role], "").replace(/^[-_. ]+|[-_. ]+$|([-_. ])[-_. ]+/g, "$1");
    return { role, name: parts.filter(Boolean).join("/") || "pair" };
  }
  return { role: "colour", name: parts.join("/") };
}

/** Pairs by name, each with the paths of its files. */
function pairsBelow(folder) {
  const found = new Map();
  const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter(
    (entry) => entry.isFile() && PICTURE.test(entry.name),
  );
  const paths = files.map((entry) =>
    relative(folder, join(entry.parentPath ?? entry.path, entry.name)).replaceAll("\\", "/"),
  );
  for (const path of paths.sort()) {
    const { role, name } = told(path);
    const pair = found.get(name) ?? {};
    if (pair[role])
      throw new Mistake(`"${pair[role]}" and "${path}" are both the ${role} of "${name}": rename one of them`);
    found.set(name, { ...pair, [role]: path });
  }
  const pairs = [...found]
    .filter(([, { colour, depth }]) => colour && depth)
    .map(([name, paths]) => ({ name, ...paths }));
  if (pairs.length === 0)
    throw new Mistake(`${folder} contains no pair of a colour image and a depth map with similar names; see --help`);
  return pairs;
}

function threadsOf(text) {
  const count = text === undefined ? availableParallelism() : Number(text);
  if (!(Number.isInteger(count) && count > 0))
    throw new Mistake(`--threads needs a whole number above zero, not "${text}"`);
  return count;
}

function settingsOf(path) {
  if (path === undefined) return {};
  const text = readFileSync(path, "utf8");
  try {
    return { ...JSON.parse(text) };
  } catch (error) {
    throw new Mistake(`${path}: ${error.message}`);
  }
}

const HEAD = `${COLUMNS.join(",")}\n`;
/** The start of a cell that spreadsheets would run as a formula; after an apostrophe they take it as text. */
const FORMULA = /^(?=[=+\-@\t\r])/;
function cell(value) {
  const text = typeof value === "string" ? value.replace(FORMULA, "'") : String(value ?? "");
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
const lineOf = (row) => `${COLUMNS.map((column) => cell(row[column])).join(",")}\n`;

/** Name and status of the rows in an unfinished table; a last line that was cut off is removed. */
function begun(path) {
  if (!existsSync(path)) writeFileSync(path, HEAD);
  const text = readFileSync(path, "utf8");
  if (!text.startsWith(HEAD)) throw new Mistake(`${path} exists and is not a table of this program; name another file`);
  const lines = text.slice(HEAD.length).match(/(?:"(?:[^"]|"")*"|[^"\n])*\n/g) ?? [];
  truncateSync(path, Buffer.byteLength(HEAD + lines.join("")));
  return lines.map((line) => {
    const [, quoted, plain, status] = /^(?:"((?:[^"]|"")*)"|([^,]*)),([^,]*)/.exec(line);
    return { line, name: (quoted?.replaceAll('""', '"') ?? plain).replace(/^'(?=[=+\-@\t\r])/, ""), status };
  });
}

/** Distributes the pairs over threads and calls `done` with each row. A thread that dies only costs its pair. */
function onThreads(count, pairs, data, done) {
  const waiting = [...pairs];
  const threads = new Set();
  const serve = () =>
    new Promise((ended) => {
      let current;
      const thread = new Worker(new URL(import.meta.url), { workerData: data });
      threads.add(thread);
      const next = () => {
        current = waiting.shift();
        if (current) thread.postMessage(current);
        else thread.terminate();
      };
      let reason = "its thread ended";
      thread.on("message", (row) => {
        done(row);
        next();
      });
      thread.on("error", (error) => (reason = error.message));
      thread.on("exit", () => {
        threads.delete(thread);
        if (current) done({ name: current.name, status: "error", message: reason });
        ended(waiting.length > 0 ? serve() : undefined);
      });
      next();
    });
  const all = Promise.all(Array.from({ length: Math.min(count, pairs.length) }, serve));
  const stop = () => {
    waiting.length = 0;
    for (const thread of threads) thread.removeAllListeners("exit").terminate();
  };
  return { all, stop };
}

async function run(args) {
  const { values, positionals } = parsed(args);
  if (values.help) return void process.stdout.write(HELP);
  const [folder, ...rest] = positionals;
  if (folder === undefined || rest.length > 0)
    throw new Mistake(`one folder is needed, not ${positionals.length}; see --help`);
  if (!existsSync(folder) || !statSync(folder).isDirectory()) throw new Mistake(`${folder} is not a folder`);
  if (values.csv === undefined) throw new Mistake("--csv OUT.csv is needed; see --help");
  const [count, settings, pairs] = [threadsOf(values.threads), settingsOf(values.settings), pairsBelow(folder)];

  const rows = begun(values.csv);
  const kept = values.retry ? rows.filter(({ status }) => status !== "error") : rows;
  if (kept.length < rows.length) writeFileSync(values.csv, HEAD + kept.map(({ line }) => line).join(""));
  const known = new Set(kept.map(({ name }) => name));
  const open = pairs.filter(({ name }) => !known.has(name));
  let failures = kept.filter(({ status }) => status === "error").length;
  let done = 0;
  const bar = progress(process.stderr);
  bar.show(0, `${pairs.length - open.length} of ${pairs.length} pairs were done before`);
  const { all, stop } = onThreads(count, open, { folder, settings }, (row) => {
    appendFileSync(values.csv, lineOf(row));
    failures += row.status === "error" ? 1 : 0;
    done++;
    bar.show((pairs.length - open.length + done) / pairs.length, `${row.name}: ${row.status}`);
  });
  process.once("SIGINT", () => {
    stop();
    bar.end();
    process.stderr.write(
      `interrupted; the same command goes on after ${pairs.length - open.length + done} of ${pairs.length} pairs\n`,
    );
    process.exit(INTERRUPTED);
  });
  await all;
  bar.end();
  process.stdout.write(`${pairs.length} pairs in ${values.csv}, ${failures} of them failed\n`);
  process.exitCode = failures > 0 ? FAILED : 0;
}

/** Takes one pair from its files to its row. */
async function registered({ name, colour, depth, mask }) {
  const { folder, settings } = workerData;
  const bytes = (path) => readFileSync(join(folder, path));
  await init();
  const image = { ...decodeColour(bytes(colour)), ...(mask && { mask: maskOf(bytes(mask)) }), ...settings.image };
  const estimator = new Estimator(image, { ...decodeDepth(bytes(depth)), ...settings.depth }, settings.options);
  try {
    const { status, pose, uncertainty, iteration, residual, message } = await estimator.run();
    const {
      scale,
      angles,
      translation: [x, y, z],
    } = pose;
    const [sigma_x_degrees, sigma_y_degrees, sigma_z_degrees] = uncertainty?.rotationDegrees ?? [];
    return {
      name,
      status,
      scale,
      ...angles,
      x,
      y,
      z,
      sigma_x_degrees,
      sigma_y_degrees,
      sigma_z_degrees,
      iterations: iteration,
      residual,
      message,
    };
  } finally {
    estimator.free();
  }
}

const maskOf = (bytes) => decodeMask(bytes).data;

if (isMainThread) {
  try {
    await run(process.argv.slice(2));
  } catch (error) {
    const isForeseen = error instanceof Mistake || error?.syscall !== undefined;
    process.stderr.write(`${isForeseen ? error.message : (error?.stack ?? error)}\n`);
    process.exitCode = BAD;
  }
} else {
  parentPort.on("message", async (pair) => {
    const row = await registered(pair).catch((error) => ({ name: pair.name, status: "error", message: error.message }));
    parentPort.postMessage(row);
  });
}
