/** The check of a calibration: its frames, its options and what it finds. */
import type { Pinhole, PinholeInput } from "./cameras.js";
import type { CheckCode, WarningCode } from "./codes.js";
import type { ColorImage, DepthMap } from "./images.js";
import type { Pose } from "./poses.js";

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

/** A frame as a pose lays it over its image. */
export interface FrameOverlay {
  /** Column, row, metres of each visible depth point. */
  points: Float32Array;
  /** x, y, z of the same points in the colour camera's frame, metres. */
  positions: Float32Array;
  /** Column, row of each point of a depth edge. */
  edges: Float32Array;
}
