/**
 * `cams_lidars.json` of Audi's A2D2. `CamMatrixOriginal` and `Distortion` belong to the pictures as stored, and `CamMatrix` to pictures
 * that its tutorial has undistorted. The views are the sensors' poses in axes x forward, y left and z up, in which its clouds are stored,
 * too; they are left out.
 */
import { ofMatrix } from "./cameras.js";
import { Findings, flat } from "./findings.js";
import { type Node, isNode, matrixOf } from "./numbers.js";

const camerasOf = (root: Node): [string, Node][] =>
  isNode(root.cameras)
    ? Object.entries(root.cameras).filter(
        (entry): entry is [string, Node] => isNode(entry[1]) && flat(entry[1].CamMatrixOriginal, 9) !== undefined,
      )
    : [];

export const isA2d2 = (root: Node): boolean => camerasOf(root).length > 0;

export function readA2d2(root: Node): Findings {
  const found = new Findings();
  for (const [name, node] of camerasOf(root)) {
    const [width, height] = matrixOf(node.Resolution)?.values ?? [];
    found.camera({
      ...{ name, ...ofMatrix(flat(node.CamMatrixOriginal, 9) ?? []), width, height },
      model: node.Lens === "Telecam" ? "opencv" : String(node.Lens ?? ""),
      ...{ isLens: true, distortion: matrixOf(node.Distortion)?.values },
    });
  }
  found.warn(
    "distortion-guessed",
    "The cameras are those of A2D2's pictures before they are undistorted (CamMatrixOriginal and Distortion). For undistorted pictures give CamMatrix without distortion.",
  );
  found.warn(
    "pose-left-out",
    "The views of the sensors were not read as poses, because their axes are not those of cameras.",
  );
  return found;
}
