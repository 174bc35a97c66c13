/**
 * What is checked before wasm sees it: names and types, because a misspelt key or a string for a number would pass in
 * silence or fail without a name, and whatever the rows of the options say. What lies in rasters is checked in Rust.
 */
import { BimodalError } from "./errors.js";
import { OPTIONS, RENDERED_ALONE, SAMPLE } from "./options.js";
import type { NumberRow, Row, Rows, WordRow } from "./rows.js";

/** Checks one value; `field` is its path in the contract. */
export type Check = (value: unknown, field: string) => void;
type Shape = Readonly<Record<string, Check>>;

export const isObject = (value: unknown): value is object => typeof value === "object" && value !== null;

function kind(value: unknown): string {
  if (value === null) return "null";
  if (isObject(value)) return value.constructor?.name ?? "an object";
  return typeof value;
}

export const wrong = (field: string, expected: string, value: unknown) =>
  new BimodalError("type", `${field}: must be ${expected}, not ${kind(value)}`, field);

export const number: Check = (value, field) => {
  if (typeof value !== "number") throw wrong(field, "a number", value);
};

export const flag: Check = (value, field) => {
  if (typeof value !== "boolean") throw wrong(field, "true or false", value);
};

/** The range of a number in words. */
function range({ kind, min, above, max, below, unit = "" }: NumberRow): string {
  const what = kind === "number" ? "a finite number" : "a whole number";
  // A unit follows a number, not a zero in words.
  const end = unit && (max ?? below ?? above ?? min) ? ` ${unit}` : "";
  if (min && max) return `${what}, ${min} .. ${max}${end}`;
  const named = (limit: number) => (limit === 0 ? "zero" : `${limit}`);
  const from = above !== undefined ? ` above ${named(above)}` : min !== undefined ? `, ${named(min)} or above` : "";
  const to = max !== undefined ? `, at most ${max}` : below !== undefined ? `, below ${below}` : "";
  return what + from + to + end;
}

/** A number in its range. JavaScript has one type for all numbers, the numerics have none for halves and infinities. */
export const ranged = (row: NumberRow): Check => (value, field) => {
  if (typeof value !== "number") throw wrong(field, "a number", value);
  const { kind, min = -Infinity, above = -Infinity, max = Infinity, below = Infinity } = row;
  const isWhole = Number.isInteger(value);
  const isKind = kind === "number" ? Number.isFinite(value) : isWhole;
  if (isKind && value >= min && value > above && value <= max && value < below) return;
  const code = kind === "side" && isWhole && value >= 0 ? "size" : "range";
  throw new BimodalError(code, `${field}: must be ${range(row)} (got ${value})`, field);
};

/** A list of so many numbers, typed arrays included. Its length comes first: what claims to be longer is not copied. */
export const numbers = (count: number): Check => (value, field) => {
  const length = isObject(value) && "length" in value ? value.length : undefined;
  if (typeof length !== "number") throw wrong(field, "a list of numbers", value);
  if (length !== count) throw new BimodalError("size", `${field}: needs ${count} numbers, not ${length}`, field);
  const copy: unknown[] = Array.from({ ...Object(value), length });
  if (!copy.every((item) => typeof item === "number")) throw wrong(field, "a list of numbers", value);
};

type ArrayType = { readonly name: string; new (length: number): ArrayBufferView };

/** A typed array of one of the given kinds. */
export const array = (...types: readonly ArrayType[]): Check => (value, field) => {
  if (!types.some((type) => value instanceof type)) {
    throw wrong(field, types.map((type) => `a ${type.name}`).join(" or "), value);
  }
};

/** One of some words. */
export const word = (...words: readonly string[]): Check => (value, field) => {
  if (typeof value !== "string") throw wrong(field, words.map((w) => `"${w}"`).join(" or "), value);
  if (!words.includes(value)) {
    throw new BimodalError("option", `${field}: "${value}" is unknown${hint(value, words)}`, field);
  }
};

/** A word, or else something that is no word. */
const wordOr = (words: readonly string[], other: Check, orElse: string): Check => (value, field) => {
  if (typeof value !== "string") return other(value, field);
  if (words.includes(value)) return;
  const allowed = words.map((known) => `"${known}"`).join(", ");
  throw new BimodalError("option", `${field}: "${value}" is unknown; known: ${allowed} or ${orElse}`, field);
};

/** Edits that turn one word into the other (Levenshtein). */
function distance(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j);
  for (let i = 1; i <= a.length; i++) {
    const next = [i];
    for (let j = 1; j <= b.length; j++) {
      const replaced = (row[j - 1] ?? 0) + (a[i - 1] === b[j - 1] ? 0 : 1);
      next.push(Math.min(replaced, (row[j] ?? 0) + 1, (next[j - 1] ?? 0) + 1));
    }
    row = next;
  }
  return row[b.length] ?? 0;
}

/** Beyond three edits a guess confuses more than it helps. */
const LIKELY_EDITS = 3;

