/** The frames of motions with names that only one product uses. */
import type { Frames, PoseNames } from "./ends.js";
import type { Signs } from "./signs.js";

/**
 * The frames of rotations and translations with names that only one product uses: FAST-LIO has the LiDAR in the inertial unit, VINS and
 * R3LIVE the camera.
 */
export function productFrames(turn: string, shift: string, { isR3Live }: Signs): Frames {
  if (turn === "extrinsic_R" && shift === "extrinsic_T") return { from: "lidar", to: "imu" };
  if (turn === "extrinsicRotation" && shift === "extrinsicTranslation") return { from: "camera", to: "imu" };
  return isR3Live && turn === "camera_ext_R" ? { from: "camera", to: "imu" } : {};
}

/** The frames of Kalibr's names, in which cn is the camera of the matrix and cnm1 the one before. */
export function kalibr(key: string, parent: string): PoseNames | undefined {
  const number = /^cam(\d+)$/.exec(parent)?.[1];
  if (number === undefined) return undefined;
  const before = `cam${Number(number) - 1}`;
  if (key === "T_cn_cnm1") return { name: `${parent} from ${before}`, from: before, to: parent };
  if (key === "T_cam_imu") return { name: `${parent} from imu`, from: "imu", to: parent };
  return undefined;
}
