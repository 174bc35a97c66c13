/** What may be chosen for a run. The lines on ranges and defaults follow from the rows of js/options.ts. */
import type { Matrix4 } from "./cameras.js";
import type { PoseMembers } from "./poses.js";

/** A Gaussian over lights: 27 coefficients R1..R9, G1..G9, B1..B9 of log shading in the colour view's frame, as `light` has them. */
export interface LightGaussian {
  /** 27 numbers. */
  mean: ArrayLike<number>;
  /** 27x27, symmetric and positive definite: 729 numbers row after row, or 27 rows. */
  covariance: ArrayLike<number> | ArrayLike<ArrayLike<number>>;
}

/** What may be chosen for a run. */
export interface Options {
  /**
   * The light: "estimate", or 27 known coefficients, R1..9, G1..9, B1..9, in the colour view's frame.
   * Range: 27 numbers.
   * @default "estimate"
   */
  light?: "estimate" | ArrayLike<number>;
  /** The lights to expect where the light is estimated. By default natural lights, indoors and outdoors. */
  prior?: LightGaussian;
  /**
   * The initial pose: "search" over all poses, "identity", or an approximate pose from which the registration starts.
   * @default "search"
   */
  start?: "search" | "identity" | Partial<PoseMembers> | Matrix4;
  /**
   * How far from a given initial pose the photometric registration may end: the rotation, and, where a translation is given, the object's
   * middle. Where no pose within fits the image better, the initial pose is kept and the status is "ambiguous".
   */
  startTolerance?: {
    /**
     * How far the rotation may end from the initial one.
     * Range: a number above zero, in degrees.
     * @default 30
     */
    degrees?: number;
    /**
     * How far the object's middle may end from where the initial pose puts it, in the colour view's unit. Default: the object's own width.
     * Range: a number above zero.
     */
    distance?: number;
  };
  /**
   * "free", or the scale to hold. With both cameras known it is 1 in any case.
   * Range: a number above zero.
   * @default "free"
   */
  scale?: "free" | number;
  /**
   * "joint": pose and light from the image residuals; "icp": ICP and RANSAC as in the paper; "fixed": keep the initial pose.
   * @default "joint"
   */
  registration?: "joint" | "icp" | "fixed";
  /**
   * "surface": heights of the whole surface, which are integrable; "pixel": the normal of each pixel by itself, as in the paper.
   * @default "surface"
   */
  shading?: "surface" | "pixel";
  /** Weights of the terms of the objective. */
  lambda?: {
    /**
     * How strongly a normal follows that of the other view.
     * Range: a number from zero to 1,000,000.
     * @default 0.05
     */
    prior?: number;
    /**
     * How strongly normals keep their unit length, with `shading: "pixel"`.
     * Range: a number from zero to 1,000,000.
     * @default 1
     */
    unit?: number;
    /**
     * How strongly the light follows the prior over natural lights.
     * Range: a number from zero to 1,000,000.
     * @default 0.000001
     */
    light?: number;
    /**
     * How strongly the refined depth follows the measured one.
     * Range: a number from zero to 1,000,000.
     * @default 0.01
     */
    refinement?: number;
  };
  /**
   * Whether the photometric registration starts tolerant and becomes strict; false shows what that is good for.
   * @default true
   */
  annealing?: boolean;
  /**
   * The loop converges once an iteration changes the rotation by less than this.
   * Range: a number above zero, in degrees.
   * @default 0.01
   */
  stopDegrees?: number;
  /**
   * The largest one sigma of the rotation about any axis of a run that ends "converged"; above it the run ends "ambiguous".
   * Range: a number above zero, in degrees.
   * @default 1.5
   */
  tolerance?: number;
  /**
   * Accepted distance of a correspondence in the image. Default: from the data.
   * Range: a number above zero, in pixels.
   */
  correspondenceDistance?: number;
  /**
   * Iterations after which the loop ends as "max-iterations".
   * Range: a whole number from 1 to 100,000.
   * @default 60
   */
  maxIterations?: number;
  /**
   * Of the random generator; the same seed gives the same result.
   * Range: a whole number from zero to 9,007,199,254,740,991.
   * @default 1
   */
  seed?: number;
  /**
   * Whether flying pixels and background inside the mask are trimmed. Where it leaves out over 15 % of the depths of a map without a mask, the end is at best "ambiguous".
   * @default true
   */
  trim?: boolean;
  /**
   * Threads, this one included. All of them share the search, and two the iterations of larger
   * views. The result is the same to the bit for any number of them. Messages pass while this one lets events through, as
   * `run` does, which also waits for answers; a copy of the pair is kept for the others.
   * Range: a whole number from 1 to 16.
   * @default 1
   */
  workers?: number;
}
