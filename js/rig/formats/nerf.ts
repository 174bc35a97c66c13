/**
 * `transforms.json` of nerfstudio, instant-ngp and Blender's synthetic scenes: one camera, or one of each frame, and where it stood. Those
 * poses lead from the camera into the world and are no extrinsics; they have OpenGL's axes (y up, z backward) and are turned into ours.
 */
import type { RawCamera } from "./cameras.js";
import { Findings, flat, ofOpenGL, parted } from "./findings.js";
import { isNode, type Node, type Numbers, numberOf } from "./numbers.js";

/** Principal points count from the corner of the first pixel, as COLMAP's, where these files mostly come from. */
const CORNER = 0.5;
const LENS = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
/** Frames whose focal lengths differ by more than this share do not share one camera. */
const ALIKE = 2e-3;

const framesOf = (root: Node): Node[] => (Array.isArray(root.frames) ? root.frames.filter(isNode) : []);

export const isNerf = (root: Node): boolean =>
  framesOf(root).some(({ transform_matrix }) => flat(transform_matrix, 16) !== undefined) ||
  ("fl_x" in root && ("w" in root || "cx" in root));

function cameraOf(node: Node, fallback: Node, name: string): RawCamera | undefined {
  const n = (key: string) => numberOf(node[key]) ?? numberOf(fallback[key]);
  const [width, height] = [n("w"), n("h")];
  const ofAngle = (angle: number | undefined, side: number | undefined) =>
    angle === undefined || side === undefined ? undefined : side / 2 / Math.tan(angle / 2);
  const fx = n("fl_x") ?? ofAngle(n("camera_angle_x"), width);
  const fy = n("fl_y") ?? ofAngle(n("camera_angle_y"), height) ?? fx;
  const [cx, cy] = [n("cx") ?? (width ?? NaN) / 2, n("cy") ?? (height ?? NaN) / 2];
  if (fx === undefined || fy === undefined || !Number.isFinite(cx) || !Number.isFinite(cy)) return undefined;
  const model = String(node.camera_model ?? fallback.camera_model ?? "OPENCV");
  const isFisheye = /fisheye/i.test(model) || fallback.is_fisheye === true;
  const keys = isFisheye ? ["k1", "k2", "k3", "k4"] : LENS;
  return {
    ...{ name, focal: [fx, fy], centre: [cx - CORNER, cy - CORNER], width, height },
    ...{ model: isFisheye ? "fisheye" : "opencv", distortion: keys.map((key) => n(key) ?? 0) },
  };
}

export function readNerf(root: Node): Findings {
  const found = new Findings();
  const frames = framesOf(root);
  const nameOf = (frame: Node, index: number) =>
    String(frame.file_path ?? index)
      .replace(/^.*\//, "")
      .replace(/\.\w{1,5}$/, "")
      .slice(0, 60);
  const whole = cameraOf(root, {}, "camera");
  const own = frames.flatMap((frame, index) => {
    const raw = "fl_x" in frame || "camera_angle_x" in frame ? cameraOf(frame, root, nameOf(frame, index)) : undefined;
    return raw ? [raw] : [];
  });
  const focals: Numbers = own.map(({ focal }) => focal[0] ?? NaN);
  if (own.length > 0 && Math.max(...focals) / Math.min(...focals) - 1 > ALIKE) for (const raw of own) found.camera(raw);
  else if (whole ?? own[0]) found.camera({ ...(whole ?? (own[0] as RawCamera)), name: "camera" });
  else if ("camera_angle_x" in root)
    found.warn(
      "camera-left-out",
      `The camera was left out: it has a field of view (camera_angle_x ${root.camera_angle_x}) and no size of its pictures (w, h).`,
    );
  frames.forEach((frame, index) => {
    const m = flat(frame.transform_matrix, 16);
    if (m === undefined) return;
    const [r, t] = parted(m);
    found.pose(ofOpenGL(r), t, { name: nameOf(frame, index), from: "camera", to: "world" });
  });
  if (found.poses.length > 0)
    found.warn(
      "camera-to-world",
      `Its ${found.poses.length} poses say where the camera stood in the world; they relate no two cameras, and have been turned from OpenGL's axes.`,
    );
  return found.done("a transforms.json of cameras in the world (nerfstudio)");
}
