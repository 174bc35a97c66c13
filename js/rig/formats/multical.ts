/**
 * multical's calibration.json: cameras, and poses relative to one of them, which are called "CAMERA_to_REFERENCE".
 *
 * Its names and its code disagree on the direction. The name says that points of the camera are carried to the reference; its exporter writes
 * the pose that carries points of the reference to the camera.
 */
import { Findings } from "./findings.js";
import { type Node, isNode } from "./numbers.js";
import { searchTree } from "./tree.js";

export const isMultical = ({ cameras, camera_poses: poses }: Node): boolean =>
  isNode(cameras) &&
  isNode(poses) &&
  Object.values(cameras).every((each) => isNode(each) && "image_size" in each && "K" in each && "dist" in each);

export function readMultical(whole: Node): Findings {
  const found = Object.assign(new Findings(), searchTree(whole));
  const [named] = found.poses.filter(({ from, to }) => from !== undefined && to !== undefined);
  if (named)
    found.warn(
      "pose-assumed",
      `"${named.name}" was read as its name says, from ${named.from} to ${named.to}, but multical's exporter writes the opposite direction under this name. Check both, and write the right one as a 4x4 matrix into depth_to_color.txt.`,
    );
  return found;
}
