/** The codes of ends, verdicts and warnings; docs/codes.md has cause and remedy of each code. */

/** Why a run ended, or the outcome of the last step of a run that continues; docs/codes.md has cause and remedy of each code. */
export type ReasonCode =
  | "searching"
  | "search-done"
  | "taken-back"
  | "pose-stays"
  | "shapes-stay"
  | "no-better-pose"
  | "iteration-cap"
  | "little-overlap"
  | "initial-pose-kept"
  | "not-observable"
  | "rotation-uncertain"
  | "albedo-varies"
  | "silhouette-blind"
  | "contrast-unexplained"
  | "unexplained"
  | "few-inliers"
  | "hollow"
  | "rivals"
  | "missing-depth-mask"
  | "missing-image-mask"
  | "other-unit"
  | "no-pose"
  | "size-runs-away"
  | "behind-camera"
  | "stage-failed";

/** The reason of a verdict; docs/codes.md has cause and remedy of each code. */
export type CheckCode =
  | "within-tolerance"
  | "nothing-against"
  | "off-target"
  | "misread"
  | "no-points-on-image"
  | "between-optima"
  | "guessed-camera"
  | "unconstrained"
  | "too-close"
  | "no-pose-on-image"
  | "little-overlap"
  | "no-evidence"
  | "no-candidate"
  | "doubtful";

/** Codes of warnings about the input. */
export type WarningCode =
  | "blank-image"
  | "intrinsics-guessed"
  | "many-holes"
  | "eight-bits"
  | "unusual-depths"
  | "rough-depth"
  | "far-apart"
  | "fits-inverted"
  | "lens-left-out";

/** Codes of features that the environment lacks; an estimator works without them. */
export type EstimatorWarningCode = "workers-unavailable";
