/** Intrinsics of a Zivid camera: CameraMatrix and Distortion side by side, and the transform that its hand-eye calibration saves. */
import { Findings, flat, parted } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";

const MILLIMETRE = 0.001;
const bodyOf = (root: Node): Node => (isNode(root.CameraIntrinsics) ? root.CameraIntrinsics : root);
const matrixOf = (root: Node) => flat(isNode(root.FloatMatrix) ? root.FloatMatrix.Data : undefined, 16);

export const isZivid = (root: Node): boolean => {
  const { CameraMatrix } = bodyOf(root);
  return (isNode(CameraMatrix) && "CX" in CameraMatrix && "FX" in CameraMatrix) || matrixOf(root) !== undefined;
};

export function readZivid(root: Node): Findings {
  const found = new Findings();
  const body = bodyOf(root);
  const n = (part: string) => {
    const node = body[part];
    return (key: string) => (isNode(node) ? numberOf(node[key]) : undefined);
  };
  const [matrix, lens] = [n("CameraMatrix"), n("Distortion")];
  if (matrix("FX") !== undefined)
    found.camera(
      {
        ...{ name: "camera", focal: [matrix("FX") ?? NaN, matrix("FY") ?? NaN] },
        ...{ centre: [matrix("CX") ?? NaN, matrix("CY") ?? NaN] },
        distortion: ["K1", "K2", "P1", "P2", "K3"].map((key) => lens(key) ?? 0),
      },
      // A Zivid's colours and points come from the same pixels.
      "both",
    );
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
      "A Zivid's transform is in millimetres and relates its camera to a robot or a board, not two cameras.",
    );
  }
  return found.done("a file of Zivid");
}
