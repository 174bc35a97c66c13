/**
 * Names and types, checked before wasm sees them: a misspelt key or a string for a number would otherwise pass in
 * silence or fail without a name. Values (ranges, lengths, finiteness) are checked in Rust, once, but for those that it
 * never sees or could not take in.
 */
import { BimodalError } from "./errors.js";

/** Checks one value; `field` is its path in the contract. */
type Check = (value: unknown, field: string) => void;
type Shape = Readonly<Record<string, Check>>;

const isObject = (value: unknown): value is object => typeof value === "object" && value !== null;

function kind(value: unknown): string {
  if (value === null) return "null";
  if (isObject(value)) return value.constructor?.name ?? "an object";
  return typeof value;
}

const wrong = (field: string, expected: string, value: unknown) =>
  new BimodalError("type", `${field}: must be ${expected}, not ${kind(value)}`, field);

const number: Check = (value, field) => {
  if (typeof value !== "number") throw wrong(field, "a number", value);
};

const flag: Check = (value, field) => {
  if (typeof value !== "boolean") throw wrong(field, "true or false", value);
};

/** Counts and seeds: JavaScript has one type for all numbers, the numerics have none for halves and infinities. */
const whole: Check = (value, field) => {
  number(value, field);
  if (typeof value === "number" && !(Number.isSafeInteger(value) && value >= 0)) {
    throw new BimodalError("range", `${field}: must be a whole number, 0 .. 2^53 - 1 (got ${value})`, field);
  }
};

/** Beyond it the numerics, which count in 32 bits, would take another number for it; their own limits are far below. */
const LARGEST_COUNT = 2 ** 32 - 1;
/** A whole number that fits 32 bits, or what a larger one is refused with. */
const within = (code: "size" | "range"): Check => (value, field) => {
  whole(value, field);
  if (typeof value === "number" && value > LARGEST_COUNT) {
    throw new BimodalError(code, `${field}: is far too large (got ${value})`, field);
  }
};
const side = within("size");

/** A list of so many numbers, typed arrays included. Its length comes first: what claims to be longer is not copied. */
const numbers = (count: number): Check => (value, field) => {
  const length = isObject(value) && "length" in value ? value.length : undefined;
  if (typeof length !== "number") throw wrong(field, "a list of numbers", value);
  if (length !== count) throw new BimodalError("size", `${field}: needs ${count} numbers, not ${length}`, field);
  const copy: unknown[] = Array.from({ ...Object(value), length });
  if (!copy.every((item) => typeof item === "number")) throw wrong(field, "a list of numbers", value);
};

/** More is a mistake, no turn; far beyond, a sine means nothing. */
const FULL_TURN = 360;
/** An angle in degrees; here, because only the rotation that it makes is handed on. */
const degrees: Check = (value, field) => {
  number(value, field);
  if (typeof value === "number" && !(Math.abs(value) <= FULL_TURN)) {
    const message = `${field}: must lie within -${FULL_TURN} .. ${FULL_TURN} degrees (got ${value})`;
    throw new BimodalError("range", message, field);
  }
};

type ArrayType = { readonly name: string; new (length: number): ArrayBufferView };

/** A typed array of one of the given kinds. */
const array = (...types: readonly ArrayType[]): Check => (value, field) => {
  if (!types.some((type) => value instanceof type)) {
    throw wrong(field, types.map((type) => `a ${type.name}`).join(" or "), value);
  }
};

/** One of some words. */
const word = (...words: readonly string[]): Check => (value, field) => {
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
const object = (shape: Shape, required: readonly string[] = []): Check => (value, field) => {
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

const camera = object({ fx: number, fy: number, cx: number, cy: number, distortion: numbers(5) }, ["fx", "fy", "cx", "cy"]);
const angles = object({ alpha: degrees, beta: degrees, gamma: degrees });
const pose = object({ scale: number, rotation: numbers(9), translation: numbers(3), angles });
/** Nine coefficients for each of three channels. */
const light = numbers(27);
const lambda = object({ prior: number, unit: number, light: number, refinement: number });

const image = object(
  {
    width: side,
    height: side,
    mask: array(Uint8Array),
    camera,
    transfer: word("srgb", "linear"),
    data: array(Uint8Array, Uint8ClampedArray, Uint16Array, Float32Array),
  },
  ["width", "height", "data"],
);

const depth = object(
  {
    width: side,
    height: side,
    mask: array(Uint8Array),
    camera,
    unit: number,
    data: array(Float32Array, Uint16Array),
    points: array(Float32Array),
    normals: array(Float32Array),
  },
  ["width", "height"],
);

/** More threads than this wait for one another. */
const MOST_WORKERS = 16;
/** A number that never reaches the numerics, and so is judged here. */
const count: Check = (value, field) => {
  number(value, field);
  if (typeof value === "number" && !(Number.isInteger(value) && value > 0)) {
    throw new BimodalError("range", `${field}: must be a whole number above zero (got ${value})`, field);
  }
};

const options = object({
  light: wordOr(["estimate"], light, "27 numbers"),
  start: wordOr(["search", "identity"], pose, "a pose"),
  scale: wordOr(["free"], number, "a number"),
  registration: word("joint", "icp", "fixed"),
  shading: word("surface", "pixel"),
  lambda,
  stopDegrees: number,
  correspondenceDistance: number,
  maxIterations: within("range"),
  seed: whole,
  annealing: flag,
  trim: flag,
  workers: (value, field) => {
    count(value, field);
    if (typeof value === "number" && value > MOST_WORKERS) {
      throw new BimodalError("range", `${field}: at most ${MOST_WORKERS} (got ${value})`, field);
    }
  },
});

const relief = object({ width: side, height: side, heights: array(Float32Array) }, ["width", "height", "heights"]);
const sample = object(
  {
    surface: (value, field) => {
      if (typeof value !== "string") relief(value, field);
    },
    light: (value, field) => {
      if (typeof value !== "string") light(value, field);
    },
    size: side,
    height: side,
    protocol: word("rendered", "grid"),
    angles,
    scale: number,
    overlap: number,
    noise: number,
    depthNoise: number,
    holes: number,
    seed: whole,
  },
  ["surface", "light"],
);

/** What the grid protocol has no use for: it would be ignored in silence. */
const RENDERED_ALONE = ["size", "height", "scale", "noise", "depthNoise", "holes", "seed"];

const signal: Check = (value, field) => {
  if (!(value instanceof AbortSignal)) throw wrong(field, "an AbortSignal", value);
};
const callback: Check = (value, field) => {
  if (typeof value !== "function") throw wrong(field, "a function", value);
};
const run = object({ maxIterations: count, signal, onStep: callback });

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
