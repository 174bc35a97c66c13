/** The extrinsics to check, from the readings of their files. */
import { basename } from "node:path";
import { isBackwards, isOfCarrier, isOfRig, wayBetween } from "../rig/formats/frames.js";
import { inverseOf } from "../rig/formats/poses.js";
import type { NamedPose, RigReading } from "../rig/types.js";
import type { Pose } from "../types/index.js";
import { Mistake } from "./arguments.js";
import type { Judged } from "./report.js";

/**
 * The poses between the depth camera or the LiDAR and the colour camera. If the file has none, the pose that follows from a chain of its
 * frames; without such a chain, all poses except those of bodies and targets.
 */
function betweenSensors(all: NamedPose[], field: string, warnings: Judged[]): NamedPose[] {
  const direct = all.filter((pose) => isOfRig(pose) || (pose.from === undefined && pose.to === undefined));
  if (direct.length > 0) return direct;
  const way = wayBetween(all);
  if (way === undefined) return all.filter((pose) => !isOfCarrier(pose));
  for (const { code, message } of way.warnings) warnings.push({ code, message: `${field}: ${message}`, field });
  return [way.pose];
}

/**
 * The error about a file whose poses relate a sensor to its carrier or to its target. They are not extrinsics between two sensors.
 */
function ofBody(file: string, poses: NamedPose[]): Mistake {
  const { name, from, to } = poses[0] as NamedPose;
  return new Mistake(
    `${file}: ${name === undefined ? "it" : `its "${name}"`} relates ${from} to ${to}, one of which is not a sensor of the pictures (it may be an inertial unit, a body, a vehicle, a robot or a calibration target); extrinsics relate the depth camera or the LiDAR to the colour camera. Give that pose as a 4x4 matrix, in a file named depth_to_color.txt or lidar_to_camera.txt`,
    "file",
  );
}

/** The poses of all calibrations by name; the one to check comes first. */
export function candidatesOf(readings: RigReading[], isInverted: boolean, warnings: Judged[]): Record<string, Pose> {
  const candidates: Record<string, Pose> = {};
  for (const reading of readings) {
    const { name } = reading;
    const all = "poses" in reading ? (reading.poses ?? []) : [];
    const ofSensors = all.filter(({ to }) => to !== "world");
    const poses = betweenSensors(ofSensors, name, warnings);
    if (ofSensors.length > 0 && poses.length === 0) throw ofBody(name, ofSensors);
    if (poses.length < all.length && poses.length === 0)
      throw new Mistake(
        `${name}: it gives the pose of a camera in the world (camera to world), not extrinsics`,
        "file",
      );
    if (poses.length === 0) throw new Mistake(`${name}: it contains no extrinsics`, "file");
    poses.forEach((pose, index) => {
      const own = pose.name ?? (pose.from && pose.to ? `${pose.from} to ${pose.to}` : `pose ${index + 1}`);
      const title = poses.length === 1 ? basename(name) : `${basename(name)}, ${own}`;
      const turns = isInverted || isBackwards(pose);
      if (turns && !isInverted)
        warnings.push({
          code: "inverse-checked",
          message: `${name}: it maps ${pose.from} to ${pose.to}; its inverse was checked.`,
          field: name,
        });
      // Two files may have the same name, and an object lists names that are numbers first.
      let unique = /^\d+$/.test(title) ? `"${title}"` : title;
      while (Object.hasOwn(candidates, unique)) unique += "'";
      candidates[unique] = turns ? inverseOf(pose.pose) : pose.pose;
    });
  }
  return candidates;
}
