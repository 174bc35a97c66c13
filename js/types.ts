/** The public contract: what goes in and what comes out. No value is hidden behind `any`. */

/** What `init` takes: where the .wasm is, or the .wasm itself; `bimodal_stereo_scalar_bg.wasm` needs no SIMD. Node also takes `file:` addresses. */
export type WasmSource = string | URL | Request | Response | BufferSource | WebAssembly.Module;

/**
 * A pinhole camera behind a lens. Distortion as OpenCV has it: of the model "brown" (the default) 4, 5 or 8 numbers,
 * k1 k2 p1 p2 [k3 [k4 k5 k6]]; of the model "fisheye" (Kannala-Brandt) the 4 numbers k1 k2 k3 k4. Units: pixels; pixel centres are whole
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
  /** Coefficients in OpenCV's order. Default: none; of a fisheye zeros. */
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

/**
 * One colour image of the object, up to 4096 pixels on a side. One that is finer than the depth map, by a quarter or more, is worked on at the depth
 * map's resolution; arrays, poses and options are in its own pixels all the same, and memory is asked for the working size.
 */
export interface ColorImage {
  /** Columns, 1 to 4096. */
  width: number;
  /** Rows, 1 to 4096. */
  height: number;
  /** Non-zero where the object is; all pixels without it. */
  mask?: Uint8Array;
  /** Without it the view is orthographic. */
  camera?: Pinhole;
  /** How integers encode intensity; 8 bit defaults to "srgb", 16 bit is guessed. Floats are linear. */
  transfer?: "srgb" | "linear";
  /** RGBA integers, or RGB interleaved linear floats > 0. */
  data: Uint8Array | Uint8ClampedArray | Uint16Array | Float32Array;
}

/** A colour image as it may be given: its camera in any of the forms of `PinholeInput`. */
export interface ColorImageInput extends Omit<ColorImage, "camera"> {
  /** Without it the view is orthographic. */
  camera?: PinholeInput;
}

/** One depth map of the same object from another view: `data` or `points`, exactly one of the two. */
export interface DepthMap {
  /** Columns, 1 to 4096. */
  width: number;
  /** Rows, 1 to 4096. */
  height: number;
  /** Non-zero where the object is; all pixels without it. */
  mask?: Uint8Array;
  /** Without it the view is orthographic, and its unit is the pixel. */
  camera?: Pinhole;
  /** Metres (or pixels, orthographic) per stored unit; default 1, and 0.001 for a Uint16Array with a camera. */
  unit?: number;
  /** Depth along z. Zero, negative, NaN, and 1e12 or more are holes: a depth that is relative has to be moved above zero. */
  data?: Float32Array | Uint16Array;
  /** An organised cloud, 3*w*h interleaved, NaN where missing; 1e12 or more is missing, too. */
  points?: Float32Array;
  /** Unit normals, 3*w*h interleaved; they override our own. */
  normals?: Float32Array;
}

/**
 * Whatever holds a colour image: a file (`Blob`), its bytes, its address or in Node its path; an element, a canvas, a bitmap or a frame of a
 * video in a browser.
 */
export type ImageSource = string | URL | Uint8Array | ArrayBuffer | ImageBitmapSource;

