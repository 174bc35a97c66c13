/**
 * Checks names and types before wasm reads them. A misspelt key or a string in place of a number would otherwise be ignored or cause an
 * error without a name. Values in rasters are checked in Rust.
 */
import { BimodalError, refused } from "./errors.js";
import type { NumberRow } from "./rows.js";

/** A check of one value; `field` is its path in the contract. */
export type Check = (value: unknown, field: string) => void;
export type Shape = Readonly<Record<string, Check>>;

export const isObject = (value: unknown): value is object => typeof value === "object" && value !== null;

function kind(value: unknown): string {
  if (value === null) return "null";
  if (isObject(value)) return value.constructor?.name ?? "an object";
  return typeof value;
}

/** `index` is the position of the wrong entry, if only one entry has another type. */
export const wrong = (field: string, expected: string, value: unknown, index?: number) =>
  new BimodalError("type", `${field}: must be ${expected}, not ${kind(value)}`, field, refused(value, index));

export const number: Check = (value, field) => {
  if (typeof value !== "number") throw wrong(field, "a number", value);
};

export const flag: Check = (value, field) => {
  if (typeof value !== "boolean") throw wrong(field, "true or false", value);
};

/** The range of a number in words. */
function range({ kind, min, above, max, below, unit = "" }: NumberRow): string {
  const what = kind === "number" ? "a finite number" : "a whole number";
  // A unit follows a number, but not the word "zero".
  const end = unit && (max ?? below ?? above ?? min) ? ` ${unit}` : "";
  // The test also refuses NaN and infinities.
  if (min && max) return `${kind === "number" ? "a number" : what} from ${min} to ${max}${end}`;
  const named = (limit: number) => (limit === 0 ? "zero" : `${limit}`);
  const from = above !== undefined ? ` above ${named(above)}` : min !== undefined ? `, ${named(min)} or above` : "";
  const to = max !== undefined ? `, at most ${max}` : below !== undefined ? `, below ${below}` : "";
  return what + from + to + end;
}

/** A number in its range. JavaScript has one type for all numbers; the numerics do not accept fractions or infinities everywhere. */
export const ranged =
  (row: NumberRow): Check =>
  (value, field) => {
    if (typeof value !== "number") throw wrong(field, "a number", value);
    const { kind, min = -Infinity, above = -Infinity, max = Infinity, below = Infinity } = row;
    const isWhole = Number.isInteger(value);
    const isKind = kind === "number" ? Number.isFinite(value) : isWhole;
    if (isKind && value >= min && value > above && value <= max && value < below) return;
    const code = kind === "side" && isWhole && value >= 0 ? "size" : "range";
    throw new BimodalError(code, `${field}: must be ${range(row)} (got ${value})`, field, refused(value));
  };

/** A list of this many numbers, or a typed array. Its length is checked first, so that a longer list is not copied. */
export const numbers =
  (count: number): Check =>
  (value, field) => {
    const length = isObject(value) && "length" in value ? value.length : undefined;
    if (typeof length !== "number") throw wrong(field, "a list of numbers", value);
    if (length !== count) throw new BimodalError("size", `${field}: needs ${count} numbers, not ${length}`, field);
    const copy: unknown[] = Array.from({ ...Object(value), length });
    const other = copy.findIndex((item) => typeof item !== "number");
    if (other >= 0) throw wrong(field, `a list of numbers, with entry ${other}`, copy[other], other);
  };

/** A square matrix: a list of all its numbers, or a list of its rows. */
export const matrix =
  (side: number): Check =>
  (value, field) => {
    const rows =
      isObject(value) && "length" in value && value.length === side
        ? Array.from({ ...Object(value), length: side })
        : [];
    if (!rows.some(isObject)) return numbers(side * side)(value, field);
    for (const [index, row] of rows.entries()) numbers(side)(row, `${field}[${index}]`);
  };

export type ArrayType = { readonly name: string; new (length: number): ArrayBufferView };

const TYPED_ARRAY: object = Object.getPrototypeOf(Uint8Array.prototype);

/** Whether a typed array has the length that it reports: the numerics allocate that length before they copy the data. */
function hasItsLength(value: object): boolean {
  try {
    return Reflect.get(TYPED_ARRAY, "length", value) === Reflect.get(value, "length");
  } catch {
    return false;
  }
}

/** Whether the memory of an empty typed array was transferred: copying from such an array is an error. */
function isLost(value: ArrayLike<number>): boolean {
  try {
    new Uint8Array(0).set(value);
    return false;
  } catch {
    return true;
  }
}

/** A typed array of one of the given kinds. */
export const array =
  (...types: readonly ArrayType[]): Check =>
  (value, field) => {
    if (!types.some((type) => value instanceof type)) {
      throw wrong(field, types.map((type) => `a ${type.name}`).join(" or "), value);
    }
    const given = value as object & ArrayLike<number>;
    if (!hasItsLength(given)) throw wrong(field, "a typed array of the length that it reports", value);
    if (given.length === 0 && isLost(given)) {
      throw new BimodalError("empty", `${field}: its memory was moved to another thread or shrunk`, field);
    }
  };

/** Longest word that a message repeats and compares with the known ones. */
const LONGEST_WORD = 60;
export const brief = (given: string): string =>
  given.length > LONGEST_WORD ? `${given.slice(0, LONGEST_WORD)}..` : given;

/** Checks that a value is one of some words. */
export const word =
  (...words: readonly string[]): Check =>
  (value, field) => {
    if (typeof value !== "string") throw wrong(field, words.map((w) => `"${w}"`).join(" or "), value);
    if (!words.includes(value)) {
      const given = brief(value);
      throw new BimodalError("option", `${field}: "${given}" is unknown${hint(given, words)}`, field);
    }
  };

/** Number of edits that turn one word into the other (Levenshtein). */
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
export const object =
  (shape: Shape, required: readonly string[] = []): Check =>
  (value, field) => {
    if (!isObject(value) || Array.isArray(value) || ArrayBuffer.isView(value)) throw wrong(field, "an object", value);
    for (const [key, member] of Object.entries(value)) {
      const check = Object.hasOwn(shape, key) ? shape[key] : undefined;
      const given = brief(key);
      const path = `${field}.${given}`;
      if (!check) {
        throw new BimodalError("option", `${path}: unknown key${hint(given, Object.keys(shape))}`, path);
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

/** The numerics count in 32 bits and would misread a larger number. Their own limits are far lower. */
export const side = ranged({ kind: "side", min: 0, max: 2 ** 32 - 1 });

/** An image and a depth map without their cameras. */
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
  intensity: array(Float32Array),
};

export const signal: Check = (value, field) => {
  if (!(value instanceof AbortSignal)) throw wrong(field, "an AbortSignal", value);
};
export const callback: Check = (value, field) => {
  if (typeof value !== "function") throw wrong(field, "a function", value);
};
