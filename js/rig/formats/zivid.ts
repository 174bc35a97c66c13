/** Intrinsics of a Zivid camera, with CameraMatrix beside Distortion, and the transform that its hand-eye calibration saves. */
import { Findings, flat } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";
import { parted } from "./poses.js";

/** Metres per unit of its translations. */
const MILLIMETRE = 0.001;
/** A member by its name, regardless of case and underscores, which YAML and Python write differently. */
const part = (node: unknown, name: string): unknown =>
  isNode(node) ? Object.entries(node).find(([key]) => key.toLowerCase().replace(/_/g, "") === name)?.[1] : undefined;
const bodyOf = (root: Node): unknown => part(root, "cameraintrinsics") ?? root;
const matrixOf = (root: Node) => flat(part(part(root, "floatmatrix"), "data"), 16);

export const isZivid = (root: Node): boolean => {
  const matrix = part(bodyOf(root), "cameramatrix");
  return (
    ["cx", "cy", "fx", "fy"].every((key) => numberOf(part(matrix, key)) !== undefined) || matrixOf(root) !== undefined
  );
};

export function readZivid(root: Node): Findings {
  const found = new Findings();
  const body = bodyOf(root);
  const [matrix, lens] = [part(body, "cameramatrix"), part(body, "distortion")];
  const [fx = NaN, fy = NaN, cx = NaN, cy = NaN] = ["fx", "fy", "cx", "cy"].map((key) => numberOf(part(matrix, key)));
  const distortion = ["k1", "k2", "p1", "p2", "k3"].map((key) => numberOf(part(lens, key)) ?? 0);
  // In a Zivid camera the same pixels measure colours and points.
  if (Number.isFinite(fx)) found.camera({ name: "camera", focal: [fx, fy], centre: [cx, cy], distortion }, "both");
  const m = matrixOf(root);
  if (m) {
    const [r, t] = parted(m);
    found.pose(
      r,
      t.map((value) => value * MILLIMETRE),
      { name: "transform" },
    );
    found.warn(
      "pose-assumed",
      "The transform of a Zivid relates its camera to a robot or a board, not two cameras. It was converted from millimetres.",
    );
  }
  return found;
}
