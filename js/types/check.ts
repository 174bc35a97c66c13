/** The check of a calibration: its frames, its options and what it finds. */
import type { Pinhole, PinholeInput } from "./cameras.js";
import type { CheckCode, WarningCode } from "./codes.js";
import type { ColorImage, DepthMap } from "./images.js";
import type { Pose } from "./poses.js";

/** One pair from a rig whose calibration is to be checked. It holds the whole frames; masks are optional. Depth is metric. */
export interface CheckFrame {
  /** Without a camera the focal length is estimated, and the principal point is the middle of the image. */
  image: Omit<ColorImage, "camera"> & {
    /** The colour camera. */
    camera?: Pinhole;
  };
  /** A depth map with its camera, or an organised cloud in metres. */
  depth: Omit<DepthMap, "camera" | "normals"> & {
    /** The depth camera, which a depth map needs. */
    camera?: Pinhole;
  };
  /** The name of the frame in the report. Default: "frame 1" and so on. */
  name?: string;
}

/** A frame as it may be given: its cameras in any of the forms of `PinholeInput`. */
export interface CheckFrameInput extends Omit<CheckFrame, "image" | "depth"> {
  /** Without a camera the focal length is estimated, and the principal point is the middle of the image. */
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

/** The kinds of evidence in a frame. */
export type CheckCue = "shading" | "edges" | "information" | "silhouette";

/** How `checkCalibration` checks. */
export interface CheckOptions {
  /** The cues to use. Default: all. */
  cues?: CheckCue[];
  /** Number of threads that may be used, 1 to 16. At present one is used; the result does not depend on the number. */
  workers?: number;
  /** Ends the check; the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Called with the share of the work done, 0 .. 1, and a description of the current step. */
  onProgress?: (share: number, message: string) => void;
}

/** "consistent": the candidate agrees with the frames; "off": it does not; "undecided": the frames do not decide it. */
export type CheckVerdict = "consistent" | "off" | "undecided";

/** Something that was guessed, looks wrong or is missing, but does not stop the check. Further members are the numbers that belong to the code. */
export interface Warning {
  /** Stable, for programs. */
  code: WarningCode;
  /** The warning as a sentence. */
  message: string;
  /** The input that the warning is about, as a path in the contract. */
  field?: string;
  [detail: string]: unknown;
}

/** A convention in which calibrations, images ("image-") or depth maps ("depth-", "ray-length") are commonly misread. */
export type CheckReading =
  | "inverse"
  | "transposed-rotation"
  | "camera-centre"
  | "scalar-first"
  | "scalar-last"
  | "body-frames"
  | "body-depth"
  | "body-colour"
  | "millimetres"
  | "metres"
  | "radians"
  | "degrees"
  | "registered"
  | "quarter-turn"
  | "half-turn"
  | "quarter-back"
  | "image-mirrored"
  | "image-quarter-turn"
  | "image-half-turn"
  | "image-quarter-back"
  | "image-resized"
  | "image-cropped"
  | "depth-mirrored"
  | "depth-quarter-turn"
  | "depth-half-turn"
  | "depth-quarter-back"
  | "depth-resized"
  | "depth-cropped"
  | "ray-length"
  | "depth-millimetres"
  | "depth-metres";

/** The result for one candidate. */
export interface CandidateReport {
  /** The verdict on this candidate. */
  verdict: CheckVerdict;
  /** The reason, for programs. */
  code: CheckCode;
  /** The verdict in a sentence with its numbers. */
  reason: string;
  /** With the code "misread", the convention in which the candidate fits. */
  reading?: CheckReading;
  /** Angle between the candidate's rotation and the estimate's, degrees. */
  offDegrees: number;
  /** Shift of the scene's centre between the candidate and the estimate, millimetres. */
  offMillimetres: number;
  /**
   * Rotation and shift by axis, from the estimate to the candidate: degrees about x, y, z, then millimetres along them, in the colour
   * frame.
   */
  offAxes: [number, number, number, number, number, number];
  /** Expected reprojection error of the candidate at the scene's depth, pixels of the colour image, and its 95 % interval. */
  pixels: number;
  /** 95 % interval of `pixels`. */
  interval: [number, number];
  /** Probability that a right candidate is at least this far from the estimate. */
  probability: number;
}

/** The frame that would best determine the least certain unknown, and the sigma to expect, from the evidence of one frame. */
export interface NextFrame {
  /** The least certain unknown: a rotation about x, y, z through the scene's centre, or a translation along them, in the colour frame. */
  axis: "rx" | "ry" | "rz" | "tx" | "ty" | "tz";
  /** Its present sigma, degrees or millimetres. */
  sigma: number;
  /** Name of the frame with which the next one is compared. */
  frame: string;
  /** The place of the scene in the next frame: nearer, aside by a quarter of the image's width, or rotated by 90 degrees. */
  motion: "nearer" | "left" | "right" | "up" | "down" | "turned";
  /** The motion of the scene as a pose in the colour camera's frame, metres. */
  pose: Pose;
  /** Sigma with this frame added to those of the check, degrees or millimetres. */
  expected: number;
  /** The proposal in words. */
  message: string;
}

/** The result of checking a calibration. The first candidate is the one being checked (JavaScript puts names like "7" before all others). */
export interface CheckReport {
  /** The verdict on the first candidate. */
  verdict: CheckVerdict;
  /** The reason, for programs. */
  code: CheckCode;
  /** The verdict in a sentence with its numbers. */
  reason: string;
  /** With the code "misread", the convention in which the candidate fits. */
  reading?: CheckReading;
  /** What was guessed or looks wrong. With any warning the verdict is not "consistent". */
  warnings: Warning[];
  /** The extrinsics that fit best, scale 1: P_colour = R P_depth + t, metres. */
  estimate: Pose;
  /** Share of the depth points that the estimate puts onto the image, 0 to 1. Below 0.15 no calibration is "consistent". */
  overlap: number;
  /** The centre of the scene in the colour frame, metres. */
  middle: [number, number, number];
  /** 36 numbers, row-major: a rotation vector in rad about the scene's centre, then a translation in m, in the colour frame. */
  covariance: number[];
  /** Ratio of the estimated focal length to the assumed one, and the sigma of its logarithm, if no colour camera was given. */
  focal?: [number, number];
  /** Expected reprojection error of the estimate at the scene's depth, pixels of the colour image, and its 95 % interval. */
  health: {
    /** Pixels of the colour image. */
    pixels: number;
    /** 95 % interval of `pixels`. */
    interval: [number, number];
  };
  /** Largest expected error that passes, pixels of the colour image. */
  tolerance: number;
  /** The results for the candidates by name; the one being checked comes first. */
  candidates: Record<string, CandidateReport>;
  /** Each cue's share of the evidence, 0 to 1, and its sharpness: the inverse of its sigma in pixels of the colour image. */
  cues: Record<
    string,
    {
      /** Share of the evidence, 0 to 1. */
      share: number;
      /** The inverse of the cue's sigma, per pixel. */
      sharpness: number;
    }
  >;
  /** The contribution of each frame. */
  frames: {
    /** The frame's name as given, or "frame 1" and so on. */
    name: string;
    /** Share of the evidence, 0 to 1. */
    share: number;
    /** The fault of the frame, if it has one. */
    note?: string;
  }[];
  /** Decrease of each cue's log likelihood away from the estimate: offsets in degrees (rx ry rz) or millimetres (tx ty tz). */
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
  /** The frame to take next, unless the frames have no depth edges or the colour camera is a guess. */
  next?: NextFrame;
}

/** A frame, projected by a pose onto its image. */
export interface FrameOverlay {
  /** Column, row, metres of each visible depth point. */
  points: Float32Array;
  /** x, y, z of the same points in the colour camera's frame, metres. */
  positions: Float32Array;
  /** Column, row of each point of a depth edge. */
  edges: Float32Array;
}
