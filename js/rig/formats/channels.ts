/** What clouds hold beside places: which laser, how strong, when. By the names that drivers and tools give them. */
import type { Scan } from "../lidar/scan.js";

export type Channel = "ring" | "intensity" | "times";

const NAMES: [Channel, RegExp][] = [
  ["ring", /^(?:ring|channel|laser_?id|beam_?id|line)$/i],
  ["intensity", /^(?:intensity|reflectivity|reflectance|remission|i)$/i],
  ["times", /^(?:time|timestamp|time_stamp|t|offset_?time|gps_?time|point_time_offset)$/i],
];
/** Of CloudCompare, before the names of all that is no place and no colour. */
const PREFIX = /^scalar_/i;

export const channelOf = (field: string): Channel | undefined =>
  NAMES.find(([, pattern]) => pattern.test(field.replace(PREFIX, "")))?.[0];

/** Room for the channels of so many points. */
export function roomFor(count: number, channels: readonly (Channel | undefined)[]): Omit<Scan, "points"> {
  return {
    ...(channels.includes("ring") && { ring: new Float32Array(count) }),
    ...(channels.includes("intensity") && { intensity: new Float32Array(count) }),
    ...(channels.includes("times") && { times: new Float64Array(count) }),
  };
}

/** Fewer points say nothing of how they were scanned, nor of a calibration. */
export const FEWEST_POINTS = 200;
