/** Checks names and types of a check's input; values are checked in Rust. */
import { camera } from "../cameras.js";
import {
  type Check,
  DEPTH,
  IMAGE,
  callback,
  isObject,
  number,
  numbers,
  object,
  ranged,
  signal,
  word,
  wrong,
} from "../check.js";
import { BimodalError, refused } from "../errors.js";
import { type PoseMembers, cameraOf, poseOf } from "../matrices.js";
import type { CheckFrame, CheckFrameInput, Pinhole, PinholeInput } from "../types/index.js";

const name: Check = (value, field) => {
  if (typeof value !== "string") throw wrong(field, "a string", value);
};
const poseMembers = object(
  {
    scale: number,
    rotation: numbers(9),
    translation: numbers(3),
    angles: object({ alpha: number, beta: number, gamma: number }),
  },
  ["rotation", "translation"],
);
const rigPose: Check = (value, field) => poseMembers(poseOf(value, field), field);
const frame = object(
  {
    image: object({ ...IMAGE, camera }, ["width", "height", "data"]),
    depth: object({ ...DEPTH, camera }, ["width", "height"]),
    name,
    // Members that `sampleRig` adds.
    pose: rigPose,
  },
  ["image", "depth"],
);
const cue = word("shading", "edges", "information", "silhouette");
const cues: Check = (value, field) => {
  if (!Array.isArray(value)) throw wrong(field, "a list of cues", value);
  // `forEach` would skip the holes of a list.
  for (const [index, one] of value.entries()) cue(one, `${field}[${index}]`);
  if (value.length === 0) throw new BimodalError("size", `${field}: needs at least one cue`, field);
};
const MOST_WORKERS = 16;
const options = object({
  cues,
  workers: ranged({ kind: "whole", min: 1, max: MOST_WORKERS }),
  signal,
  onProgress: callback,
});

/** A view whose camera, if it is given as a matrix, has been converted to members. */
function withCamera<T extends object>(view: T & { camera?: PinholeInput }, field: string): T & { camera?: Pinhole } {
  const camera = cameraOf(view.camera, `${field}.camera`) as Pinhole | undefined;
  if (camera === view.camera) return view as T & { camera?: Pinhole };
  // Inherited members of the view stay accessible.
  return Object.create(view, { camera: { value: camera, enumerable: true } });
}

/** The frames with their cameras as members. */
export function checkedFrames(value: unknown): CheckFrame[] {
  if (!Array.isArray(value)) throw wrong("frames", "a list of frames", value);
  return Array.from(value, (one: CheckFrameInput, index) => {
    const field = `frames[${index}]`;
    frame(one, field);
    const { image, depth, name } = one;
    return {
      image: withCamera(image, `${field}.image`),
      depth: withCamera(depth, `${field}.depth`),
      ...(name !== undefined && { name }),
    };
  });
}

/** Tolerance of a scale of one after a product of rounded rotations. */
const SCALE_TOLERANCE = 0.01;

/** The members of a pose given in any form. */
export function checkedPose(given: unknown, field = "pose"): PoseMembers {
  const value = poseOf(given, field);
  poseMembers(value, field);
  const scale = isObject(value) && "scale" in value ? value.scale : undefined;
  if (typeof scale !== "number" || Math.abs(scale - 1) <= SCALE_TOLERANCE) return value as PoseMembers;
  throw new BimodalError(
    "range",
    `${field}.scale: must be 1: extrinsics do not change sizes (got ${scale})`,
    `${field}.scale`,
    refused(scale),
  );
}

/** A pose as the bindings take it: its rotation row by row and its translation. */
export const twelve = ({ rotation, translation }: PoseMembers): number[] => [...rotation, ...translation];

/** The candidates in their order. */
export function checkedCandidates(value: unknown): [name: string, pose: PoseMembers][] {
  if (!isObject(value) || Array.isArray(value)) throw wrong("candidates", "an object of poses by name", value);
  return Object.entries(value).map(([name, pose]) => [name, checkedPose(pose, `candidates.${name}`)]);
}

export const checkCheckOptions = (value: unknown): void => options(value, "options");
