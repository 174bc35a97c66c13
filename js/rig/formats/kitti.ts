/**
 * KITTI's calibrations: raw (calib_cam_to_cam.txt), object, tracking and odometry, and those of other datasets in the same form.
 *
 * The images are rectified, except those of raw recordings. A projection P = K [I | t] applies to points of the rectified frame of camera 0,
 * so K^-1 P_i R0_rect Tr carries points of the LiDAR into the frame of image i. Depth maps of the benchmarks are in the frame of camera 2.
 */
import { ofMatrix } from "./cameras.js";
import { named } from "./ends.js";
import { Findings } from "./findings.js";
import { type Numbers, numbersByName } from "./numbers.js";
import { chained, identity, inverseOf, poseOf, poseOfMatrix, rotationOf } from "./poses.js";
import type { Pose } from "../types.js";

/** Rounding of the published digits. */
const NEAR = 1e-6;

type Lines = Map<string, Numbers>;

/** "P2: 7.2 0 ..", or without the colon. */
const linesOf = (text: string): Lines => numbersByName(text, /^\s*([A-Za-z]\w{0,40}):?[ \t]+(\S.*)$/);

const KINDS = /^(?:P(?:_rect_)?\d{1,2}|Tr(?:_\w+)?|R0_rect|R_rect(?:_\d\d)?|K_\d\d)$/;

/** Whether a text of a raw recording has R and T: of the LiDAR in camera 0, or of the inertial unit in the LiDAR. */
const isSinglePose = (text: string, lines: Lines): boolean =>
  /^calib_time:/m.test(text) && lines.get("R")?.length === 9 && lines.get("T")?.length === 3;

export const isKitti = (text: string): boolean => {
  const lines = linesOf(text.slice(0, 20_000));
  const has = (pattern: RegExp, count: number) =>
    [...lines].some(([key, { length }]) => pattern.test(key) && length === count);
  if (isSinglePose(text.slice(0, 20_000), lines)) return true;
  return has(/^P(_rect_)?\d{1,2}$/, 12) || (has(/^Tr/, 12) && [...lines.keys()].every((key) => KINDS.test(key)));
};

/** The pose from the rectified frame of camera 0 to that of an image; undefined where P is not K [I | t]. */
function baseline(p: Numbers): Pose | undefined {
  const [fx = NaN, skew = NaN, cx = NaN, a = NaN, zero = NaN, fy = NaN, cy = NaN, b = NaN, ...last] = p;
  const isPinhole = [skew, zero, last[0] ?? NaN, last[1] ?? NaN].every((value) => Math.abs(value) < NEAR * fx);
  if (!isPinhole || Math.abs((last[2] ?? NaN) - 1) > NEAR) return undefined;
  const z = last[3] ?? NaN;
  return poseOf(identity().rotation, [(a - cx * z) / fx, (b - cy * z) / fy, z]);
}

export function readKitti(text: string): Findings {
  const found = new Findings();
  const lines = linesOf(text);
  const projections = [...lines].flatMap(([key, p]) => {
    const number = /^P(?:_rect_)?(\d{1,2})$/.exec(key)?.[1];
    return number === undefined || p.length !== 12 ? [] : [{ number, p, way: baseline(p) }];
  });
  // The colour images are those of camera 2.
  projections.sort((a, b) => Number(Number(b.number) === 2) - Number(Number(a.number) === 2));
  for (const { number, p } of projections) rectified(found, lines, number, p);
  for (const [key, k] of lines) raw(found, lines, key, k);
  if (projections.length > 0) lidar(found, lines, projections);
  else alone(found, lines);
  return found;
}

const nameOf = (number: string): string => `image_${number.padStart(/^\d\d$/.test(number) ? 2 : 1, "0")}`;
const isColour = (number: string): boolean => Number(number) === 2;

function rectified(found: Findings, lines: Lines, number: string, p: Numbers): void {
  const [width, height] = lines.get(`S_rect_${number}`) ?? [];
  found.camera(
    {
      ...{ name: nameOf(number), ...ofMatrix(p, 4), width, height },
    },
    // Depth maps of its benchmarks are registered to camera 2.
    isColour(number) ? "both" : "colour",
  );
}

/** The camera of images that were not rectified, with its pose. */
function raw(found: Findings, lines: Lines, key: string, k: Numbers): void {
  const number = /^K_(\d\d)$/.exec(key)?.[1];
  if (number === undefined || k.length !== 9) return;
  const [width, height] = lines.get(`S_${number}`) ?? [];
  found.camera(
    {
      ...{ name: `${nameOf(number)} (unrectified)`, ...ofMatrix(k) },
      ...{ distortion: lines.get(`D_${number}`) ?? [], width, height },
    },
    "colour",
  );
  const [r, t] = [lines.get(`R_${number}`), lines.get(`T_${number}`)];
  if (r?.length !== 9 || t?.length !== 3 || number === "00") return;
  found.pose(r, t, { name: `cam${number} from cam00`, from: "cam00", to: `cam${number}` });
}

