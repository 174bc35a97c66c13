/** Poses in reports and as input. */
import type { Matrix4 } from "./cameras.js";

/**
 * P_colour = scale * rotation * P_depth + translation; rotation row-major; angles in degrees, R = Rx Ry Rz. A reported
 * beta lies within -90 .. 90; given angles may be anything from -360 to 360.
 */
export interface Pose {
  /** Size of the object in the colour view relative to its size in the depth view, above zero; 1 between two metric cameras. */
  scale: number;
  /** 3x3 row by row, orthonormal, nine numbers. */
  rotation: number[];
  /** x, y, z in the colour view's unit: metres with a camera, pixels without one. */
  translation: number[];
  /** The same rotation as three angles, degrees: Rx(alpha) Ry(beta) Rz(gamma). */
  angles: {
    /** About x, degrees, -180 to 180. */
    alpha: number;
    /** About y, degrees, -90 to 90. */
    beta: number;
    /** About z, degrees, -180 to 180. */
    gamma: number;
  };
  /** The whole pose as a 4x4 matrix, four rows of four numbers: scale * rotation beside the translation, with 0 0 0 1 below. */
  matrix: number[][];
}

/** A pose by its members. `rotation` has priority over `matrix`, and both over `angles`. */
export interface PoseMembers extends Omit<Pose, "matrix" | "angles"> {
  /** Degrees, each from -360 to 360. */
  angles?: Pose["angles"];
  /** The whole pose as [s R, t; 0 0 0 1]. */
  matrix?: Matrix4;
}

/** A pose as it may be given: its members, `{ matrix }`, or the 4x4 matrix itself. */
export type PoseInput =
  | PoseMembers
  | {
      /** The whole pose as [s R, t; 0 0 0 1]. */
      matrix: Matrix4;
    }
  | Matrix4;
