/** A raster and what its file says about it; the readers of pictures end here. */
import type { Raster } from "../../npy.js";
import type { Pixels } from "../../raster.js";
import type { Scan } from "../lidar/scan.js";
import type { ReaderWarning } from "../warnings.js";

export interface Picture extends Raster<Pixels> {
  /** Of the array of an archive. */
  name?: string;
  /** "PNG", "PFM" and so on. */
  format: string;
  /** Of a channel, as in the file. */
  bits: number;
  /** Metres per stored unit, where the file says it. */
  unit?: number;
  /** How integers encode intensity, where the file says it. */
  transfer?: "srgb" | "linear";
  /** Additions to what is said, such as how it was turned. */
  notes: string[];
  warnings: ReaderWarning[];
  /** In place of pixels: points in no rows and columns. */
  scan?: Scan;
}

/** An organised cloud, NaN where there is no point. */
export interface Cloud {
  format: string;
  width: number;
  height: number;
  points: Float32Array;
  notes: string[];
  warnings: ReaderWarning[];
}

/** Points in no rows and columns. */
export interface Points {
  format: string;
  scan: Scan;
  /** Whether the format is in metres. */
  isMetric: boolean;
  notes: string[];
  warnings: ReaderWarning[];
}
