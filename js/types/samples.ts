/** Rendered scenes with a known answer: pairs for the loop, and frames of rigs for the check. */
import type { CheckFrame } from "./check.js";
import type { ColorImage, DepthMap } from "./images.js";
import type { Pose } from "./poses.js";

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