function hint(given: string, known: readonly string[]): string {
  const ranked = known
    .map((name) => ({ name, edits: distance(given.toLowerCase(), name.toLowerCase()) }))
    .sort((a, b) => a.edits - b.edits);
  const best = ranked[0];
  if (best && best.edits <= Math.min(LIKELY_EDITS, given.length - 1)) return `; did you mean "${best.name}"?`;
  return `; known: ${known.join(", ")}`;
}

/** An object with these keys and no others; `undefined` counts as absent. */
export const object = (shape: Shape, required: readonly string[] = []): Check => (value, field) => {
  if (!isObject(value) || Array.isArray(value) || ArrayBuffer.isView(value)) throw wrong(field, "an object", value);
  for (const [key, member] of Object.entries(value)) {
    const check = Object.hasOwn(shape, key) ? shape[key] : undefined;
    const path = `${field}.${key}`;
    if (!check) {
      throw new BimodalError("option", `${path}: there is no such key${hint(key, Object.keys(shape))}`, path);
    }
    if (member !== undefined) check(member, path);
  }
  const members = new Map<string, unknown>(Object.entries(value));
  for (const key of required) {
    if (members.get(key) === undefined) {
      throw new BimodalError("missing", `${field}.${key}: is required`, `${field}.${key}`);
    }
  }
};

/** Beyond it the numerics, which count in 32 bits, would take another number for it; their own limits are far below. */
const side = ranged({ kind: "side", min: 0, max: 2 ** 32 - 1 });
const camera = object({ fx: number, fy: number, cx: number, cy: number, distortion: numbers(5) }, ["fx", "fy", "cx", "cy"]);

/** An image and a depth map but for their cameras. */
export const IMAGE = {
  width: side,
  height: side,
  mask: array(Uint8Array),
  transfer: word("srgb", "linear"),
  data: array(Uint8Array, Uint8ClampedArray, Uint16Array, Float32Array),
};
export const DEPTH = {
  width: side,
  height: side,
  mask: array(Uint8Array),
  unit: number,
  data: array(Float32Array, Uint16Array),
  points: array(Float32Array),
};

const image = object({ ...IMAGE, camera }, ["width", "height", "data"]);
const depth = object({ ...DEPTH, camera, normals: array(Float32Array) }, ["width", "height"]);

/** The check of a value that is no word, and what it takes, with an article. */
function valueOf(row: Exclude<Row, WordRow>): readonly [check: Check, what: string] {
  switch (row.kind) {
    case "flag":
      return [flag, "a flag"];
    case "list":
      return [numbers(row.length), `${row.length} numbers`];
    case "object":
      return [object(shapeOf(row.members)), row.noun];
    default:
      return [ranged(row), "a number"];
  }
}

function checkOf(row: Row): Check {
  const words = Object.keys(row.words ?? {});
  if (row.kind === "word") return word(...words);
  const [check, what] = valueOf(row);
  return words.length === 0 ? check : wordOr(words, check, what);
}

const shapeOf = (rows: Rows): Shape => Object.fromEntries(Object.entries(rows).map(([name, row]) => [name, checkOf(row)]));

const options = object(shapeOf(OPTIONS));

const light = checkOf(OPTIONS.light);
const relief = object({ width: side, height: side, heights: array(Float32Array) }, ["width", "height", "heights"]);
/** A name, which the numerics judge, or something that is none. */
const nameOr = (other: Check): Check => (value, field) => {
  if (typeof value !== "string") other(value, field);
};
const sample = object({ surface: nameOr(relief), light: nameOr(light), ...shapeOf(SAMPLE) }, ["surface", "light"]);

export const signal: Check = (value, field) => {
  if (!(value instanceof AbortSignal)) throw wrong(field, "an AbortSignal", value);
};
export const callback: Check = (value, field) => {
  if (typeof value !== "function") throw wrong(field, "a function", value);
};
const run = object({ maxIterations: ranged({ kind: "whole", min: 1 }), signal, onStep: callback });

export const unsupported = (field: string, what: string): BimodalError =>
  new BimodalError("unsupported", `${field}: ${what} is not part of this version yet`, field);

export const checkImage = (value: unknown): void => image(value, "image");
export const checkDepth = (value: unknown): void => depth(value, "depth");
export const checkOptions = (value: unknown): void => options(value, "options");
export const checkRun = (value: unknown): void => run(value, "run");

export function checkSample(value: unknown): void {
  sample(value, "sample");
  if (!isObject(value)) return;
  const given = new Map<string, unknown>(Object.entries(value));
  if (given.get("protocol") !== "grid") return;
  const surplus = RENDERED_ALONE.find((key) => given.get(key) !== undefined);
  if (surplus === undefined) return;
  throw new BimodalError("option", `sample.${surplus}: the grid protocol has no such thing`, `sample.${surplus}`);
}

export const checkLightIsKnown = (value: unknown): void => flag(value, "lightIsKnown");
