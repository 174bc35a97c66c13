// Builds the .wasm of the method without one part, from a copy of the sources.
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { gzipSync } from "node:zlib";
import { NUMERICS, numericsOf } from "../numerics.mjs";
import { filesBelow, inRoot, readIfThere, root, say, seconds, stamp } from "../shell.mjs";
import { without } from "./parts.mjs";

const FOLDER = "target/ablation";
const SOURCES = `${FOLDER}/sources`;
/** The files of the workspace that Cargo reads. */
const COPIED = ["src", "benches", "cli", "Cargo.toml", "Cargo.lock", "README.md"];

const below = (paths) => paths.flatMap((path) => filesBelow(inRoot(path))).map((path) => path.slice(root.length + 1));

/** Copies the sources without a part. Unchanged files are left untouched, because Cargo recompiles newer files. */
function copy(part) {
  const files = new Set(below(COPIED));
  const missing = part.changes.find(({ file }) => !files.has(file));
  if (missing) throw new Error(`the part "${part.name}" names ${missing.file}, which is not there`);
  for (const old of below([SOURCES])) if (!files.has(old.slice(SOURCES.length + 1))) rmSync(inRoot(old));
  for (const file of files) {
    const to = inRoot(SOURCES, file);
    const text = without(part, file, readFileSync(inRoot(file), "utf8"));
    if (readIfThere(to) === text) continue;
    mkdirSync(dirname(to), { recursive: true });
    writeFileSync(to, text);
  }
}

const fileOf = (part) => `${FOLDER}/${part.name}.wasm`;
const markOf = (part) => inRoot(`${FOLDER}/.${part.name}.stamp`);
const wantedOf = (part) => stamp(NUMERICS) + JSON.stringify(part.changes);

/** Path and gzipped size of the .wasm, if it was built from the present sources. */
export function built(part) {
  const wasm = fileOf(part);
  if (readIfThere(markOf(part)) !== wantedOf(part) || !existsSync(inRoot(wasm))) return undefined;
  return { wasm, gzipped: gzipSync(readFileSync(inRoot(wasm))).length };
}

/** Path and gzipped size of the .wasm, which is built first if the sources or the part have changed. */
export async function variant(part) {
  if (!built(part)) {
    const start = performance.now();
    rmSync(markOf(part), { force: true });
    copy(part);
    await numericsOf({ sources: SOURCES, target: join(FOLDER, "build"), file: fileOf(part).slice("target/".length) });
    writeFileSync(markOf(part), wantedOf(part));
    say(`built it (${seconds(start)})`);
  }
  return built(part);
}
