/** Rendered scenes with a known answer: pairs for the loop, and frames of rigs for the check. */
import type { CheckFrame } from "./check.js";
import type { ColorImage, DepthMap } from "./images.js";
import type { Pose, PoseInput } from "./poses.js";

/** A height map from which a sample is rendered: larger is nearer, zero or NaN is background; 64x64 .. 512x512. */
export interface Relief {
  /** Columns, 64 to 512. */
  width: number;
  /** Rows, 64 to 512. */
  height: number;
  /** Width * height numbers, row by row, in the unit of a pixel. */
  heights: Float32Array;
}

/** A rendered scene with a known answer. */
export interface SampleRequest {
  /** "bust", "vase", "ripples", or a height map. */
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
   * Height of both views if it differs from `size`.
   * Range: a whole number from 16 to 1,024, in pixels.
   */
  height?: number;
  /**
   * "rendered", the default: both views as cameras see them. "grid": samples 0, 8, 16, .. of the surface, without occlusion,
   * resampling and noise; the depth view holds the rotated points of the image as an organised cloud with normals. Its size follows from
   * the surface; of the members below, only `angles` and `overlap` apply.
   * @default "rendered"
   */
  protocol?: "rendered" | "grid";
  /** The true rotation. Default: beta = 20, the others 0. */
  angles?: {
    /**
     * About x.
     * Range: a number from -360 to 360, in degrees.
     * @default 0
     */
    alpha?: number;
    /**
     * About y. Default 20 if no angles are given.
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
   * The true scale: the depth view is 1 / scale times as large.
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
   * Seed of noise and holes.
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
  /** The 27 coefficients of the light with which it was rendered. */
  light: Float64Array;
  /** The true pose. */
  pose: Pose;
  /** The true values of the results, NaN outside the masks. */
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

/** Selects a frame of a rendered rig: two cameras with lenses, sensor noise, and a known answer. */
export interface RigRequest {
  /** The kind of scene in front of the cameras. */
  kind: "objects" | "sheet" | "boxes" | "room";
  /** Seed of the rig: cameras, lenses, extrinsics. Default 0. */
  seed?: number;
  /** Frames with the same seed share the rig and show different objects. Default 0. */
  frame?: number;
  /** Factor for the noise of both sensors. Default 1. */
  noise?: number;
  /** Motion of the scene's points in the colour camera's frame, metres. Default: no motion. */
  motion?: PoseInput;
}

/** A rendered frame of a rig, with the answer. */
export interface RigSample extends CheckFrame {
  /** A name made from the kind, the seed and the frame. */
  name: string;
  /** The true extrinsics. */
  pose: Pose;
}

/** A pair of the gallery: one object, rendered for a colour camera and for a depth sensor elsewhere. */
export type PairKind = "bust" | "knot" | "marble" | "relief" | "cut" | "bowl";

/** A rendered pair of the gallery, with masks, cameras and the answer. */
export interface PairSample {
  /** The kind of the pair. */
  name: string;
  /** 8-bit sRGB, with the mask of the object. */
  image: ColorImage;
  /** Millimetres with the noise, steps, holes and shadows of a sensor, with the mask of the object. */
  depth: DepthMap;
  /** The true pose. */
  pose: Pose;
}

/** How a mask is suggested. */
export interface SuggestOptions {
  /** Cancels the suggestion; the promise is rejected with the reason of the signal. */
  signal?: AbortSignal;
  /** Called after each of at most twelve rounds with the share of pixels that it changed. */
  onProgress?: (changed: number, round: number) => void;
}

/** A suggested mask of the object. */
export interface MaskSuggestion {
  /** 255 on the object, 0 elsewhere. */
  mask: Uint8Array;
  /** Share of the image that is the object, from 0 to 1. */
  share: number;
  /** Number of rounds that the suggestion took. */
  rounds: number;
  /** Share of the pixels that the last round changed, from 0 to 1; below 0.001 unless all twelve rounds were needed. */
  changed: number;
}
