/**
 * The direction of a pose between a LiDAR and a camera if the file does not state it: the direction in which the camera stands upright.
 *
 * A LiDAR has z up and a camera y down, whichever way the camera looks. Limit: rigs that stand upright.
 */
import type { NamedPose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { inverseOf } from "./poses.js";

const LIDAR =
  /lid(?:ar)?(?![a-z])|lidar|velo(?:dyne)?|livox|ouster|\bos[012](?![a-z0-9])|hesai|pandar|rslidar|robosense|laser|cloud/i;
/** Cosine of the tilt at which a camera counts as upright, 45 degrees. */
const UPRIGHT = Math.SQRT1_2;

/** Whether a rotation from axes with z up leads to a camera whose y points down. */
const isUpright = (rotation: readonly number[]): boolean => (rotation[5] ?? 0) < -UPRIGHT;

/** Inverts a pose without frames whose name mentions a LiDAR, if the camera is upright only under its inverse. */
export function lookForward(found: NamedPose, called: string, warnings: ReaderWarning[]): void {
  if (found.from !== undefined || found.to !== undefined || !LIDAR.test(called.replaceAll("_", " "))) return;
  const back = inverseOf(found.pose);
  if (isUpright(found.pose.rotation) || !isUpright(back.rotation)) return;
  Object.assign(found, { from: "lidar", to: "camera", pose: back });
  warnings.push(
    warning(
      "pose-assumed",
      `"${found.name ?? "its pose"}" does not state its direction between the LiDAR and the camera. It was inverted, because only then does the camera stand upright on a LiDAR whose z points up; name it lidar_to_camera or camera_to_lidar.`,
    ),
  );
}
