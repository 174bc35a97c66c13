/**
 * Converts inputs to plain objects with only the members of the contract. A class with getters, a proxy or shared memory would look
 * different in another thread.
 */
import { cameraOf, poseOf } from "./matrices.js";
import { OPTIONS, type PlainOptions } from "./options.js";
import type { Row, Rows } from "./rows.js";
import type {
  ColorImage,
  ColorImageInput,
  DepthMap,
  DepthMapInput,
  Options,
  Pinhole,
  PinholeInput,
} from "./types/index.js";

/** Some members of an object, inherited ones as well, without those that are undefined. */
function pick<T extends object, K extends keyof T>(source: T, keys: readonly K[]): Pick<T, K> {
  return Object.fromEntries(keys.map((key) => [key, source[key]]).filter(([, value]) => value !== undefined)) as Pick<
    T,
    K
  >;
}

/** The members among these that are present, as plain objects. */
function plainMember<T extends object, K extends keyof T>(
  source: T,
  key: K,
  plain: (value: NonNullable<T[K]>) => unknown,
): object {
  const value = source[key];
  return value === undefined || value === null ? {} : { [key]: plain(value) };
}

const numbers = (list: ArrayLike<number>): number[] => Array.from(list);

/** The numbers of a matrix in one list. */
const rowAfterRow = (matrix: ArrayLike<number | ArrayLike<number>>): number[] =>
  Array.from(matrix).flatMap((row) => (typeof row === "number" ? row : numbers(row)));

const plainCamera = (given: PinholeInput, field: string): Pinhole => {
  const camera = cameraOf(given, field) as Pinhole;
  return { ...pick(camera, ["fx", "fy", "cx", "cy", "model"]), ...plainMember(camera, "distortion", numbers) };
};

export const plainImage = (image: ColorImageInput): ColorImage => ({
  ...pick(image, ["width", "height", "mask", "transfer", "data"]),
  ...plainMember(image, "camera", (camera) => plainCamera(camera, "image.camera")),
});

export const plainDepth = (depth: DepthMapInput): DepthMap => ({
  ...pick(depth, ["width", "height", "mask", "unit", "data", "points", "normals"]),
  ...plainMember(depth, "camera", (camera) => plainCamera(camera, "depth.camera")),
});

/** The members that some rows describe. */
function plainMembers(source: object, rows: Rows): object {
  const values = pick(source as Record<string, unknown>, Object.keys(rows));
  return Object.fromEntries(Object.entries(values).map(([key, value]) => [key, plainValue(value, rows[key])]));
}

/** A value that does not match its row is left to the check. */
function plainValue(value: unknown, row: Row | undefined): unknown {
  if (typeof value !== "object" || value === null) return value;
  if (row?.kind === "list") return numbers(value as ArrayLike<number>);
  if (row?.kind === "matrix") return rowAfterRow(value as ArrayLike<number | ArrayLike<number>>);
  return row?.kind === "object" ? plainMembers(value, row.members) : value;
}

export function plainOptions(options: Options): PlainOptions {
  const values: Record<string, unknown> = pick(options, Object.keys(OPTIONS) as (keyof Options)[]);
  return plainMembers({ ...values, start: poseOf(values.start, "options.start") }, OPTIONS);
}

/** The array types of the contract. Node's Buffer inherits from one of them, and its slices are views. */
const ARRAYS = [Uint8ClampedArray, Uint8Array, Uint16Array, Float32Array] as const;

/** A copy for another thread, whose arrays may be `transfer`red, so each has a separate buffer. */
export function copyOf<T extends object>(input: T, transfer: ArrayBuffer[]): T {
  const copied = Object.entries(input).map(([key, value]: [string, unknown]) => {
    const type = ARRAYS.find((type) => value instanceof type);
    if (type === undefined) return [key, value];
    const array = new type(value as ArrayLike<number>);
    transfer.push(array.buffer);
    return [key, array];
  });
  return Object.fromEntries(copied) as T;
}
