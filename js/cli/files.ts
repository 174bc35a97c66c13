/** Files of a folder with their bytes. */
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { join, relative, resolve } from "node:path";
import type { NamedFile, Reading } from "../rig/types.js";
import { reasonOf } from "../errors.js";
import { Mistake } from "./arguments.js";

/** Largest number of bytes in a folder, because all files are read: enough for some hundreds of pairs. */
const MOST_BYTES = 2 ** 31;

export const file = (path: string, name = path): NamedFile => ({
  name: name.replaceAll("\\", "/").replace(/^\.\//, ""),
  bytes: new Uint8Array(contentOf(path)),
});

function contentOf(path: string): Uint8Array {
  try {
    return readFileSync(path);
  } catch (error) {
    throw new Mistake(`${path}: it cannot be read (${reasonOf(error)})`, "file");
  }
}

const isHidden = (folder: string, path: string): boolean =>
  relative(folder, path)
    .split(/[\\/]/)
    .some((part) => part.startsWith("."));

/** The files below a folder by name, without hidden ones and without those of `except`. */
export function filesOf(folder: string, except: string[]): NamedFile[] {
  const left = new Set(except.map((path) => resolve(path)));
  const paths = readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name))
    .filter((path) => !isHidden(folder, path) && !left.has(resolve(path)))
    .sort();
  const bytes = paths.reduce((sum, path) => sum + statSync(path).size, 0);
  if (bytes > MOST_BYTES) {
    const size = (bytes / 2 ** 30).toFixed(1);
    throw new Mistake(
      `${folder}: it holds ${size} GB, but at most ${MOST_BYTES / 2 ** 30} are read: copy some of its pairs into a separate folder`,
      "file",
    );
  }
  return paths.map((path) => file(path, relative(folder, path)));
}

export interface Input {
  name: string;
  says: string;
  sha256: string;
  bytes: number;
  /** The codes of the warnings about the file, including guesses. */
  notes: string[];
}

/** A description of each file that was read, with a hash that identifies the file later. */
export function inputsOf(readings: Reading[], files: NamedFile[]): Input[] {
  const bytes = new Map(files.map((each) => [each.name, each.bytes]));
  const seen = new Map<string, Input>();
  for (const { name, says, warnings } of readings) {
    const own = bytes.get(name);
    const sha256 = own && createHash("sha256").update(own).digest("hex");
    if (sha256)
      seen.set(name, { name, says, sha256, bytes: own.length, notes: [...new Set(warnings.map(({ code }) => code))] });
  }
  return [...seen.values()];
}
