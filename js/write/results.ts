/** Writes the results of an estimator to files that other programs read: pose, light, depth and normals. */
import { isObject, wrong } from "../check.js";
import { BimodalError, refused } from "../errors.js";
import type { PoseInput, Reason, StepReport, Uncertainty } from "../types/index.js";
import { real } from "../rig/write/numbers.js";
import { checkLight, checkRaster, checkStanding, checkUnit, checkedPose, checkedWholePose } from "./check.js";
import { writePng } from "./png.js";

/** The unit of lengths: metres if the view has a camera, pixels if it is orthographic. */
export type Unit = "m" | "px";

/** The size of a raster. */
export interface Extent {
  /** Columns. */
  width: number;
  /** Rows. */
  height: number;
}

/** Floats of a view, as `Estimator` returns them. */
export interface FloatRaster extends Extent {
  /** The numbers row by row: three per pixel for normals, else one. */
  data: Float32Array;
}

/** The 4x4 matrix with the scale that transforms the depth map's points into the colour view; `numpy.loadtxt` reads it. */
export function matrixText(given: PoseInput): string {
  const pose = checkedPose(given, "pose");
  const { scale } = pose;
  const [rotation, translation] = [Array.from(pose.rotation), Array.from(pose.translation)];
  const row = (i: number) => [...rotation.slice(3 * i, 3 * i + 3).map((value) => scale * value), translation[i] ?? NaN];
  const rows = [row(0), row(1), row(2), [0, 0, 0, 1]];
  return rows.map((values) => `${values.map(real).join(" ")}\n`).join("");
}

/** The reliability of a pose, as in a report. */
export type PoseStanding = Pick<StepReport, "status" | "reason" | "message" | "uncertainty">;

const sigmasOf = ({ rotationDegrees, translation, scale, weakest }: Uncertainty): Uncertainty => ({
  rotationDegrees,
  translation,
  scale,
  weakest,
});

/** The code with its numbers and words. */
const plainReason = (reason: Reason): Record<string, unknown> =>
  Object.fromEntries(Object.entries(reason).filter(([, value]) => ["string", "number"].includes(typeof value)));

/**
 * The pose with its matrix and a description in words. If a report is given, also its status, its reason and one sigma of each number,
 * `null` where the views do not determine it.
 */
export function poseJson(given: PoseInput, unit: Unit, report?: PoseStanding): string {
  const pose = checkedWholePose(given, "pose");
  checkUnit(unit, "unit");
  const matrix = matrixText(pose)
    .trim()
    .split("\n")
    .map((line) => line.split(" ").map(Number));
  const about = `P_colour = scale * rotation * P_depth + translation; rotation row by row; angles in degrees; lengths in ${unit === "m" ? "metres" : "pixels"}`;
  const {
    scale,
    rotation,
    translation,
    angles: { alpha, beta, gamma },
  } = pose;
  // Only these members are used, because others of the object may contradict them.
  const told = {
    unit,
    scale,
    rotation: Array.from(rotation),
    translation: Array.from(translation),
    angles: { alpha, beta, gamma },
    matrix,
  };
  if (report === undefined) return `${JSON.stringify({ about, ...told }, null, 2)}\n`;
  checkStanding(report);
  const { status, reason, message, uncertainty } = report;
  const sigmas =
    uncertainty &&
    "; uncertainty is one sigma, null where the views do not determine the number, or where it was held fixed";
  const standing = {
    status,
    ...(reason ? { reason: plainReason(reason) } : {}),
    ...(message ? { message } : {}),
    ...(uncertainty ? { uncertainty: sigmasOf(uncertainty) } : {}),
  };
  return `${JSON.stringify({ about: about + (sigmas ?? ""), ...told, ...standing }, null, 2)}\n`;
}

const CHANNELS = ["R", "G", "B"];
const COEFFICIENTS = 9;

/** Nine coefficients each of red, green and blue, one channel per line. */
export function lightCsv(light: ArrayLike<number>): string {
  checkLight(light, "light");
  const names = Array.from({ length: COEFFICIENTS }, (_, k) => `L${k + 1}`);
  const line = (channel: string, c: number) =>
    [channel, ...Array.from({ length: COEFFICIENTS }, (_, k) => real(light[COEFFICIENTS * c + k] ?? NaN))].join(",");
  return `${[["channel", ...names].join(","), ...CHANNELS.map(line)].join("\n")}\n`;
}

