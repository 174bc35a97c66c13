/** Colour images, depth maps and masks, and the sources from which colour images are read. */
import type { Pinhole, PinholeInput } from "./cameras.js";

/**
 * One colour image of the object, up to 4096 pixels on a side. An image that is finer than the depth map by a quarter or more is processed
 * at the resolution of the depth map. Arrays, poses and options still refer to the pixels of the image; memory is allocated for the working
 * size.
 */
export interface ColorImage {
  /** Columns, 1 to 4096. */
  width: number;
  /** Rows, 1 to 4096. */
  height: number;
  /** A number for each pixel, not zero where the object is. Without a mask all pixels belong to the object. */
  mask?: Uint8Array;
  /** The intrinsics. Without them the view is orthographic. */
  camera?: Pinhole;
  /** How integers encode intensity; 8 bit defaults to "srgb", 16 bit is guessed. Floats are linear. */
  transfer?: "srgb" | "linear";
  /** RGBA integers, or RGB interleaved linear floats > 0. */
  data: Uint8Array | Uint8ClampedArray | Uint16Array | Float32Array;
}

/** A colour image as it may be given: its camera in any of the forms of `PinholeInput`. */
export interface ColorImageInput extends Omit<ColorImage, "camera"> {
  /** The intrinsics. Without them the view is orthographic. */
  camera?: PinholeInput;
}

/** One depth map of the same object from another view. It has either `data` or `points`. */
export interface DepthMap {
  /** Columns, 1 to 4096. */
  width: number;
  /** Rows, 1 to 4096. */
  height: number;
  /** A number for each pixel, not zero where the object is. Without a mask all pixels belong to the object. */
  mask?: Uint8Array;
  /** The intrinsics. Without them the view is orthographic, and its unit is the pixel. */
  camera?: Pinhole;
  /** Metres (or pixels, orthographic) per stored unit; default 1, and 0.001 for a Uint16Array with a camera. */
  unit?: number;
  /** Depth along z. Zero, negative numbers, NaN, and 1e12 or more are holes, so shift a relative depth above zero. */
  data?: Float32Array | Uint16Array;
  /** An organised cloud, 3*w*h interleaved. Points that are NaN, or 1e12 or more, are missing. */
  points?: Float32Array;
  /**
   * For the check of a calibration: the strength of the return at each pixel, or any other quantity that depends on the surface's
   * reflectivity, increasing or decreasing; NaN where unknown. Only its rank is used.
   */
  intensity?: Float32Array;
  /** Unit normals, 3*w*h interleaved; they replace those computed from the depth. */
  normals?: Float32Array;
}

/** A depth map as it may be given: its camera in any of the forms of `PinholeInput`. */
export interface DepthMapInput extends Omit<DepthMap, "camera"> {
  /** The intrinsics. Without them the view is orthographic. */
  camera?: PinholeInput;
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

/**
 * A source of a colour image: a file (`Blob`), its bytes, its address or in Node its path; an element, a canvas, a bitmap or a frame of a
 * video in a browser.
 */
export type ImageSource = string | URL | Uint8Array | ArrayBuffer | ImageBitmapSource;

/** Options of `imageFrom`. */
export interface ImageOptions {
  /** Cancels the download or the reading; the promise is rejected with the signal's reason. */
  signal?: AbortSignal;
}
