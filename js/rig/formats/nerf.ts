/**
 * `transforms.json` of nerfstudio, instant-ngp and Blender's synthetic scenes: one camera, or one for each frame, and its poses. These lead
 * from the camera into the world and are not extrinsics. They are converted from OpenGL's axes (y up, z backward) to OpenCV's.
 */
import { BROWN_NAMES, FISHEYE_NAMES, type RawCamera } from "./cameras.js";
import { CORNER } from "./colmap.js";
import { lensNamed } from "./lenses.js";
import { Findings, flat, ofOpenGL } from "./findings.js";
import { type Node, type Numbers, nodesOf, numberOf } from "./numbers.js";
import { parted } from "./poses.js";

/** Frames with focal lengths that differ by more than this share have different cameras. */
const ALIKE = 2e-3;

const framesOf = (root: Node): Node[] => nodesOf(root.frames);

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
  const isFisheye = (node.is_fisheye ?? fallback.is_fisheye) === true;
  const model = isFisheye ? "fisheye" : String(node.camera_model ?? fallback.camera_model ?? "opencv");
  const keys = lensNamed(model).family === "fisheye" ? FISHEYE_NAMES : BROWN_NAMES;
  return {
    // The files mostly come from COLMAP.
    ...{ name, focal: [fx, fy], centre: [cx - CORNER, cy - CORNER], width, height },
    ...{ model, isLens: true, distortion: keys.map((key) => n(key) ?? 0) },
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
  const single = whole ?? own[0];
  const focals: Numbers = own.map(({ focal }) => focal[0] ?? NaN);
  if (own.length > 0 && Math.max(...focals) / Math.min(...focals) - 1 > ALIKE) for (const raw of own) found.camera(raw);
  else if (single !== undefined) found.camera({ ...single, name: "camera" });
  else if ("camera_angle_x" in root)
    found.warn(
      "camera-left-out",
      `The camera was left out, because it has a field of view (camera_angle_x ${root.camera_angle_x}) but no image size. Add w and h.`,
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
      `The file has ${found.poses.length} poses of the camera in the world, which are not extrinsics between two cameras. They were turned from OpenGL's axes to OpenCV's.`,
    );
  return found;
}
