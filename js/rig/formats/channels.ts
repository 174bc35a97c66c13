/** Channels of clouds besides coordinates: laser, intensity and time, by the names that drivers and tools use. */
import type { Scan } from "../lidar/scan.js";

export type Channel = "ring" | "intensity" | "times";

const NAMES: [Channel, RegExp][] = [
  ["ring", /^(?:ring|channel|laser_?id|beam_?id|line)$/i],
  ["intensity", /^(?:intensity|reflectivity|reflectance|remission|i)$/i],
  ["times", /^(?:time|timestamp|time_stamp|t|offset_?time|gps_?time|point_time_offset)$/i],
];
/** CloudCompare's prefix for everything but coordinates and colours. */
const PREFIX = /^scalar_/i;

export const channelOf = (field: string): Channel | undefined =>
  NAMES.find(([, pattern]) => pattern.test(field.replace(PREFIX, "")))?.[0];

/** Empty channels for this number of points. */
export function roomFor(count: number, channels: readonly (Channel | undefined)[]): Omit<Scan, "points"> {
  return {
    ...(channels.includes("ring") && { ring: new Float32Array(count) }),
    ...(channels.includes("intensity") && { intensity: new Float32Array(count) }),
    ...(channels.includes("times") && { times: new Float64Array(count) }),
  };
}

/** Smallest number of points of a scan; fewer show neither the pattern of the scanner nor whether a calibration is right. */
export const FEWEST_POINTS = 200;

/** One column of a table with this many numbers per row. */
export const columnOf = (values: ArrayLike<number>, columns: number, column: number): Float32Array =>
  Float32Array.from({ length: Math.floor(values.length / columns) }, (_, row) => values[row * columns + column] ?? NaN);

/** The first three columns of such a table, x y z, point after point. */
export function pointsOf(values: ArrayLike<number>, columns: number): Float32Array {
  const points = new Float32Array(3 * Math.floor(values.length / columns));
  for (let at = 0; at < points.length; at++) points[at] = values[Math.floor(at / 3) * columns + (at % 3)] ?? NaN;
  return points;
}
