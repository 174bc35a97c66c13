// Results as they come, one JSON line each, so that an interrupted run continues where it stopped.
import { createHash } from "node:crypto";
import { appendFileSync, existsSync, mkdirSync, readFileSync } from "node:fs";
import { inRoot, matching, stamp } from "../shell.mjs";
import { hasData } from "./library.mjs";

const FOLDER = "target/tables";
/** Everything that determines a result: the package (or its scripts and another .wasm), the protocols, and the data behind the names. */
const decisive = (wasm) => [
  ...matching(["pkg"], wasm ? /\.js$/ : /\.(js|wasm)$/),
  ...(wasm ? [wasm] : []),
  ...["protocols", "scripts/tables/library.mjs", "scripts/tables/npy.mjs"],
];

const keyOf = (cell) => createHash("sha256").update(JSON.stringify(cell)).digest("hex").slice(0, 16);

/** A line cut off by Ctrl-C is skipped. */
function parsed(line) {
  try {
    return JSON.parse(line);
  } catch {
    return undefined;
  }
}

/** The journal of this package and these protocols; another build or another .wasm starts a new one. */
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
      // Failed cells are tried again by the next run.
      if (!result.failure) appendFileSync(path, `\n${JSON.stringify({ id: cell.id, key: keyOf(cell), result })}`);
    },
  };
}
