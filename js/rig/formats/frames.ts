/** Poses between frames, as in robot descriptions, and the pose between two frames that a chain of them relates. */
import type { NamedPose, Pose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { chained, identity, inverseOf, poseOf } from "./poses.js";

const COLOUR = /colou?r|rgb/i;
const DEPTH = /depth|infra|(?:^|[_/ ])ir(?:[_/ \d]|$)|tof/i;
const LIDAR = /velodyne|lidar|laser|ouster|livox|hesai|pandar|rslidar|robosense/i;
const CAMERA = /cam/i;
const OPTICAL = /optical/i;

/** From a camera's optical axes (x right, y down, z forward) into ROS's body axes (x forward, y left, z up). */
const BODY_OF_OPTICAL = poseOf([0, 0, 1, -1, 0, 0, 0, -1, 0], [0, 0, 0]);
/**
 * Whether a camera's frame has body axes, from its rotation into a frame whose z points up. Cameras are mounted upright, so either their own
 * z points up or their y points down.
 */
export const hasBodyAxes = ({ rotation: r }: Pose): boolean => (r[8] ?? 0) > -(r[7] ?? 0);
/** Converts the pose of a camera from body axes to optical axes. */
export const asOptical = (pose: Pose): Pose => chained(pose, BODY_OF_OPTICAL);
/** Converts a pose for points in optical axes to a pose for points in body axes. */
export const ofBody = (pose: Pose): Pose => chained(pose, inverseOf(BODY_OF_OPTICAL));

/** Longest chain of frames; it ends the search where frames form a circle. */
const MOST_STEPS = 64;

interface Placed {
  root: string;
  pose: Pose;
}

/** The pose of each frame relative to the root of its tree. */
function places(poses: readonly NamedPose[]): Map<string, Placed> {
  const parents = new Map<string, { to: string; pose: Pose }>();
  for (const { from, to, pose } of poses)
    if (from !== undefined && to !== undefined && !parents.has(from)) parents.set(from, { to, pose });
  const placed = new Map<string, Placed>();
  const frames = new Set(poses.flatMap(({ from, to }) => [from ?? "", to ?? ""]));
  for (const frame of frames) {
    let [root, pose] = [frame, identity()];
    for (let step = 0; step < MOST_STEPS; step++) {
      const next = parents.get(root);
      if (next === undefined) break;
      pose = chained(next.pose, pose);
      root = next.to;
    }
    placed.set(frame, { root, pose });
  }
  return placed;
}

const bodyAxes = (frames: readonly string[]): ReaderWarning =>
  warning(
    "pose-assumed",
    `The frame ${frames.join(" and ")} does not have the name of an optical frame and was read as looking along x with z up, as in ROS.`,
  );

/** The first optical frame that fits, or else the first frame that fits. */
function best(names: string[], is: (name: string) => boolean): string | undefined {
  const fitting = names.filter(is);
  return fitting.find((name) => OPTICAL.test(name)) ?? fitting[0];
}

/**
 * The pose from the depth camera (or else the LiDAR) to the colour camera (or else the first camera), if both are in one tree and no pose
 * of the file relates them directly. A camera frame without "optical" in its name has body axes by ROS's convention and is converted,
 * with a warning.
 */
export function wayBetween(poses: readonly NamedPose[]): { pose: NamedPose; warnings: ReaderWarning[] } | undefined {
  const placed = places(poses);
  const names = [...placed.keys()];
  const depth = best(names, (name) => DEPTH.test(name) && !COLOUR.test(name));
  const colour =
    best(names, (name) => COLOUR.test(name) && !DEPTH.test(name)) ??
    best(names, (name) => CAMERA.test(name) && !DEPTH.test(name) && !LIDAR.test(name));
  const from = depth ?? best(names, isLidar);
  if (from === undefined || colour === undefined || from === colour) return undefined;
  const isThere = (a: string, b: string) => poses.some((pose) => pose.from === a && pose.to === b);
  if (isThere(from, colour) || isThere(colour, from)) return undefined;
  const [a, b] = [placed.get(from), placed.get(colour)];
  if (a === undefined || b === undefined || a.root !== b.root) return undefined;
  const turned: string[] = [];
  const optical = (name: string, { pose }: Placed): Pose => {
    if (OPTICAL.test(name) || isLidar(name) || !hasBodyAxes(pose)) return pose;
    turned.push(name);
    return asOptical(pose);
  };
  const pose = chained(inverseOf(optical(colour, b)), optical(from, a));
  const warnings = turned.length > 0 ? [bodyAxes(turned)] : [];
  return { pose: { name: `${colour} from ${from}`, from, to: colour, pose }, warnings };
}

/** Longest chain of poses between two frames. */
const MOST_LINKS = 6;

/** The pose between two frames by the shortest chain of poses or their inverses; undefined where no chain joins them. */
export function linked(poses: readonly NamedPose[], from: string, to: string): NamedPose | undefined {
  const reached = new Map<string, Pose>([[from, identity()]]);
  let edge = [from];
  for (let step = 0; step < MOST_LINKS && edge.length > 0 && !reached.has(to); step++) {
    const next: string[] = [];
    for (const frame of edge)
      for (const { from: a, to: b, pose } of poses) {
        if (a === undefined || b === undefined || (a !== frame && b !== frame)) continue;
        const other = a === frame ? b : a;
        const before = reached.get(frame);
        if (reached.has(other) || before === undefined) continue;
        reached.set(other, chained(a === frame ? pose : inverseOf(pose), before));
        next.push(other);
      }
    edge = next;
  }
  const pose = reached.get(to);
  return pose && from !== to ? { name: `${to} from ${from}`, from, to, pose } : undefined;
}

/** Whether a frame is a LiDAR's, by its name. */
export const isLidar = (name: string): boolean => LIDAR.test(name) && !CAMERA.test(name);

/**
 * Frames that are neither a camera's nor a LiDAR's: the inertial unit, the body, a vehicle, a robot and its hand, and the calibration
 * target.
 */
const CARRIER =
  /^(?:b|body|i|imu\w*|base(?:[_ ]?(?:link|footprint))?|rig|vehicle|ego(?:[_ ]?vehicle)?|car|robot\w*|hand|gripper|flange|tool\d*|\w+_(?:hand|gripper|flange|tool\d*)|gps|ins|oxts|(?:april|aru|charu)\w*|tag\w*|marker\w*|(?:chess|checker|calib\w*)?_?board|target|pattern|object|table)$/i;

/** Whether a motion relates a sensor to its carrier or to its target, instead of relating two sensors. */
export const isOfCarrier = ({ from = "", to = "" }: Ends): boolean => CARRIER.test(from) || CARRIER.test(to);

type Ends = { from?: string | undefined; to?: string | undefined };
const isColour = (name: string): boolean => COLOUR.test(name) && !DEPTH.test(name);
const isDepth = (name: string): boolean => DEPTH.test(name) && !COLOUR.test(name);
const isCamera = (name: string): boolean => isColour(name) || (CAMERA.test(name) && !DEPTH.test(name));

/** Whether a pose leads away from the colour camera, or into the depth camera or a LiDAR, by the names of its frames. */
export function isBackwards({ from = "", to = "" }: Ends): boolean {
  if (isColour(from)) return !isColour(to);
  if (isDepth(to)) return !isDepth(from) && !isLidar(from);
  return isLidar(to) && from !== "" && !isLidar(from) && !isDepth(from);
}

/** Whether a pose relates the depth camera or a LiDAR to the colour camera or another camera, by the names of its frames. */
export const isOfRig = ({ from = "", to = "" }: Ends): boolean =>
  [from, to].some((name) => isDepth(name) || isLidar(name)) && [from, to].some(isCamera);
