/** Which points of a cloud a camera may see, with a margin for a calibration that is wrong. */
import type { Pinhole } from "../types.js";
import { type Vector, dot } from "./frame.js";

/** A camera, and where points of the cloud lie for it: P_camera = R P_cloud + t. */
export interface View {
  /** Row by row. */
  rotation: ArrayLike<number>;
  translation: ArrayLike<number>;
  camera: Pinhole;
  width: number;
  height: number;
}

/** Radians beyond the picture's border: candidates may be off by some degrees. */
const MARGIN = (8 * Math.PI) / 180;
/** Widest angle from the axis, radians; a pinhole's picture has no wider. */
const WIDEST = (85 * Math.PI) / 180;
/** Nearer to the camera's plane than this, metres, nothing is in focus, and directions mean little. */
const NEAREST = 0.05;

const rowOf = ({ rotation }: View, row: number): Vector => [
  rotation[3 * row] ?? 0,
  rotation[3 * row + 1] ?? 0,
  rotation[3 * row + 2] ?? 0,
];
/** The camera's axes in the cloud's frame. */
export const forwardOf = (view: View): Vector => rowOf(view, 2);
export const upOf = (view: View): Vector => {
  const [x, y, z] = rowOf(view, 1);
  return [-x, -y, -z];
};

/** Angles from the axis to the picture's borders: left, right, up, down. A lens bends them by less than the margin. */
function borders({ camera, width, height }: View): [number, number, number, number] {
  const { fx, fy, cx, cy, model } = camera;
  const angle = (pixels: number, focal: number) => (model === "fisheye" ? pixels / focal : Math.atan(pixels / focal));
  return [angle(cx + 0.5, fx), angle(width - 0.5 - cx, fx), angle(cy + 0.5, fy), angle(height - 0.5 - cy, fy)];
}

/** Whether the camera may see a point of the cloud. */
export function seesOf(view: View, margin = MARGIN): (point: Vector) => boolean {
  const [left, right, up, down] = borders(view).map((angle) => Math.min(WIDEST, angle + margin)) as [
    number,
    number,
    number,
    number,
  ];
  const axes = [0, 1, 2].map((row) => rowOf(view, row)) as [Vector, Vector, Vector];
  const shift = [0, 1, 2].map((axis) => view.translation[axis] ?? 0) as Vector;
  return (point) => {
    const z = dot(axes[2], point) + shift[2];
    if (!(z > NEAREST)) return false;
    const across = Math.atan2(dot(axes[0], point) + shift[0], z);
    const along = Math.atan2(dot(axes[1], point) + shift[1], z);
    return across > -left && across < right && along > -up && along < down;
  };
}