const poseAt = (lines: Lines, ...keys: string[]): Pose | undefined => {
  const m = keys.map((key) => lines.get(key)).find(isMatrix);
  return m && poseOfMatrix(m);
};
const isMatrix = (values: Numbers | undefined): values is Numbers => values?.length === 12 || values?.length === 16;

const LIDAR = /velo|lidar|laser/i;
/** Names of KITTI's numbers. */
const USED =
  /^(?:P(?:_rect_)?\d{1,2}|Tr(?:_velo_(?:to_)?cam(?:_\d)?)?|R0_rect|R_rect(?:_\d\d)?|[KDRTS]_(?:rect_)?\d\d)$/;

/** A pose with a name that KITTI does not use: a matrix, or separate R and T. */
function otherPose(found: Findings, lines: Lines): { name: string; pose: Pose } | undefined {
  const others = [...lines].filter(([key]) => !USED.test(key) && !/imu/i.test(key));
  for (const [name, values] of others) {
    const [, label = ""] = /^R_(\w*[a-z]\w*)$/i.exec(name) ?? [];
    const shift = lines.get(`T_${label}`) ?? lines.get(`t_${label}`);
    if (label !== "" && values.length === 9 && shift?.length === 3)
      return { name: label, pose: poseOf(rotationOf(values, found.warnings), shift) };
    if (isMatrix(values)) return { name, pose: poseOfMatrix(values) };
  }
  return undefined;
}

/** The LiDAR's pose in camera 0 as converters from other datasets write it: "lidar2cam0", "Tr_cam_to_velo", "T_cam_lidar". */
function converted(found: Findings, lines: Lines): Pose | undefined {
  const other = otherPose(found, lines);
  if (other === undefined) return undefined;
  const { name, pose } = other;
  const { from = "", to = "" } = named(name.replace(/^Tr_/, ""), {});
  if (LIDAR.test(from) === LIDAR.test(to))
    found.warn(
      "pose-assumed",
      `"${name}" does not state which way it leads. It was read as the pose from the LiDAR to camera 0; name it Tr_velo_to_cam if that is right.`,
    );
  return LIDAR.test(to) && !LIDAR.test(from) ? inverseOf(pose) : pose;
}

/** The poses from the LiDAR into the frames of the rectified images. */
function lidar(found: Findings, lines: Lines, projections: { number: string; way: Pose | undefined }[]): void {
  const velo = poseAt(lines, "Tr_velo_to_cam", "Tr_velo_cam", "Tr_velo_to_cam_0", "Tr") ?? converted(found, lines);
  const r = lines.get("R0_rect") ?? lines.get("R_rect") ?? lines.get("R_rect_00");
  const rect = r?.length === 9 ? poseOf(rotationOf(r, found.warnings), [0, 0, 0]) : identity();
  for (const { number, way } of projections) {
    // Converters from other datasets write a pose for each camera, whose projection has no baseline.
    const own = poseAt(lines, `Tr_velo_to_cam_${number}`) ?? velo;
    if (own === undefined || way === undefined) continue;
    const name = nameOf(number);
    found.poses.push({
      name: `${name} from velodyne`,
      from: "velodyne",
      to: name,
      pose: chained(way, chained(rect, own)),
    });
  }
  // Raw recordings have the LiDAR's pose in a separate file; it leads into camera 0.
  if (velo === undefined)
    for (const { number, way } of projections) {
      const to = nameOf(number);
      if (way) found.poses.push({ name: `${to} from cam00`, from: "cam00", to, pose: chained(way, rect) });
    }
  const imu = poseAt(lines, "Tr_imu_to_velo", "Tr_imu_velo");
  if (imu) found.poses.push({ name: "velodyne from imu", from: "imu", to: "velodyne", pose: imu });
}

/** Poses in a file without projections lead into camera 0 before rectification. */
function alone(found: Findings, lines: Lines): void {
  const [r, t] = [lines.get("R"), lines.get("T")];
  // The LiDAR's file has delta_f and delta_c, the inertial unit's does not.
  const isLidar = lines.has("delta_f") || lines.has("delta_c");
  const [from, to] = isLidar ? ["velodyne", "cam00"] : ["imu", "velodyne"];
  if (r?.length === 9 && t?.length === 3) found.pose(r, t, { name: `${to} from ${from}`, from, to });
  const velo = poseAt(lines, "Tr_velo_to_cam", "Tr_velo_cam", "Tr");
  if (velo) found.poses.push({ name: "cam00 from velodyne", from: "velodyne", to: "cam00", pose: velo });
}
