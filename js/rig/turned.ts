/**
 * Extrinsics for a LiDAR's cloud that somebody turned to a camera's axes first (x right, y down, z forward), where the cloud at hand has its
 * own (x forward, z up).
 *
 * Axes follow from the extrinsics: those that would have the camera look along the axis that the cloud has upwards cannot be for the cloud
 * as it is. They are turned, P_camera = R Q P_cloud + t with Q from x forward, y left and z up to a camera's axes. Limits: that x is forward,
 * as ROS has it, is a guess, and said.
 */
import { poseOf } from "./formats/poses.js";
import { isOptical } from "./scan.js";
import type { CheckFrame, NamedPose, Pose } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

/** Cosine of 45 degrees: nearer to an axis than to any other. */
const NEAR = Math.SQRT1_2;
/** Ends of poses that lead elsewhere than to a camera, or come from elsewhere than a scanner. */
const NO_CAMERA = /velo|lidar|laser|imu|gps|ins|world|map|base|ego|vehicle|body/i;
const NO_SCANNER = /cam|image|rgb|colou?r|imu|gps|world|map|base|ego|vehicle|body/i;
/** A camera's axes from x forward, y left and z up: the columns of R Q are those of R, in another order. */
const COLUMNS: [column: number, sign: number][] = [
  [2, 1],
  [0, -1],
  [1, -1],
];

/** Whether a cloud has axes of its own with z up, seen all around or along x or y. */
const isLidar = ({ depth }: CheckFrame): boolean => depth.points !== undefined && !isOptical(depth.points);

/** Whether a pose has the camera look along z, y down, as only a cloud in a camera's axes can be seen. */
function looksAlongZ({ pose, from = "", to = "" }: NamedPose): boolean {
  if (NO_CAMERA.test(to) || NO_SCANNER.test(from)) return false;
  return (pose.rotation[4] ?? 0) > NEAR && (pose.rotation[8] ?? 0) > NEAR;
}

function turned({ rotation, translation }: Pose): Pose {
  const entries = rotation.map((_, at) => {
    const [column, sign] = COLUMNS[at % 3] ?? [0, 1];
    return sign * (rotation[at - (at % 3) + column] ?? 0);
  });
  return poseOf(entries, [...translation]);
}

/** The poses for the axes of the frames' clouds, with a warning where one was turned. */
export function posesForClouds(poses: NamedPose[], frames: CheckFrame[], warnings: ReaderWarning[]): NamedPose[] {
  if (!frames.some(isLidar)) return poses;
  return poses.map((each) => {
    if (!looksAlongZ(each)) return each;
    const name = each.name ?? "without a name";
    const words = `The pose ${name} is for a cloud in a camera's axes (x right, y down, z forward), and the cloud's are those of a LiDAR: it was turned as for x forward, y left and z up (guessed).`;
    warnings.push(warning("pose-turned", words));
    return { ...each, pose: turned(each.pose) };
  });
}
