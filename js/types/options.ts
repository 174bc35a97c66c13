/** The options of a run. The lines on ranges and defaults are generated from the rows of js/options.ts. */
import type { Matrix4 } from "./cameras.js";
import type { PoseMembers } from "./poses.js";

/** A Gaussian over lights: 27 coefficients R1..R9, G1..G9, B1..B9 of log shading in the colour view's frame, as `light` has them. */
export interface LightGaussian {
  /** 27 numbers. */
  mean: ArrayLike<number>;
  /** 27x27, symmetric and positive definite: 729 numbers row after row, or 27 rows. */
  covariance: ArrayLike<number> | ArrayLike<ArrayLike<number>>;
}

/** The options of a run. */
export interface Options {
  /**
   * The light: "estimate", or 27 known coefficients, R1..9, G1..9, B1..9, in the colour view's frame.
   * Range: 27 numbers.
   * @default "estimate"
   */
  light?: "estimate" | ArrayLike<number>;
  /** The prior over lights if the light is estimated. Default: natural lights, indoors and outdoors. */
  prior?: LightGaussian;
  /**
   * The initial pose: "search" over all poses, "identity", or an approximate pose from which the registration starts.
   * @default "search"
   */
  start?: "search" | "identity" | Partial<PoseMembers> | Matrix4;
  /**
   * How far from a given initial pose the photometric registration may end: the rotation and, if a translation is given, the object's
   * centre. If no pose within this tolerance fits the image better, the initial pose is kept and the status is "ambiguous".
   */
  startTolerance?: {
    /**
     * How far the rotation may end from the initial one.
     * Range: a number above zero, in degrees.
     * @default 30
     */
    degrees?: number;
    /**
     * How far the object's centre may end from its place in the initial pose, in the colour view's unit. Default: the object's own width.
     * Range: a number above zero.
     */
    distance?: number;
  };
  /**
   * "free", or a fixed scale. With both cameras known it is always 1.
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
   * "surface": heights of the whole surface, so that the normals are integrable; "pixel": independent normals for the pixels, as in the paper.
   * @default "surface"
   */
  shading?: "surface" | "pixel";
  /** Weights of the terms of the objective. */
  lambda?: {
    /**
     * Weight of the other view's normal as a prior.
     * Range: a number from zero to 1,000,000.
     * @default 0.05
     */
    prior?: number;
    /**
     * Weight of the unit length of normals, with `shading: "pixel"`.
     * Range: a number from zero to 1,000,000.
     * @default 1
     */
    unit?: number;
    /**
     * Weight of the prior over natural lights.
     * Range: a number from zero to 1,000,000.
     * @default 0.000001
     */
    light?: number;
    /**
     * Weight of the measured depth in the refined one.
     * Range: a number from zero to 1,000,000.
     * @default 0.01
     */
    refinement?: number;
  };
  /**
   * Whether the photometric registration starts with a tolerant robust scale and tightens it. Set to false to see the effect.
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
   * The largest sigma of the rotation about any axis with which a run ends "converged"; above it the run ends "ambiguous". ICP reports
   * sigmas, but its runs end regardless of them.
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
   * Seed of the random generator; the same seed gives the same result.
   * Range: a whole number from zero to 9,007,199,254,740,991.
   * @default 1
   */
  seed?: number;
  /**
   * Whether flying pixels and background inside the mask are trimmed. If more than 15 % of the depths of a map without a mask are trimmed,
   * the status is at best "ambiguous".
   * @default true
   */
  trim?: boolean;
  /**
   * Number of threads, including this one. All of them share the search, and two share the iterations of larger views. The result is
   * bit-identical for any number. Messages are exchanged while this thread lets events pass, as `run` does, which also waits for answers. A
   * copy of the pair is kept for the other threads.
   * Range: a whole number from 1 to 16.
   * @default 1
   */
  workers?: number;
}
