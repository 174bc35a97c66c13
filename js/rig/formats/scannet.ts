/** A scene's text of ScanNet: "m_calibrationColorIntrinsic = .." of its sensor files, or "fx_color = .." of its released scenes. */
import { Findings, parted } from "./findings.js";
import { type Numbers, numberOf } from "./numbers.js";
import { chained, inverseOf, poseOf, rotationOf } from "./poses.js";
import type { Pose } from "../types.js";

const SENSOR = /^[ \t]*m_calibration(?:Color|Depth)Intrinsic[ \t]*=/m;
const SCENE = /^[ \t]*fx_(?:color|depth)[ \t]*=/m;

export const isScannet = (text: string): boolean =>
  SENSOR.test(text) || (SCENE.test(text) && /^[ \t]*mx_(?:color|depth)[ \t]*=/m.test(text));

function entriesOf(text: string): Map<string, Numbers> {
  const found = new Map<string, Numbers>();
  for (const line of text.split(/\r?\n/)) {
    const [, key = "", rest = ""] = /^\s*([\w.]{1,60})\s*=\s*(\S.*)$/.exec(line) ?? [];
    const numbers = rest.trim().split(/\s+/, 20).map(numberOf);
    if (key !== "" && numbers.every((each) => each !== undefined)) found.set(key.replace(/^m_/, ""), numbers);
  }
  return found;
}

export function readScannet(text: string): Findings {
  const found = new Findings();
  const entries = entriesOf(text);
  const one = (key: string) => entries.get(key)?.[0];
  for (const [side, name, takes] of [
    ["Color", "color", "colour"],
    ["Depth", "depth", "depth"],
  ] as const) {
    const k = entries.get(`calibration${side}Intrinsic`);
    const n = (key: string) => one(`${key}_${name}`) ?? NaN;
    const [focal, centre] = k
      ? [
          [k[0] ?? NaN, k[5] ?? NaN],
          [k[2] ?? NaN, k[6] ?? NaN],
        ]
      : [
          [n("fx"), n("fy")],
          [n("mx"), n("my")],
        ];
    if (k === undefined && !entries.has(`fx_${name}`)) continue;
    found.camera({ name, focal, centre, width: one(`${name}Width`), height: one(`${name}Height`) }, takes);
  }
  posesOf(found, entries);
  const shift = one("depthShift");
  if (shift !== undefined && shift > 0) found.depthUnit = 1 / shift;
  return found.done("a scene's text of ScanNet");
}

const poseAt = (entries: Map<string, Numbers>, key: string): Pose | undefined => {
  const m = entries.get(key);
  if (m?.length !== 16) return undefined;
  const [r, t] = parted(m);
  return poseOf(rotationOf(r, []), t);
};

/** Released scenes say how colour lies to depth; sensor files say of each how it lies to a frame of both, always the same. */
function posesOf(found: Findings, entries: Map<string, Numbers>): void {
  const names = { name: "depth to color", from: "depth", to: "color" };
  const back = poseAt(entries, "colorToDepthExtrinsics");
  if (back) found.poses.push({ ...names, pose: inverseOf(back) });
  const [colour, depth] = [poseAt(entries, "calibrationColorExtrinsic"), poseAt(entries, "calibrationDepthExtrinsic")];
  if (colour === undefined || depth === undefined) return;
  found.poses.push({ ...names, pose: chained(inverseOf(colour), depth) });
  const isMoved = ({ rotation: r, translation: t }: Pose) =>
    Math.hypot(...t, (r[0] ?? 0) - 1, (r[4] ?? 0) - 1, (r[8] ?? 0) - 1) > 1e-6;
  if (isMoved(colour) || isMoved(depth))
    found.warn(
      "pose-assumed",
      "Its extrinsics were taken to lead from each camera into a common frame; nothing in the file says so.",
    );
}
