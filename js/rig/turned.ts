/**
 * Extrinsics for a LiDAR's cloud in a camera's axes (x right, y down, z forward), although the cloud itself has a LiDAR's axes (x
 * forward, z up).
 *
 * With such extrinsics the camera would look along the axis that points up in the cloud, so they cannot be for the cloud as it is. They are
 * converted, P_camera = R Q P_cloud + t, with Q from x forward, y left, z up to a camera's axes. Limits: x forward, as in ROS, is a guess,
 * which a warning reports.
 */
import { ofBody } from "./formats/frames.js";
import { isOptical } from "./scan.js";
import type { CheckFrame, NamedPose } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

/** Cosine of 45 degrees; within this angle a direction is nearer to an axis than to any other. */
const NEAR = Math.SQRT1_2;
/** Frames that are neither a camera's (as the target of a pose) nor a scanner's (as its source). */
const NO_CAMERA = /velo|lidar|laser|imu|gps|ins|world|map|base|ego|vehicle|body/i;
const NO_SCANNER = /cam|image|rgb|colou?r|imu|gps|world|map|base|ego|vehicle|body/i;

/** Whether a cloud has a LiDAR's axes: it extends all around, or along x or y. */
const isLidar = ({ depth }: CheckFrame): boolean => depth.points !== undefined && !isOptical(depth.points);

/** Whether under a pose the camera looks along z with y down, which is only possible for a cloud in a camera's axes. */
function looksAlongZ({ pose, from = "", to = "" }: NamedPose): boolean {
  if (NO_CAMERA.test(to) || NO_SCANNER.test(from)) return false;
  return (pose.rotation[4] ?? 0) > NEAR && (pose.rotation[8] ?? 0) > NEAR;
}

/** The poses for the axes of the frames' clouds, with a warning for each that was converted. */
export function posesForClouds(poses: NamedPose[], frames: CheckFrame[], warnings: ReaderWarning[]): NamedPose[] {
  if (!frames.some(isLidar)) return poses;
  return poses.map((each) => {
    if (!looksAlongZ(each)) return each;
    const name = each.name ?? "without a name";
    const words = `The pose ${name} is for a cloud in a camera's axes (x right, y down, z forward), but the cloud has a LiDAR's axes. The pose was turned as if x were forward, y left and z up, which is a guess.`;
    warnings.push(warning("pose-turned", words));
    return { ...each, pose: ofBody(each.pose) };
  });
}
