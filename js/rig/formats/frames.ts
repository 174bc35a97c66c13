/** Poses of frames in one another, as robots' descriptions have them: a tree whose branches are asked for the way between two cameras. */
import type { NamedPose, Pose } from "../types.js";
import { chained, inverseOf, poseOf } from "./poses.js";

const COLOUR = /colou?r|rgb/i;
const DEPTH = /depth|infra|(?:^|[_/ ])ir(?:[_/ \d]|$)|tof/i;
const LIDAR = /velodyne|lidar|laser|ouster|livox|hesai|pandar|rslidar|robosense/i;
const CAMERA = /cam/i;
const OPTICAL = /optical/i;

/** ROS's body axes (x forward, y left, z up) of a camera's optical ones (x right, y down, z forward). */
const BODY_OF_OPTICAL = poseOf([0, 0, 1, -1, 0, 0, 0, -1, 0], [0, 0, 0]);
/**
 * Whether a camera's frame has the axes of a body, by its rotation into one whose z points up: cameras are mounted upright, so that either
 * its own z points up, or its y down.
 */
export const hasBodyAxes = ({ rotation: r }: Pose): boolean => (r[8] ?? 0) > -(r[7] ?? 0);
/** The same camera with optical axes. */
export const asOptical = (pose: Pose): Pose => chained(pose, BODY_OF_OPTICAL);

/** Chains are no longer than this, and a file whose frames go round in a circle has no root. */
const MOST_STEPS = 64;

interface Placed {
  root: string;
  pose: Pose;
}

/** Of each frame the way to the root of its tree. */
function places(poses: readonly NamedPose[]): Map<string, Placed> {
  const parents = new Map<string, { to: string; pose: Pose }>();
  for (const { from, to, pose } of poses)
    if (from !== undefined && to !== undefined && !parents.has(from)) parents.set(from, { to, pose });
  const placed = new Map<string, Placed>();
  const frames = new Set(poses.flatMap(({ from, to }) => [from ?? "", to ?? ""]));
  for (const frame of frames) {
    let [root, pose] = [frame, poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0])];
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

/** The frame that pictures are in: an optical one, or the camera's own where there is none. */
function best(names: string[], is: (name: string) => boolean): string | undefined {
  const fitting = names.filter(is);
  return fitting.find((name) => OPTICAL.test(name)) ?? fitting[0];
}

/**
 * The way from the depth camera (or else the LiDAR) to the colour camera (or else the first one), where both are in one tree and no pose
 * relates them as it is. A camera's frame that is no optical one has the body's axes, by ROS's convention: it is turned.
 */
export function wayBetween(poses: readonly NamedPose[]): { pose: NamedPose; turned: string[] } | undefined {
  const placed = places(poses);
  const names = [...placed.keys()];
  const depth = best(names, (name) => DEPTH.test(name) && !COLOUR.test(name));
  const lidar = best(names, (name) => LIDAR.test(name) && !CAMERA.test(name));
  const colour =
    best(names, (name) => COLOUR.test(name) && !DEPTH.test(name)) ??
    best(names, (name) => CAMERA.test(name) && !DEPTH.test(name) && !LIDAR.test(name));
  const from = depth ?? lidar;
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
  // Two frames with the same axes need not be turned to be compared, but a picture's points have the optical ones.
  const pose = chained(inverseOf(optical(colour, b)), optical(from, a));
  return { pose: { name: `${colour} from ${from}`, from, to: colour, pose }, turned };
}

/** Between frames that names relate there are few steps. */
const MOST_LINKS = 6;

/** The way from one frame to another by poses that share frames, either way round; nothing where there is none. */
export function linked(poses: readonly NamedPose[], from: string, to: string): NamedPose | undefined {
  const reached = new Map<string, Pose>([[from, poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0])]]);
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

/** Frames of LiDARs by their names. */
export const isLidar = (name: string): boolean => LIDAR.test(name) && !CAMERA.test(name);
