/**
 * The metadata of a Record3D capture: K of the colour images column by column, and the size of the depth maps, which are smaller and
 * registered to them. The poses are those of the camera in the world, not extrinsics.
 */
import { scaledCamera } from "../scale.js";
import { Findings, flat } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";

/** Focal lengths that differ by more than this share between frames are those of a lens that focused. */
const ALIKE = 2e-3;

export const isRecord3d = (root: Node): boolean =>
  flat(root.K, 9) !== undefined && "w" in root && "h" in root && ("dw" in root || "fps" in root || "poses" in root);

export function readRecord3d(root: Node): Findings {
  const found = new Findings();
  const k = flat(root.K, 9) ?? [];
  const n = (key: string) => numberOf(root[key]);
  const byRows = Math.abs(k[2] ?? 0) > 1;
  const [fx = NaN, fy = NaN] = [k[0], k[4]];
  const centre = byRows ? [k[2] ?? NaN, k[5] ?? NaN] : [k[6] ?? NaN, k[7] ?? NaN];
  const raw = { name: "rgb", focal: [fx, fy], centre, width: n("w"), height: n("h") };
  const [width, height] = [n("dw"), n("dh")];
  const colour = found.camera(raw, width === undefined ? "both" : "colour");
  if (colour !== undefined && width !== undefined && height !== undefined) {
    const scaled = scaledCamera(colour.camera, [colour.width ?? width, colour.height ?? height], [width, height]);
    found.cameras.push({ name: "depth", camera: scaled, width, height, takes: "depth" });
  }
  const each = Array.isArray(root.perFrameIntrinsicCoeffs) ? root.perFrameIntrinsicCoeffs : [];
  const focals = each.map((four) => flat(four, 4)?.[0] ?? fx);
  if (focals.length > 0 && Math.max(...focals) / Math.min(...focals) - 1 > ALIKE)
    found.warn(
      "intrinsics-vary",
      `The focal length changes between frames, from ${Math.min(...focals).toFixed(1)} to ${Math.max(...focals).toFixed(1)}. That of the first frame, ${fx.toFixed(1)}, is used for all.`,
    );
  if (Array.isArray(root.poses) && root.poses.some((pose) => isNode(pose) || Array.isArray(pose)))
    found.warn(
      "pose-left-out",
      `The file has ${root.poses.length} poses of the camera in the world, which are not extrinsics between two cameras and were left out.`,
    );
  return found;
}
