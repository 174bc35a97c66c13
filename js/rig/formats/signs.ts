/** Hints in the whole text of a file: its product, its sensors and the order of its quaternions. */

/** Hints in the whole text of a file. */
export interface Signs {
  isRealSense: boolean;
  order: "wxyz" | "xyzw" | undefined;
  hasImu: boolean;
  hasLidar: boolean;
  isARKit: boolean;
  isR3Live: boolean;
}
export function signsOf(text: string): Signs {
  const first = /\bw[ ,]+x[ ,]+y[ ,]+z\b|wxyz/i.test(text);
  const last = /\bx[ ,]+y[ ,]+z[ ,]+w\b|xyzw/i.test(text);
  return {
    isRealSense: /realsense|\bppx\b|brown[ _]conrady|"coeffs"/i.test(text),
    order: first === last ? undefined : first ? "wxyz" : "xyzw",
    hasImu: /imu/i.test(text),
    isR3Live: /r3live/i.test(text),
    isARKit:
      /trackingState|\bAR(?:Kit|Frame|Camera)|cameraPoseARFrame|worldMappingStatus|"imageResolution"|"columns"\s*:\s*\[/i.test(
        text,
      ),
    hasLidar: /lid(?:ar)?_|lidar|livox|velodyne/i.test(text),
  };
}
