/** The points of a cloud that a camera may see, with a margin for errors of the calibration. */
import type { Pinhole } from "../types.js";
import { DEGREE, type Vector, dot } from "./frame.js";

/** A camera and its pose: P_camera = R P_cloud + t. */
export interface View {
  /** Row by row. */
  rotation: ArrayLike<number>;
  translation: ArrayLike<number>;
  camera: Pinhole;
  width: number;
  height: number;
}

/** Radians beyond the picture's border: a candidate calibration may be off by some degrees. */
const MARGIN = 8 * DEGREE;
/** Widest angle from the optical axis, radians; a pinhole's picture is not wider. */
const WIDEST = 85 * DEGREE;
/** Smallest depth of a usable point, metres. Nearer points are out of focus, and their directions are unreliable. */
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

/** Angles from the optical axis to the picture's borders: left, right, up, down. The margin covers the lens distortion, which is ignored. */
function borders({ camera, width, height }: View): [number, number, number, number] {
  const { fx, fy, cx, cy, model } = camera;
  const angle = (pixels: number, focal: number) => (model === "fisheye" ? pixels / focal : Math.atan(pixels / focal));
  return [angle(cx + 0.5, fx), angle(width - 0.5 - cx, fx), angle(cy + 0.5, fy), angle(height - 0.5 - cy, fy)];
}

/** Whether the camera may see a point of the cloud. */
export function seesOf(view: View): (point: Vector) => boolean {
  const [left, right, up, down] = borders(view).map((angle) => Math.min(WIDEST, angle + MARGIN)) as [
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
