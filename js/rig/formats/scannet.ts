/** ScanNet's description of a scene: "m_calibrationColorIntrinsic = .." in sensor files, "fx_color = .." in released scenes. */
import { ofMatrix } from "./cameras.js";
import { Findings } from "./findings.js";
import { type Numbers, numbersByName } from "./numbers.js";
import { chained, inverseOf, isMoved, poseOfMatrix } from "./poses.js";
import type { Pose } from "../types.js";

const SENSOR = /^[ \t]*m_calibration(?:Color|Depth)Intrinsic[ \t]*=/m;
const SCENE = /^[ \t]*fx_(?:color|depth)[ \t]*=/m;

export const isScannet = (text: string): boolean =>
  SENSOR.test(text) || (SCENE.test(text) && /^[ \t]*mx_(?:color|depth)[ \t]*=/m.test(text));

export function readScannet(text: string): Findings {
  const found = new Findings();
  const entries = numbersByName(text, /^\s*(?:m_)?([\w.]{1,60}?)\s*=\s*(\S.*)$/);
  const one = (key: string) => entries.get(key)?.[0];
  for (const [side, name, takes] of [
    ["Color", "color", "colour"],
    ["Depth", "depth", "depth"],
  ] as const) {
    const k = entries.get(`calibration${side}Intrinsic`);
    const all = (...keys: string[]) => keys.map((key) => one(`${key}_${name}`) ?? NaN);
    if (k === undefined && !entries.has(`fx_${name}`)) continue;
    const intrinsics = k ? ofMatrix(k, 4) : { focal: all("fx", "fy"), centre: all("mx", "my") };
    found.camera({ name, ...intrinsics, width: one(`${name}Width`), height: one(`${name}Height`) }, takes);
  }
  posesOf(found, entries);
  const shift = one("depthShift");
  if (shift !== undefined && shift > 0) found.depthUnit = 1 / shift;
  return found;
}

const poseAt = (entries: Map<string, Numbers>, key: string): Pose | undefined => {
  const m = entries.get(key);
  return m?.length === 16 ? poseOfMatrix(m) : undefined;
};

/** Released scenes hold the pose from colour to depth. Sensor files hold the pose of each camera in a common frame. */
function posesOf(found: Findings, entries: Map<string, Numbers>): void {
  const names = { name: "depth to color", from: "depth", to: "color" };
  const back = poseAt(entries, "colorToDepthExtrinsics");
  if (back) found.poses.push({ ...names, pose: inverseOf(back) });
  const [colour, depth] = [poseAt(entries, "calibrationColorExtrinsic"), poseAt(entries, "calibrationDepthExtrinsic")];
  if (colour === undefined || depth === undefined) return;
  found.poses.push({ ...names, pose: chained(inverseOf(colour), depth) });
  if (isMoved(colour) || isMoved(depth))
    found.warn(
      "pose-assumed",
      "The extrinsics were read as poses from each camera into a common frame, which is a guess: the file does not give their direction.",
    );
}
