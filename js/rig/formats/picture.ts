/** The results of the readers of pictures and clouds. */
import type { Raster } from "../../npy.js";
import type { Pixels } from "../../raster.js";
import type { Scan } from "../lidar/scan.js";
import type { ReaderWarning } from "../warnings.js";

export interface Picture extends Raster<Pixels> {
  /** The name of the array in an archive. */
  name?: string;
  /** "PNG", "PFM" and so on. */
  format: string;
  /** Bits of a channel in the file. */
  bits: number;
  /** Metres per stored unit, if the file gives it. */
  unit?: number;
  /** The encoding of intensity by integers, if the file gives it. */
  transfer?: "srgb" | "linear";
  /** Additions to the description, for instance how the picture was turned. */
  notes: string[];
  warnings: ReaderWarning[];
  /** Unorganised points in place of pixels. */
  scan?: Scan;
}

/** An organised cloud; NaN where there is no point. */
export interface Cloud {
  format: string;
  width: number;
  height: number;
  points: Float32Array;
  /** Strength of each return in the file's own unit, if the file has it. */
  intensity?: Float32Array;
  notes: string[];
  warnings: ReaderWarning[];
}

/** Unorganised points. */
export interface Points {
  format: string;
  scan: Scan;
  /** Whether the numbers of the format are known to be metres. */
  isMetric: boolean;
  notes: string[];
  warnings: ReaderWarning[];
}
