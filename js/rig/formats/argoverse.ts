/** `vehicle_calibration_info.json` of Argoverse 1: names say which frame a pose leads into, quaternions are w x y z. */
import { Findings, flat } from "./findings.js";
import { isNode, type Node, type Numbers, numberOf } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

const POSE = /^(\w{1,40})_SE3_(\w{1,40}?)_?$/;

export const isArgoverse = (root: Node): boolean =>
  Array.isArray(root.camera_data_) || Object.keys(root).some((key) => POSE.test(key) && isNode(root[key]));

export function readArgoverse(root: Node): Findings {
  const found = new Findings();
  const cameras: unknown[] = Array.isArray(root.camera_data_) ? root.camera_data_ : [];
  for (const entry of cameras) {
    if (!isNode(entry) || !isNode(entry.value)) continue;
    const name = String(entry.key ?? "").replace(/^image_raw_/, "") || "camera";
    const { value } = entry;
    const number = (key: string) => numberOf(value[key]) ?? NaN;
    const [k1 = 0, k2 = 0, k3 = 0] = Array.isArray(value.distortion_coefficients_)
      ? (value.distortion_coefficients_ as Numbers)
      : [];
    found.camera({
      ...{ name, focal: [number("focal_length_x_px_"), number("focal_length_y_px_")] },
      ...{ centre: [number("focal_center_x_px_"), number("focal_center_y_px_")] },
      ...{ distortion: [k1, k2, 0, 0, k3], skew: numberOf(value.skew_) },
      ...{ width: numberOf(value.width_), height: numberOf(value.height_) },
    });
    posesOf(found, value, `camera ${name}`);
  }
  posesOf(found, root, undefined);
  return found.done("a calibration of Argoverse");
}

function posesOf(found: Findings, node: Node, camera: string | undefined): void {
  for (const [key, value] of Object.entries(node)) {
    const [, to, own = ""] = POSE.exec(key) ?? [];
    if (to === undefined || !isNode(value)) continue;
    const rotation = isNode(value.rotation) ? value.rotation.coefficients : value.rotation;
    const [q, t] = [flat(rotation, 4), flat(value.translation, 3)];
    if (q === undefined || t === undefined) continue;
    const [w = NaN, x = NaN, y = NaN, z = NaN] = q;
    const from = camera ?? own.replace(/_/g, " ");
    found.pose(ofQuaternion([x, y, z, w], found.warnings), t, { name: `${to} from ${from}`, from, to });
  }
}
