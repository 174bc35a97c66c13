/** Basalt's calibration.json: cameras, and their poses in the frame of the inertial unit. */
import type { NamedPose } from "../types.js";
import { BROWN_NAMES, FISHEYE_NAMES } from "./cameras.js";
import { Findings } from "./findings.js";
import { isNode, type Node, numberOf, numbersAt } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

/** The lens model and the names of its coefficients in OpenCV's order. */
const MODELS: Record<string, { model: string; lens: string[] }> = {
  pinhole: { model: "pinhole", lens: [] },
  "pinhole-radtan8": { model: "opencv", lens: BROWN_NAMES },
  kb4: { model: "fisheye", lens: FISHEYE_NAMES },
};

const bodyOf = (root: Node): Node => (isNode(root.value0) ? root.value0 : root);
const listOf = (value: unknown): unknown[] => (Array.isArray(value) ? value : []);

export const isBasalt = (root: Node): boolean =>
  listOf(bodyOf(root).intrinsics).some((each) => isNode(each) && "camera_type" in each && isNode(each.intrinsics));

/** T_imu_cam carries points of a camera into the inertial unit's frame. */
function placeOf(found: Findings, value: unknown, from: string): NamedPose | undefined {
  if (!isNode(value)) return undefined;
  const turn = ofQuaternion(numbersAt(value, ["qx", "qy", "qz", "qw"]), found.warnings);
  return found.pose(turn, numbersAt(value, ["px", "py", "pz"]), { name: `imu from ${from}`, from, to: "imu" });
}

export function readBasalt(root: Node): Findings {
  const found = new Findings();
  const body = bodyOf(root);
  const [sizes, places] = [listOf(body.resolution), listOf(body.T_imu_cam)];
  listOf(body.intrinsics).forEach((each, index) => {
    if (!isNode(each) || !isNode(each.intrinsics)) return;
    const numbers = each.intrinsics;
    const [width, height] = listOf(sizes[index]).map(numberOf);
    const type = String(each.camera_type);
    const known = Object.hasOwn(MODELS, type) ? MODELS[type] : undefined;
    found.camera({
      ...{ name: `cam${index}`, focal: numbersAt(numbers, ["fx", "fy"]), centre: numbersAt(numbers, ["cx", "cy"]) },
      ...{ width, height },
      // Cameras of an unsupported model get a coefficient, so that they are refused by name.
      ...{
        model: known?.model ?? type,
        distortion: known ? known.lens.map((key) => numberOf(numbers[key]) ?? 0) : [1],
      },
    });
  });
  const posed = places.map((each, index) => placeOf(found, each, `cam${index}`));
  for (const [index, pose] of posed.entries()) if (index > 0) found.relate(posed[index - 1], pose);
  return found;
}