const LARGEST = 65_535;
/** Steps of a stored depth, the finest first; the first one that reaches the farthest depth is used. */
const STEPS: Readonly<Record<Unit, readonly (readonly [step: number, words: string])[]>> = {
  m: [
    [0.0001, "0.1 mm"],
    [0.001, "1 mm"],
    [0.01, "10 mm"],
    [1, "1 m"],
  ],
  px: [
    [0.001, "0.001 px"],
    [0.01, "0.01 px"],
    [0.1, "0.1 px"],
    [1, "1 px"],
  ],
};

/** A depth map that was written, with the step of its numbers. */
export interface DepthPng {
  /** The PNG file. */
  bytes: Uint8Array<ArrayBuffer>;
  /** Units (metres or pixels) per stored number. */
  step: number;
  /** The step in words: "0.1 mm". */
  says: string;
}

/** Depths from this number, rounded to a 32-bit float, are missing. */
const MISSING = Math.fround(1e12);
/** A depth that the contract accepts; all others are holes. */
const isThere = (value: number): boolean => value > 0 && value < MISSING;

/**
 * Checks that no depth is lost. Depths in pixels have an arbitrary origin, so a depth below zero is valid but could not be distinguished
 * from a hole; behind a camera no depth is valid.
 */
function checkDepths(data: Float32Array, unit: Unit): void {
  // The coarsest step is one metre or one pixel.
  const at = data.findIndex((value) => (unit === "px" && value < 0) || (isThere(value) && Math.round(value) > LARGEST));
  if (at < 0) return;
  const value = data[at] ?? NaN;
  const why = value < 0 ? "would be a hole" : `is beyond ${LARGEST} ${unit}, the farthest that fits`;
  throw new BimodalError(
    "range",
    `depth.data[${at}]: ${value} ${unit} ${why}; shift the depths, or write them with writeNpy`,
    `depth.data[${at}]`,
    refused(value),
  );
}

/**
 * Depth as a 16-bit PNG; 0 marks missing depth. The step is returned and also stored in the file's text chunk "Unit". Depths in pixels
 * below zero, as in `imageDepth()` of a view without a camera, and depths beyond 65535 are refused; shift them or use `writeNpy`.
 */
export async function depthPng(depth: FloatRaster, unit: Unit): Promise<DepthPng> {
  if (!isObject(depth)) throw wrong("depth", "an object", depth);
  const { width, height, data } = depth;
  checkRaster({ width, height, channels: 1, data }, "depth", Float32Array);
  checkUnit(unit, "unit");
  checkDepths(data, unit);
  const farthest = data.reduce((most, value) => (isThere(value) ? Math.max(most, value) : most), 0);
  const [step, says] = STEPS[unit].find(([each]) => Math.round(farthest / each) <= LARGEST) ?? [1, ""];
  const stored = new Uint16Array(data.length);
  for (let i = 0; i < data.length; i++) {
    const value = data[i] ?? NaN;
    if (isThere(value)) stored[i] = Math.max(1, Math.round(value / step));
  }
  const bytes = await writePng(
    { width, height, channels: 1, data: stored },
    { Unit: `${says} per stored number; 0 is no depth`, Software: "bimodal-stereo" },
  );
  return { bytes, step, says };
}

/**
 * Normals as a PNG of 16 bits: red, green and blue are (n + 1) / 2 of full white, for x to the right, y up and z towards the viewer, as
 * normal maps have them; black marks a missing normal.
 */
export async function normalsPng(normals: FloatRaster): Promise<Uint8Array<ArrayBuffer>> {
  if (!isObject(normals)) throw wrong("normals", "an object", normals);
  const { width, height, data } = normals;
  checkRaster({ width, height, channels: 3, data }, "normals", Float32Array);
  const stored = new Uint16Array(data.length);
  const level = (value: number) => Math.round((LARGEST * (Math.min(1, Math.max(-1, value)) + 1)) / 2);
  for (let at = 0; at < data.length; at += 3) {
    const [x, y, z] = [data[at] ?? NaN, data[at + 1] ?? NaN, data[at + 2] ?? NaN];
    if (!Number.isFinite(x + y + z) || (x === 0 && y === 0 && z === 0)) continue;
    stored[at] = level(x);
    // y points down and z forward in a camera's frame.
    stored[at + 1] = level(-y);
    stored[at + 2] = level(-z);
  }
  const texts = {
    Description: "Normals: (n + 1) / 2 of 65535 for x right, y up, z towards the viewer; black is none",
    Software: "bimodal-stereo",
  };
  return writePng({ width, height, channels: 3, data: stored }, texts);
}
