/** Results of easy_handeye and easy_handeye2: the pose of the camera in the robot's base or on its hand. */
import { Findings } from "./findings.js";
import { isNode, type Node, numbersAt } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

const motionOf = (root: Node): Node =>
  isNode(root.transformation) ? root.transformation : isNode(root.transform) ? root.transform : {};

export const isHandEye = (root: Node): boolean =>
  isNode(root.parameters) && "tracking_base_frame" in root.parameters && Object.keys(motionOf(root)).length > 0;

export function readHandEye(root: Node): Findings {
  const found = new Findings();
  const said = isNode(root.parameters) ? root.parameters : {};
  const motion = motionOf(root);
  const inHand = said.eye_on_hand === true || /hand/.test(String(said.calibration_type ?? ""));
  const frame = (key: string) => String(said[key] ?? key).slice(0, 60);
  const [from, to] = [frame("tracking_base_frame"), frame(inHand ? "robot_effector_frame" : "robot_base_frame")];
  const n = (node: unknown, keys: string[]) => numbersAt(isNode(node) ? node : {}, keys);
  const isFlat = "qw" in motion;
  const turn = isFlat ? n(motion, ["qx", "qy", "qz", "qw"]) : n(motion.rotation, ["x", "y", "z", "w"]);
  const shift = isFlat ? n(motion, ["x", "y", "z"]) : n(motion.translation, ["x", "y", "z"]);
  found.pose(ofQuaternion(turn, found.warnings), shift, { name: `${to} from ${from}`, from, to });
  return found;
}
