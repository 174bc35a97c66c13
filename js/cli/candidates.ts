/** The extrinsics to check, from the readings of their files. */
import { basename } from "node:path";
import { isLidar, isOfCarrier, linked } from "../rig/formats/frames.js";
import { inverseOf } from "../rig/formats/poses.js";
import type { NamedPose, RigReading } from "../rig/types.js";
import type { Pose } from "../types/index.js";
import { Mistake } from "./arguments.js";
import type { Judged } from "./report.js";

const COLOUR = /colou?r|rgb/i;
const DEPTH = /depth|infra|\bir\b|tof/i;

/** Whether names state that a pose maps colour to depth. */
const isBackwards = ({ from = "", to = "" }: NamedPose): boolean =>
  COLOUR.test(from) && !DEPTH.test(from) && DEPTH.test(to) && !COLOUR.test(to);

const isCamera = (name: string): boolean => COLOUR.test(name) || (/cam/i.test(name) && !DEPTH.test(name));

/** The poses that do not lead to what carries a sensor, or else the one between two sensors on the same carrier. */
function betweenSensors(all: NamedPose[]): NamedPose[] {
  const direct = all.filter((pose) => !isOfCarrier(pose));
  if (direct.length > 0) return direct;
  const ends = [...new Set(all.flatMap(({ from = "", to = "" }) => [from, to]))];
  const from = ends.find((name) => DEPTH.test(name) && !COLOUR.test(name)) ?? ends.find(isLidar);
  const to =
    ends.find((name) => COLOUR.test(name) && name !== from) ?? ends.find((name) => isCamera(name) && name !== from);
  const way = from === undefined || to === undefined ? undefined : linked(all, from, to);
  return way === undefined ? [] : [way];
}

/** The refusal of a file of the places of sensors in a body, which are no extrinsics between two sensors. */
function ofBody(file: string, poses: NamedPose[]): Mistake {
  const { name, from, to } = poses[0] as NamedPose;
  return new Mistake(
    `${file}: ${name === undefined ? "it" : `its "${name}"`} relates ${from} to ${to}, which carries it (an inertial unit, a body, a vehicle or a robot); extrinsics relate the depth camera or the LiDAR to the colour camera. Give that pose as a 4x4 matrix, in a file named depth_to_color.txt or lidar_to_camera.txt`,
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
    const poses = betweenSensors(ofSensors);
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
      // Two files may have one name; a number as a name would come first.
      let unique = /^\d+$/.test(title) ? `"${title}"` : title;
      while (Object.hasOwn(candidates, unique)) unique += "'";
      candidates[unique] = turns ? inverseOf(pose.pose) : pose.pose;
    });
  }
  return candidates;
}
