/** Checks the names, types and numbers that the writers of a run are given, before anything is written. */
import { type ArrayType, type Check, array, isObject, number, numbers, ranged, side, word, wrong } from "../check.js";
import { BimodalError, refused } from "../errors.js";
import type { Raster } from "../npy.js";
import { wholePoseOf } from "../matrices.js";
import type { Pose, PoseInput, StepReport } from "../types/index.js";
import { like } from "../rig/write/built.js";

export const checkUnit = word("m", "px");

const channelCount = ranged({ kind: "whole", min: 1 });

/** Checks that a raster has one of these types and the length that follows from its size. */
export function checkRaster(raster: Raster<ArrayLike<number>>, field: string, ...kinds: readonly ArrayType[]): void {
  if (!isObject(raster)) throw wrong(field, "an object", raster);
  const { width, height, channels, data } = raster;
  side(width, `${field}.width`);
  side(height, `${field}.height`);
  channelCount(channels, `${field}.channels`);
  array(...kinds)(data, `${field}.data`);
  if (data.length !== width * height * channels || data.length === 0) {
    throw new BimodalError(
      "size",
      `${field}: ${width}x${height} pixels of ${channels} channels need ${width * height * channels} numbers, not ${data.length}`,
      field,
    );
  }
}

export const text: Check = (value, field) => {
  if (typeof value !== "string") throw wrong(field, "a string", value);
};

/** Checks that a value is a list of this many finite numbers. */
const finite =
  (count: number): Check =>
  (value, field) => {
    numbers(count)(value, field);
    const copy = Array.from(value as ArrayLike<number>);
    const index = copy.findIndex((one) => !Number.isFinite(one));
    if (index < 0) return;
    const message = `${field}: must be finite numbers (got ${copy[index]})`;
    throw new BimodalError("range", message, field, refused(copy[index], index));
  };
/** Nine coefficients for each of three channels. */
export const checkLight = finite(27);

const scaleOf = ranged({ kind: "number", above: 0 });
const angleOf = ranged({ kind: "number" });
const [nine, three] = [finite(9), finite(3)];

/** A pose in any form as the members from which its matrix is made. */
export function checkedPose(given: PoseInput, field: string): Pose {
  const pose = wholePoseOf(given, field);
  if (!isObject(pose)) throw wrong(field, "an object", pose);
  scaleOf(pose.scale, `${field}.scale`);
  nine(pose.rotation, `${field}.rotation`);
  three(pose.translation, `${field}.translation`);
  return pose;
}

/** A pose in any form as members, including its angles. */
export function checkedWholePose(given: PoseInput, field: string): Pose {
  const pose = checkedPose(given, field);
  like({ angles: {} }, pose, field);
  for (const name of ["alpha", "beta", "gamma"] as const) angleOf(pose.angles[name], `${field}.angles.${name}`);
  return pose;
}

type Standing = Pick<StepReport, "status" | "reason" | "message" | "uncertainty">;

export function checkStanding(report: Standing): void {
  const { status, reason, message = "", uncertainty } = Object(report) as Standing;
  for (const [name, words] of Object.entries({ status, message })) text(words, `report.${name}`);
  if (reason !== undefined) {
    like({}, reason, "report.reason");
    text(reason.code, "report.reason.code");
  }
  if (uncertainty === undefined) return;
  like({ rotationDegrees: [], translation: [] }, uncertainty, "report.uncertainty");
  const { rotationDegrees, translation, scale } = uncertainty;
  for (const [name, sigmas] of Object.entries({ rotationDegrees, translation, scale: [scale] })) {
    for (const sigma of sigmas) if (sigma !== null) number(sigma, `report.uncertainty.${name}`);
  }
  text(uncertainty.weakest, "report.uncertainty.weakest");
}