/** How `imageFrom` reads. */
export interface ImageOptions {
  /** Breaks off the download or the reading; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** A depth map as it may be given: its camera in any of the forms of `PinholeInput`. */
export interface DepthMapInput extends Omit<DepthMap, "camera"> {
  /** Without it the view is orthographic. */
  camera?: PinholeInput;
}

/**
 * P_colour = scale * rotation * P_depth + translation; rotation row-major; angles in degrees, R = Rx Ry Rz. A reported
 * beta lies within -90 .. 90; given angles may be anything from -360 to 360.
 */
export interface Pose {
  /** Size of the colour view's object relative to the depth view's, above zero; 1 between two metric cameras. */
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
  /** The same as one 4x4 matrix, four rows of four numbers: scale * rotation beside the translation, 0 0 0 1 below. */
  matrix: number[][];
}

/** A Gaussian over lights: 27 coefficients R1..R9, G1..G9, B1..B9 of log shading in the colour view's frame, as `light` has them. */
export interface LightGaussian {
  /** 27 numbers. */
  mean: ArrayLike<number>;
  /** 27x27, symmetric and positive definite: 729 numbers row after row, or 27 rows. */
  covariance: ArrayLike<number> | ArrayLike<ArrayLike<number>>;
}

/** A pose by its members. `rotation` wins over `matrix`, and both over `angles`. */
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
   * middle. Where no pose within fits the image better, the initial pose is kept and the status is "lost".
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

/** A stage of an iteration. */
export type Stage = "search" | "light" | "shading" | "surface" | "registration" | "refinement";
/** How a run stands: only "converged" ends with a pose to be trusted; "ambiguous" has rivals, "lost" a reason. */
export type Status = "running" | "converged" | "max-iterations" | "ambiguous" | "lost";

/** One sigma of the pose: the truth is (a small turn) times the estimate, about the axes of the colour view. */
export interface Uncertainty {
  /** About x, y and z of the colour view, degrees. */
  rotationDegrees: number[];
  /** Along x, y and z of the colour view, in its units; `null` where the views cannot see it. */
  translation: (number | null)[];
  /** Of the scale itself; `null` where it is held. */
  scale: number | null;
  /** The least certain direction in words. */
  weakest: string;
}

/** Why a run ended as it did, or what the last step of one that goes on came to; docs/codes.md has cause and remedy of each. */
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

/** A reason with its numbers, such as `percent`, `sigmaDegrees`, `weakest` or `count`. */
export interface Reason {
  /** Stable, for programs. */
  code: ReasonCode;
  [detail: string]: unknown;
}

/** How a run stands after a step. */
export interface StepReport {
  /** Iterations that are complete, from 0. */
  iteration: number;
  /** The one that ran last. */
  stage: Stage;
  /** The present pose. */
  pose: Pose;
  /** Degrees. */
  rotationChange: number;
  /** The terms of the objective, without unit. */
  energy: {
    /** Image residuals. */
    shading: number;
    /** Normals against those of the other view. */
    prior: number;
    /** Distances of correspondences. */
    registration: number;
    /** Refined depth against the measured one. */
    refinement: number;
    /** The sum. */
    total: number;
  };
  /** Share of valid depth pixels with a correspondence. */
  overlap: number;
  /** Share of those within the robust scale. */
  inliers: number;
  /** Robust mean log-colour residual. */
  residual: number;
  /** "running" until the loop ends. */
  status: Status;
  /** `reason` in words, which may change; programs decide by its code. */
  message?: string;
  /** Why the run ended as it did, or what the last step came to. */
  reason?: Reason;
  /** Other poses that fit the data as well, best first; only where the status is "ambiguous". */
  rivals?: Pose[];
  /** Once the loop has ended with a pose. */
  uncertainty?: Uncertainty;
  /** Wall time of each stage in the last step. */
  milliseconds: Record<string, number>;
}

/** A height map to make a sample from: larger is nearer, zero or NaN is background; 64x64 .. 512x512. */
export interface Relief {
  /** Columns, 64 to 512. */
  width: number;
  /** Rows, 64 to 512. */
  height: number;
  /** Width * height numbers, row by row, in the unit of a pixel. */
  heights: Float32Array;
}

/** A made scene with a known answer. */
export interface SampleRequest {
  /** "bust", "vase", "ripples", or heights of your own. */
  surface: string | Relief;
  /** "colourful", "window" or "overcast" (see `sampleLights`), or 27 numbers. */
  light: string | ArrayLike<number>;
  /**
   * Side of both views.
   * Range: a whole number from 16 to 1,024, in pixels.
   * @default 64
   */
  size?: number;
  /**
   * Height of both views where it differs from `size`.
   * Range: a whole number from 16 to 1,024, in pixels.
   */
  height?: number;
  /**
   * "rendered", the default: both views as cameras see them. "grid": samples 0, 8, 16, .. of the surface, without occlusion,
   * resampling and noise; the depth view is the image's own points, turned, as an organised cloud with its normals. Its size
   * follows from the surface; of the members below it takes `angles` and `overlap`.
   * @default "rendered"
   */
  protocol?: "rendered" | "grid";
  /** The pose to find. Default: beta = 20, the others 0. */
  angles?: {
    /**
     * About x.
     * Range: a number from -360 to 360, in degrees.
     * @default 0
     */
    alpha?: number;
    /**
     * About y. Default 20 where no angles are given.
     * Range: a number from -360 to 360, in degrees.
     * @default 0
     */
    beta?: number;
    /**
     * About z.
     * Range: a number from -360 to 360, in degrees.
     * @default 0
     */
    gamma?: number;
  };
  /**
   * Scale of the pose to find: the depth view is 1 / scale times as large.
   * Range: a number above zero.
   * @default 1
   */
  scale?: number;
  /**
   * Share of the depth map's valid columns that is kept, centred.
   * Range: a number above zero up to 1.
   * @default 1
   */
  overlap?: number;
  /**
   * Sigma of the Gaussian noise on log S.
   * Range: a number from zero.
   * @default 0
   */
  noise?: number;
  /**
   * Sigma of the Gaussian noise on depth.
   * Range: a number from zero, in pixels.
   * @default 0
   */
  depthNoise?: number;
  /**
   * Share of the depth pixels lost in holes.
   * Range: a number from zero below 1.
   * @default 0
   */
  holes?: number;
  /**
   * Of noise and holes.
   * Range: a whole number from zero to 9,007,199,254,740,991.
   * @default 1
   */
  seed?: number;
}

/** A rendered pair and its truth. */
export interface Sample {
  /** The colour image, linear floats. */
  image: ColorImage;
  /** The depth map, or with the protocol "grid" the organised cloud. */
  depth: DepthMap;
  /** The 27 coefficients that it was rendered with. */
  light: Float64Array;
  /** The pose to find. */
  pose: Pose;
  /** The truth to measure against, NaN outside the masks. */
  truth: {
    /** 3*w*h interleaved, image view. */
    imageNormals: Float32Array;
    /** w*h, image view, in its unit. */
    imageDepth: Float32Array;
    /** 3*w*h interleaved, depth view. */
    depthNormals: Float32Array;
    /** w*h, depth view, without noise and holes. */
    depth: Float32Array;
  };
}

/** How `Estimator.run` runs. */
export interface RunOptions {
  /** At most so many steps in this call, slices of the search included; `Options.maxIterations` counts iterations. */
  maxIterations?: number;
  /** Ends the run between two steps; the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Called with the report of each step. */
  onStep?: (report: StepReport) => void;
}

/** How `Estimator.restoreAsync` restores. */
export interface RestoreOptions {
  /** Breaks the repetition off; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** One pair of a rig whose calibration is in question: the whole frames; masks are optional. Depth is metric. */
export interface CheckFrame {
  /** Without a camera the focal length is estimated, the principal point being the middle of the image. */
  image: Omit<ColorImage, "camera"> & {
    /** The colour camera. */
    camera?: Pinhole;
  };
  /** A depth map with its camera, or an organised cloud in metres. */
  depth: Omit<DepthMap, "camera" | "normals"> & {
    /** The depth camera, which a depth map needs. */
    camera?: Pinhole;
  };
  /** How the report calls it; "frame 1" and so on without it. */
  name?: string;
}

/** A frame as it may be given: its cameras in any of the forms of `PinholeInput`. */
export interface CheckFrameInput extends Omit<CheckFrame, "image" | "depth"> {
  /** Without a camera the focal length is estimated, the principal point being the middle of the image. */
  image: Omit<CheckFrame["image"], "camera"> & {
    /** The colour camera. */
    camera?: PinholeInput;
  };
  /** A depth map with its camera, or an organised cloud in metres. */
  depth: Omit<CheckFrame["depth"], "camera"> & {
    /** The depth camera, which a depth map needs. */
    camera?: PinholeInput;
  };
}

/** What of a frame bears on the calibration. */
export type CheckCue = "shading" | "edges" | "information" | "silhouette";

/** How `checkCalibration` checks. */
export interface CheckOptions {
  /** The cues to use; all without it. */
  cues?: CheckCue[];
  /** Threads that may be used, 1 to 16; one is used so far. The result does not depend on it. */
  workers?: number;
  /** Ends the check; the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Share of the work done, 0 .. 1, and what is being done. */
  onProgress?: (share: number, message: string) => void;
}

/** "consistent": the candidate agrees with the frames; "off": it does not; "undecided": the frames do not tell. */
export type CheckVerdict = "consistent" | "off" | "undecided";

/** Why a verdict is what it is; docs/codes.md has cause and remedy of each. */
export type CheckCode =
  | "within-tolerance"
  | "nothing-against"
  | "off-target"
  | "no-points-on-image"
  | "guessed-camera"
  | "unconstrained"
  | "too-close"
  | "no-pose-on-image"
  | "no-evidence"
  | "no-candidate"
  | "doubtful";

/** What looks wrong about the input. */
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

/** What was guessed, looks wrong or is missing, and stops nothing; beside these members the numbers of the code. */
export interface Warning {
  /** Stable, for programs. */
  code: WarningCode;
  /** The same in a sentence. */
  message: string;
  /** The input that it is about, as a path in the contract. */
  field?: string;
  [detail: string]: unknown;
}

/** What an estimator does without. */
export type EstimatorWarningCode = "workers-unavailable";

/** What the place where an estimator runs lacks, and what the estimator does without. */
export interface EstimatorWarning {
  /** Stable, for programs. */
  code: EstimatorWarningCode;
  /** The same in a sentence. */
  message: string;
  /** The input that it is about, as a path in the contract. */
  field?: string;
}

/** What a check found of one candidate. */
export interface CandidateReport {
  /** Of this candidate. */
  verdict: CheckVerdict;
  /** Why, for programs. */
  code: CheckCode;
  /** The verdict in a sentence with its numbers. */
  reason: string;
  /** How far the candidate is from the estimate: turn in degrees, and shift at the scene's middle in millimetres. */
  offDegrees: number;
  /** Shift of the scene's middle between the candidate and the estimate, millimetres. */
  offMillimetres: number;
  /** Expected reprojection error of the candidate at the scene's depth, pixels of the colour image, and its 95 % interval. */
  pixels: number;
  /** 95 % interval of `pixels`. */
  interval: [number, number];
  /** Probability of a distance from the estimate as large as this, were the candidate right. */
  probability: number;
}

/** What a check of a calibration found. The first candidate is the one in question (JavaScript puts names like "7" before all others). */
export interface CheckReport {
  /** Of the first candidate. */
  verdict: CheckVerdict;
  /** Why, for programs. */
  code: CheckCode;
  /** The verdict in a sentence with its numbers. */
  reason: string;
  /** What was guessed or looks wrong; any of it keeps the verdict from being better than the files are. */
  warnings: Warning[];
  /** The extrinsics that fit best, scale 1: P_colour = R P_depth + t, metres. */
  estimate: Pose;
  /** The scene's middle in the colour frame, metres. */
  middle: [number, number, number];
  /** 36 numbers, row-major: a rotation vector in rad about the scene's middle, then a translation in m, in the colour frame. */
  covariance: number[];
  /** Factor of the assumed focal length and the logarithm's sigma, where the colour camera was not given. */
  focal?: [number, number];
  /** Expected reprojection error of the estimate at the scene's depth, pixels of the colour image, and its 95 % interval. */
  health: {
    /** Pixels of the colour image. */
    pixels: number;
    /** 95 % interval of `pixels`. */
    interval: [number, number];
  };
  /** By name, the one in question first. */
  candidates: Record<string, CandidateReport>;
  /** Each cue's share of the answer, 0 .. 1, and how sharp it is: one over its sigma in pixels of the colour image. */
  cues: Record<
    string,
    {
      /** Share of the answer, 0 to 1. */
      share: number;
      /** One over its sigma, per pixel. */
      sharpness: number;
    }
  >;
  /** What each frame contributes. */
  frames: {
    /** As given, or "frame 1" and so on. */
    name: string;
    /** Share of the answer, 0 to 1. */
    share: number;
    /** What is wrong with it, if anything. */
    note?: string;
  }[];
  /** How the log likelihood of each cue falls about the estimate: offsets in degrees (rx ry rz) or millimetres (tx ty tz). */
  sensitivity: {
    /** Name of the cue. */
    cue: string;
    /** Rotation about x, y, z, or translation along them. */
    axis: "rx" | "ry" | "rz" | "tx" | "ty" | "tz";
    /** Degrees or millimetres from the estimate. */
    offsets: number[];
    /** Log likelihood at each offset, relative to the estimate. */
    values: number[];
  }[];
}

/** Which frame of which rendered rig to make: two cameras with lenses, sensors' noise, and a known answer. */
export interface RigRequest {
  /** What is in front of the cameras. */
  kind: "objects" | "sheet" | "boxes" | "room";
  /** Of the rig: cameras, lenses, extrinsics; default 0. */
  seed?: number;
  /** Frames of one seed share the rig, and show other things; default 0. */
  frame?: number;
  /** Factor of both sensors' noise; default 1. */
  noise?: number;
}

/** A rendered frame of a rig, with the answer. */
export interface RigSample extends CheckFrame {
  /** Says kind, seed and frame. */
  name: string;
  /** The extrinsics to be found. */
  pose: Pose;
}

/** What `Estimator.draw` can show: of the image view its normals, depth and residual, of the depth view what was refined. */
export type Layer = "normals" | "depth" | "residual" | "refined" | "refinedNormals";

/** How `Estimator.draw` turns numbers into colours; normals have theirs. */
export interface DrawOptions {
  /** The numbers at the map's ends; default: all of the layer's but a hundredth at either end. */
  range?: readonly [number, number];
  /** Default "viridis". */
  map?: "viridis" | "magma";
}

/** A frame as a pose lays it over its image. */
export interface FrameOverlay {
  /** Column, row, metres of each visible depth point. */
  points: Float32Array;
  /** x, y, z of the same points in the colour camera's frame, metres. */
  positions: Float32Array;
  /** Column, row of each point of a depth edge. */
  edges: Float32Array;
}

/** A mask read from a file: 255 where the object is, else 0. */
export interface Mask {
  /** Columns. */
  width: number;
  /** Rows. */
  height: number;
  /** A byte for each pixel, row by row. */
  data: Uint8Array;
}

/** One pixel whose objective is to be looked at. */
export interface PixelLandscapeRequest {
  /** Natural logarithms of its linear R, G, B. */
  log: ArrayLike<number>;
  /** 27 coefficients, exposure included. */
  light: ArrayLike<number>;
  /** A unit normal that a depth map has there. */
  prior?: ArrayLike<number>;
  /** Weight of the prior, `lambda.prior` of `Options`. Default 0. */
  weight?: number;
  /** Whether a prior that is far off loses its weight, as in the loop; default true. False is Eq. 9 as the paper prints it. */
  robust?: boolean;
  /** The unit normal at which the descent of `path` starts. Default: toward the camera. */
  start?: ArrayLike<number>;
  /** Columns and rows of `objective`, 0 .. 512. Default 96. */
  side?: number;
}

/** The objective of one pixel over all normals that a camera can see (Eq. 6). */
export interface PixelLandscape {
  /** Seen from the camera: n_x grows with the column, n_y with the row, both from -1 to 1; NaN where no normal is. */
  objective: Float32Array;
  /** The lowest first, five numbers each: unit normal, objective, share of all directions whose descent ends there. */
  minima: Float32Array;
  /** Normals from step to step of one descent, three numbers each. */
  path: Float32Array;
}
