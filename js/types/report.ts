/** The report of a run after each step. */
import type { ReasonCode } from "./codes.js";
import type { Pose } from "./poses.js";

/** A stage of an iteration. */
export type Stage = "search" | "light" | "shading" | "surface" | "registration" | "refinement";

/** The status of a run. Only "converged" means that the pose can be trusted; "ambiguous" comes with `rivals`, "lost" with a reason. */
export type Status = "running" | "converged" | "max-iterations" | "ambiguous" | "lost";

/** One sigma of the pose. The true rotation is a small rotation, about the axes of the colour view, times the estimated one. */
export interface Uncertainty {
  /** About x, y and z of the colour view, degrees. */
  rotationDegrees: number[];
  /** Along x, y and z of the colour view, in its units; `null` if the views do not determine it. */
  translation: (number | null)[];
  /** Sigma of the scale itself; `null` if the scale is fixed. */
  scale: number | null;
  /** The least certain direction in words. */
  weakest: string;
}

/** A reason with its numbers, such as `percent`, `sigmaDegrees`, `weakest` or `count`. */
export interface Reason {
  /** Stable, for programs. */
  code: ReasonCode;
  [detail: string]: unknown;
}

/** The state of a run after a step. */
export interface StepReport {
  /** Number of complete iterations, from 0. */
  iteration: number;
  /** The stage that ran last. */
  stage: Stage;
  /** The present pose. */
  pose: Pose;
  /** Change of the rotation in the last iteration, degrees. */
  rotationChange: number;
  /** The terms of the objective, without unit. */
  energy: {
    /** Image residuals. */
    shading: number;
    /** Differences of the normals from those of the other view. */
    prior: number;
    /** Distances of correspondences. */
    registration: number;
    /** Image residuals predicted from the measured normals (Eq. 18). */
    refinement: number;
    /** The sum. */
    total: number;
  };
  /** Share of valid depth pixels with a correspondence. */
  overlap: number;
  /** Share of the visible depth points that lie within three medians of the image surface. */
  inliers: number;
  /** Robust mean log-colour residual. */
  residual: number;
  /** "running" until the loop ends. */
  status: Status;
  /** `reason` in words. The words may change; programs should use the code. */
  message?: string;
  /** Why the run ended, or the outcome of the last step. */
  reason?: Reason;
  /** Other poses that fit the data equally well, best first, once a search has found them. */
  rivals?: Pose[];
  /** The sigmas of the pose, once a registration has found it. */
  uncertainty?: Uncertainty;
  /** Wall time of each stage in the last step. */
  milliseconds: Record<string, number>;
}
