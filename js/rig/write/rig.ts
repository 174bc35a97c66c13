/**
 * Checks the input of the writers of extrinsics, because the reader of a file would trust an invalid number, a sheared rotation or a scale
 * in it.
 */
import { cameraOf, determinant, poseOf } from "../../matrices.js";
import type { Pinhole, PinholeInput, Pose, PoseInput } from "../../types/index.js";
import { fault, like, oneOf } from "./built.js";

/** Width and height in pixels. */
export type Size = readonly [width: number, height: number];

/** Properties of the rig besides the pose; they are written if the format has a place for them. */
export interface RigContext {
  /** The colour camera. */
  colour?: PinholeInput | undefined;
  /** The depth camera. */
  depth?: PinholeInput | undefined;
  /** The sizes of both cameras' pictures. */
  sizes?:
    | {
        /** Size of the colour camera's pictures, pixels. */
        colour?: Size | undefined;
        /** Size of the depth camera's pictures, pixels. */
        depth?: Size | undefined;
      }
    | undefined;
  /** Whether the pose is an estimate that no check has confirmed; name and content of the file then say so. Default false. */
  isEstimate?: boolean | undefined;
  /** ROS names of both cameras' optical frames; by default those of the RealSense driver. */
  frames?:
    | {
        /** Name of the colour camera's frame. Default "camera_color_optical_frame". */
        colour?: string | undefined;
        /** Name of the depth camera's frame. Default "camera_depth_optical_frame", or "lidar" where the pose is for axes with x forward. */
        depth?: string | undefined;
      }
    | undefined;
}

/** A camera with its distortion in OpenCV's form: none, or 4, 5 or 8 numbers; always 4 for a fisheye. */
export interface Camera {
  model: "brown" | "fisheye";
  fx: number;
  fy: number;
  cx: number;
  cy: number;
  distortion: number[];
  size: Size | undefined;
}

/** A rig whose numbers have been checked: P_colour = rotation P_depth + translation, metres, row-major. */
export interface Rig {
  rotation: number[];
  translation: number[];
  colour: Camera | undefined;
  depth: Camera | undefined;
}

const LENGTHS = { brown: [0, 4, 5, 8], fisheye: [4] } as const;
/** Largest difference of an entry of R Rᵀ from the identity, about the rounding error of single precision. */
const MOST_SHEAR = 1e-6;

function numbers(values: ArrayLike<number>, lengths: readonly number[], field: string): number[] {
  const { length } = Object(values) as ArrayLike<number>;
  if (!lengths.includes(length)) throw fault("size", field, `needs ${lengths.join(" or ")} numbers, not ${length}`);
  const copy = Array.from(values);
  const wrong = copy.findIndex((value) => !Number.isFinite(value));
  if (wrong >= 0)
    throw fault("range", field, `must be finite numbers (got ${String(copy[wrong])})`, {
      value: copy[wrong],
      index: wrong,
    });
  return copy;
}

function checkRotation(r: readonly number[]): void {
  const at = (row: number, column: number) => r[3 * row + (column % 3)] ?? NaN;
  const dot = (i: number, j: number) => at(i, 0) * at(j, 0) + at(i, 1) * at(j, 1) + at(i, 2) * at(j, 2);
  const isRightHanded = determinant(r) > 0;
  const each = [0, 1, 2];
  const shear = Math.max(...each.flatMap((i) => each.map((j) => Math.abs(dot(i, j) - (i === j ? 1 : 0)))));
  if (shear <= MOST_SHEAR && isRightHanded) return;
  const what = isRightHanded ? `R Rᵀ differs from the identity by ${shear.toPrecision(2)}` : "it mirrors";
  throw fault("range", "pose.rotation", `is not a rotation: ${what}`);
}

function size(value: Size | undefined, field: string): Size | undefined {
  if (value === undefined) return undefined;
  const [width = NaN, height = NaN] = numbers(value, [2], field);
  const index = [width, height].findIndex((side) => !(Number.isSafeInteger(side) && side > 0));
  if (index >= 0)
    throw fault("size", field, `must be whole numbers above zero (got ${width} x ${height})`, {
      value: value[index],
      index,
    });
  return [width, height];
}

function camera(
  input: PinholeInput | undefined,
  pixels: Size | undefined,
  name: "colour" | "depth",
): Camera | undefined {
  const known = size(pixels, `context.sizes.${name}`);
  if (input === undefined) return undefined;
  const field = `context.${name}`;
  const given = cameraOf(input, field) as Pinhole;
  like({}, given, field);
  const { model = "brown", fx, fy, cx, cy } = given;
  oneOf(Object.keys(LENGTHS), model, `${field}.model`);
  numbers([fx, fy, cx, cy], [4], field);
  for (const value of [fx, fy])
    if (value <= 0) throw fault("range", field, "focal lengths must be above zero", { value });
  const none = model === "fisheye" ? [0, 0, 0, 0] : [];
  const distortion = numbers(given.distortion ?? none, LENGTHS[model], `${field}.distortion`);
  return { model, fx, fy, cx, cy, distortion, size: known };
}

/** Makes a rig of a pose and of what else is known about the cameras. */
export function rigOf(given: PoseInput, context: RigContext): Rig {
  const pose = poseOf(given, "pose") as Pose;
  like({}, pose, "pose");
  like({}, context, "context");
  if (pose.scale !== 1)
    throw fault("range", "pose.scale", `extrinsics of a rig have the scale 1 (got ${String(pose.scale)})`, {
      value: pose.scale,
    });
  const rotation = numbers(pose.rotation, [9], "pose.rotation");
  checkRotation(rotation);
  return {
    rotation,
    translation: numbers(pose.translation, [3], "pose.translation"),
    colour: camera(context.colour, context.sizes?.colour, "colour"),
    depth: camera(context.depth, context.sizes?.depth, "depth"),
  };
}

/** Row `i` of the 3x4 matrix (R t). */
export const row = ({ rotation, translation }: Rig, i: number): number[] => [
  ...rotation.slice(3 * i, 3 * i + 3),
  translation[i] ?? 0,
];

/** The four rows of the 4x4 matrix that carries points of the depth camera into the colour camera's frame. */
export const rows = (rig: Rig): number[][] => [...[0, 1, 2].map((i) => row(rig, i)), [0, 0, 0, 1]];

/** Whether any number at this index or later differs from zero. */
export const reaches = (distortion: readonly number[], from: number): boolean =>
  distortion.slice(from).some((value) => value !== 0);

/** The first numbers of a distortion, padded with zeros to this length. */
export const padded = (distortion: readonly number[], length: number): number[] =>
  Array.from({ length }, (_, k) => distortion[k] ?? 0);
