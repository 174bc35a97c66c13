/** Single parts of the method, for inspection. */

/** One pixel whose objective is evaluated. */
export interface PixelLandscapeRequest {
  /** Natural logarithms of its linear R, G, B. */
  log: ArrayLike<number>;
  /** 27 coefficients with the exposure. */
  light: ArrayLike<number>;
  /** The unit normal of a depth map at this pixel. */
  prior?: ArrayLike<number>;
  /** Weight of the prior, `lambda.prior` of `Options`. Default 0. */
  weight?: number;
  /** Whether a prior that is far off loses its weight, as in the loop. Default true; false gives Eq. 9 as printed in the paper. */
  robust?: boolean;
  /** The unit normal at which the descent of `path` starts. Default: toward the camera. */
  start?: ArrayLike<number>;
  /** Columns and rows of `objective`, 0 .. 512. Default 96. */
  side?: number;
}

/** The objective of one pixel over all normals that a camera can see (Eq. 6). */
export interface PixelLandscape {
  /** The objective, seen from the camera: n_x grows with the column, n_y with the row, both from -1 to 1; NaN without a normal. */
  objective: Float32Array;
  /** The minima, the lowest first, five numbers each: unit normal, objective, share of all directions whose descent ends there. */
  minima: Float32Array;
  /** The normals after each step of one descent, three numbers each. */
  path: Float32Array;
}

/** A surface that looks like another one, with its lamp. */
export interface BasRelief {
  /** Unit normals of the surface, three numbers each. */
  normals: Float32Array;
  /** The factor of each albedo. */
  albedo: Float32Array;
  /** Direction to its lamp times the lamp's strength. */
  lamp: Float64Array;
}

/** A picture of a matte surface of albedo 1 under one lamp, and the bright spot from which its strips start. */
export interface StripsRequest {
  /** Width * height intensities, row by row, NaN outside the object. */
  intensity: Float32Array;
  /** Columns, 1 .. 4096. */
  width: number;
  /** Rows, 1 .. 4096. */
  height: number;
  /** Unit vector to the lamp; toward the camera is -z. */
  lamp: ArrayLike<number>;
  /** Column and row of a spot at which the surface faces the lamp. */
  centre: ArrayLike<number>;
  /** Whether the surface at the spot is assumed to be a dent. Default false: a bump. */
  dent?: boolean;
  /** Strips, 0 .. 360. Default 24. */
  count?: number;
}
