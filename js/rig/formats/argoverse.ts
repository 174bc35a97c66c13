/** Argoverse's calibrations: `vehicle_calibration_info.json` of version 1 and the tables of version 2. Quaternions are w x y z. */
import { Findings, flat } from "./findings.js";
import { isNode, type Node, type Numbers, numberOf, numbersAt } from "./numbers.js";
import { ofScalarFirst } from "./poses.js";

/** "vehicle_SE3_camera_": the target frame comes first. */
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
    const [k1 = 0, k2 = 0, k3 = 0] = Array.isArray(value.distortion_coefficients_)
      ? (value.distortion_coefficients_ as Numbers)
      : [];
    found.camera({
      ...{ name, focal: numbersAt(value, ["focal_length_x_px_", "focal_length_y_px_"]) },
      ...{ centre: numbersAt(value, ["focal_center_x_px_", "focal_center_y_px_"]) },
      ...{ distortion: [k1, k2, 0, 0, k3], skew: numberOf(value.skew_) },
      ...{ width: numberOf(value.width_), height: numberOf(value.height_) },
    });
    posesOf(found, value, `camera ${name}`);
  }
  posesOf(found, root, undefined);
  return found;
}

function posesOf(found: Findings, node: Node, camera: string | undefined): void {
  for (const [key, value] of Object.entries(node)) {
    const [, to, own = ""] = POSE.exec(key) ?? [];
    if (to === undefined || !isNode(value)) continue;
    const rotation = isNode(value.rotation) ? value.rotation.coefficients : value.rotation;
    const [q, t] = [flat(rotation, 4), flat(value.translation, 3)];
    if (q === undefined || t === undefined) continue;
    const from = camera ?? own.replace(/_/g, " ");
    found.pose(ofScalarFirst(q, found.warnings), t, { name: `${to} from ${from}`, from, to });
  }
}

const isRecord = (value: unknown): value is Node =>
  isNode(value) && "sensor_name" in value && (("qw" in value && "tx_m" in value) || "fx_px" in value);

/** The two tables of Argoverse 2 as records: the intrinsics, and the pose of each sensor in the vehicle. */
export const isArgoverse2 = (root: unknown): boolean => Array.isArray(root) && root.slice(0, 4).some(isRecord);

export function readArgoverse2(root: unknown[]): Findings {
  const found = new Findings();
  for (const record of root.filter(isRecord)) {
    const n = (key: string) => numberOf(record[key]);
    const all = (...keys: string[]) => numbersAt(record, keys);
    const name = String(record.sensor_name).slice(0, 60);
    if (n("fx_px") !== undefined) {
      const [k1 = 0, k2 = 0, k3 = 0] = [n("k1"), n("k2"), n("k3")];
      found.camera({
        ...{ name, focal: all("fx_px", "fy_px"), centre: all("cx_px", "cy_px"), distortion: [k1, k2, 0, 0, k3] },
        ...{ width: n("width_px"), height: n("height_px") },
      });
    }
    if (n("qw") === undefined) continue;
    const names = { name: `egovehicle from ${name}`, from: name, to: "egovehicle" };
    found.pose(ofScalarFirst(all("qw", "qx", "qy", "qz"), found.warnings), all("tx_m", "ty_m", "tz_m"), names);
  }
  return found;
}

const isTable = /^[^\n]*\bsensor_name\b[^\n]*\n/;
export const isArgoverse2Table = (text: string): boolean =>
  isTable.test(text) && /\b(?:fx_px|tx_m)\b/.test(text.slice(0, 400));

/** The two tables of Argoverse 2 as CSV. */
export function readArgoverse2Table(text: string): Findings {
  const [head = "", ...lines] = text.split(/\r?\n/).filter((line) => line.trim() !== "");
  const names = head.split(",").map((name) => name.trim());
  return readArgoverse2(
    lines.slice(0, 5000).map((line) => {
      const cells = line.split(",");
      return Object.fromEntries(names.map((name, at) => [name, cells[at]?.trim()]));
    }),
  );
}
