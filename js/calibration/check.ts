/** What a check's input must look like: names and types; values are checked in Rust. */
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
import { BimodalError } from "../errors.js";

/** A rig's camera: with as many coefficients as its lens model has, which the numerics judge. */
const list: Check = (value, field) => {
  const length = isObject(value) && "length" in value ? value.length : undefined;
  if (typeof length !== "number" || length > MOST_COEFFICIENTS) throw wrong(field, "a list of numbers", value);
  numbers(length)(value, field);
};
/** OpenCV's longest model that is read here. */
const MOST_COEFFICIENTS = 8;
const rigCamera = object(
  { fx: number, fy: number, cx: number, cy: number, model: word("brown", "fisheye"), distortion: list },
  ["fx", "fy", "cx", "cy"],
);
const name: Check = (value, field) => {
  if (typeof value !== "string") throw wrong(field, "a text", value);
};
const rigPose = object(
  {
    scale: number,
    rotation: numbers(9),
    translation: numbers(3),
    angles: object({ alpha: number, beta: number, gamma: number }),
    // Of a reported pose; the other members say the same.
    matrix: () => {},
  },
  ["rotation", "translation"],
);
const frame = object(
  {
    image: object({ ...IMAGE, camera: rigCamera }, ["width", "height", "data"]),
    depth: object({ ...DEPTH, camera: rigCamera }, ["width", "height"]),
    name,
    // What `sampleRig` adds.
    pose: rigPose,
  },
  ["image", "depth"],
);
const cue = word("shading", "edges", "information", "silhouette");
const cues: Check = (value, field) => {
  if (!Array.isArray(value)) throw wrong(field, "a list of cues", value);
  // `forEach` would pass over holes.
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

export function checkFrames(value: unknown): void {
  if (!Array.isArray(value)) throw wrong("frames", "a list of frames", value);
  for (const [index, one] of value.entries()) frame(one, `frames[${index}]`);
}

/** What a product of rotations with rounding leaves of a scale of one. */
const SCALE_TOLERANCE = 0.01;

export function checkPose(value: unknown, field = "pose"): void {
  rigPose(value, field);
  const scale = isObject(value) && "scale" in value ? value.scale : undefined;
  if (typeof scale !== "number" || Math.abs(scale - 1) <= SCALE_TOLERANCE) return;
  throw new BimodalError(
    "range",
    `${field}.scale: must be 1: extrinsics do not change sizes (got ${scale})`,
    `${field}.scale`,
  );
}

export function checkCandidates(value: unknown): void {
  if (!isObject(value) || Array.isArray(value)) throw wrong("candidates", "an object of poses by name", value);
  for (const [name, pose] of Object.entries(value)) checkPose(pose, `candidates.${name}`);
}

export const checkCheckOptions = (value: unknown): void => options(value, "options");
