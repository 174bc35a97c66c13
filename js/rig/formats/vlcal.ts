/** `calib.json` of direct_visual_lidar_calibration (Koide et al.): a camera and its pose in the frame of a LiDAR. */
import { Findings, flat } from "./findings.js";
import { isNode, type Node } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

const RESULTS = ["T_lidar_camera", "init_T_lidar_camera", "init_T_lidar_camera_auto"];

export const isVlcal = (root: Node): boolean =>
  isNode(root.camera) && "camera_model" in root.camera && (isNode(root.results) || isNode(root.meta));

/** The poses are x y z qx qy qz qw and carry points of the camera into the LiDAR's frame. */
export function readVlcal(root: Node): Findings {
  const found = new Findings();
  const camera = isNode(root.camera) ? root.camera : {};
  const numbers = Array.isArray(camera.intrinsics) ? (camera.intrinsics as number[]) : [];
  const model = String(camera.camera_model);
  found.camera(
    {
      ...{ name: "camera", focal: numbers.slice(0, 2), centre: numbers.slice(2, 4), model },
      distortion: Array.isArray(camera.distortion_coeffs) ? (camera.distortion_coeffs as number[]) : [],
    },
    "colour",
  );
  const results = isNode(root.results) ? root.results : {};
  for (const name of RESULTS) {
    const seven = flat(results[name], 7);
    if (seven === undefined) continue;
    found.pose(ofQuaternion(seven.slice(3), found.warnings), seven.slice(0, 3), { name, from: "camera", to: "lidar" });
  }
  if (found.poses.length > 0 && !("T_lidar_camera" in results))
    found.warn(
      "pose-assumed",
      "The pose is the initial guess of direct_visual_lidar_calibration, not its result. Run the calibration for T_lidar_camera.",
    );
  return found;
}
