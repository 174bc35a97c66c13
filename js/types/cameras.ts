/** Cameras, and the matrices in which cameras and poses may be given. */

/**
 * A pinhole camera behind a lens. Distortion follows OpenCV: for the model "brown" (the default) 4, 5 or 8 numbers,
 * k1 k2 p1 p2 [k3 [k4 k5 k6]]; for the model "fisheye" (Kannala-Brandt) the 4 numbers k1 k2 k3 k4. Units: pixels; pixel centres are whole
 * numbers.
 */
export interface Pinhole {
  /** Focal length along the rows, pixels, above zero. */
  fx: number;
  /** Focal length along the columns, pixels, above zero. */
  fy: number;
  /** Column of the principal point, pixels; the centre of the first pixel is 0. */
  cx: number;
  /** Row of the principal point, pixels; the centre of the first pixel is 0. */
  cy: number;
  /** Coefficients in OpenCV's order. Default: no distortion; for a fisheye, zeros. */
  distortion?: ArrayLike<number>;
  /** The lens model. Default "brown". */
  model?: "brown" | "fisheye";
}

/** A 3x3 camera matrix, fx 0 cx, 0 fy cy, 0 0 1, in pixels: three rows of three numbers, or its nine numbers row by row. */
export type Matrix3 = readonly ArrayLike<number>[] | ArrayLike<number>;

/** A 4x4 matrix [s R, t; 0 0 0 1]: four rows of four numbers, or its 16 numbers row by row. */
export type Matrix4 = readonly ArrayLike<number>[] | ArrayLike<number>;

/** A camera by its matrix, with its lens. */
export interface CameraMatrix extends Pick<Pinhole, "distortion" | "model"> {
  /** fx 0 cx, 0 fy cy, 0 0 1, in pixels. */
  K: Matrix3;
}

/** A pinhole camera as it may be given: its members, its matrix, or `{ K, distortion, model }`. */
export type PinholeInput = Pinhole | CameraMatrix | Matrix3;
