/** Checks the loop's inputs: names, types, and the rules in the rows of the options. */
import { camera } from "./cameras.js";
import {
  type Check,
  DEPTH,
  IMAGE,
  type Shape,
  array,
  brief,
  callback,
  flag,
  isObject,
  matrix,
  numbers,
  object,
  ranged,
  side,
  signal,
  word,
} from "./check.js";
import { BimodalError } from "./errors.js";
import { poseOf } from "./matrices.js";
import { OPTIONS, POSE, RENDERED_ALONE, SAMPLE } from "./options.js";
import type { Row, Rows, WordRow } from "./rows.js";

/** A word, or a value of another type. */
const wordOr =
  (words: readonly string[], other: Check, orElse: string): Check =>
  (value, field) => {
    if (typeof value !== "string") return other(value, field);
    if (words.includes(value)) return;
    const allowed = words.map((known) => `"${known}"`).join(", ");
    throw new BimodalError("option", `${field}: "${brief(value)}" is unknown; known: ${allowed} or ${orElse}`, field);
  };

/** The check of a value other than a word, and the type that it accepts, with an article. */
function valueOf(row: Exclude<Row, WordRow>): readonly [check: Check, what: string] {
  switch (row.kind) {
    case "flag":
      return [flag, "a flag"];
    case "list":
      return [numbers(row.length), `${row.length} numbers`];
    case "matrix":
      return [matrix(row.side), `${row.side}x${row.side} numbers`];
    case "object":
      return [object(shapeOf(row.members), row.required), row.noun];
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

const shapeOf = (rows: Rows): Shape =>
  Object.fromEntries(Object.entries(rows).map(([name, row]) => [name, checkOf(row)]));

/** A name, which the numerics check, or a value of another kind. */
const nameOr =
  (other: Check): Check =>
  (value, field) => {
    if (typeof value !== "string") other(value, field);
  };

/** Checks the value to which a matrix is converted. */
const of =
  (members: (value: unknown, field: string) => unknown, check: Check): Check =>
  (value, field) =>
    check(members(value, field), field);

function inputs() {
  const relief = object({ width: side, height: side, heights: array(Float32Array) }, ["width", "height", "heights"]);
  return {
    image: object({ ...IMAGE, camera }, ["width", "height", "data"]),
    depth: object({ ...DEPTH, camera, normals: array(Float32Array) }, ["width", "height"]),
    options: object({ ...shapeOf(OPTIONS), start: of(poseOf, checkOf(OPTIONS.start)) }),
    sample: object({ surface: nameOr(relief), light: nameOr(checkOf(OPTIONS.light)), ...shapeOf(SAMPLE) }, [
      "surface",
      "light",
    ]),
    draw: object({ range: numbers(2), map: word("viridis", "magma") }),
    run: object({ maxIterations: ranged({ kind: "whole", min: 1 }), signal, onStep: callback }),
    restore: object({ signal }),
  };
}
let made: ReturnType<typeof inputs> | undefined;
/** The checks are made on first use, so that bundlers leave them out of code that only checks a rig. */
const checks = (): ReturnType<typeof inputs> => (made ??= inputs());

export const checkImage = (value: unknown): void => checks().image(value, "image");
export const checkDepth = (value: unknown): void => checks().depth(value, "depth");
export const checkOptions = (value: unknown): void => checks().options(value, "options");
export const checkDraw = (value: unknown): void => checks().draw(value, "options");
export const checkLayer: (value: unknown) => void = (value) =>
  word("normals", "depth", "residual", "refined", "refinedNormals")(value, "layer");
export const checkRestore = (value: unknown): void => checks().restore(value, "options");
export const checkRun = (value: unknown): void => checks().run(value, "run");

export function checkSample(value: unknown): void {
  checks().sample(value, "sample");
  if (!isObject(value)) return;
  const given = new Map<string, unknown>(Object.entries(value));
  if (given.get("protocol") !== "grid") return;
  const surplus = RENDERED_ALONE.find((key) => given.get(key) !== undefined);
  if (surplus === undefined) return;
  throw new BimodalError("option", `sample.${surplus}: the grid protocol has no such option`, `sample.${surplus}`);
}

export const checkLightIsKnown = (value: unknown): void => flag(value, "lightIsKnown");
/** The check of a light to turn or to shade with: a name, or 27 numbers. */
export const checkLight = (value: unknown): void => nameOr(numbers(27))(value, "light");
export const checkAngles = (value: unknown): void => checkOf(POSE.angles)(value, "angles");
/** Checks that a list of normals has three numbers for each. */
export const checkNormals = (value: unknown): void => {
  array(Float32Array)(value, "normals");
  const { length } = value as Float32Array;
  if (length % 3 !== 0)
    throw new BimodalError("size", `normals: needs three numbers for each normal, not ${length} in all`, "normals");
};
