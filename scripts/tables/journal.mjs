// Results as they come, one JSON line each, so that a run that was broken off goes on where it was.
import { createHash } from "node:crypto";
import { appendFileSync, existsSync, mkdirSync, readFileSync } from "node:fs";
import { inRoot, matching, stamp } from "../shell.mjs";
import { hasData } from "./library.mjs";

const FOLDER = "target/tables";
/** What decides about a result: the package, or its scripts and a .wasm in place of its own, the protocols, and what the names stand for. */
const decisive = (wasm) => [
  ...matching(["pkg"], wasm ? /\.js$/ : /\.(js|wasm)$/),
  ...(wasm ? [wasm] : []),
  ...["protocols", "scripts/tables/library.mjs", "scripts/tables/npy.mjs"],
];

const keyOf = (cell) => createHash("sha256").update(JSON.stringify(cell)).digest("hex").slice(0, 16);

/** A line that Ctrl-C has cut off is no result. */
function parsed(line) {
  try {
    return JSON.parse(line);
  } catch {
    return undefined;
  }
}

/** The journal of this very package and these very protocols; another build begins another one, and so does another .wasm. */
export function openJournal(wasm) {
  const path = inRoot(FOLDER, `${stamp(decisive(wasm)).slice(0, 16)}${hasData() ? "" : "-built-in"}.jsonl`);
  mkdirSync(inRoot(FOLDER), { recursive: true });
  const lines = existsSync(path) ? readFileSync(path, "utf8").split("\n").map(parsed).filter(Boolean) : [];
  const results = new Map(lines.map(({ key, result }) => [key, result]));
  return {
    path,
    find: (cell) => results.get(keyOf(cell)),
    keep(cell, result) {
      results.set(keyOf(cell), result);
      // What failed is tried again by the next run.
      if (!result.failure) appendFileSync(path, `\n${JSON.stringify({ id: cell.id, key: keyOf(cell), result })}`);
    },
  };
}
