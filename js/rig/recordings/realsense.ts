/**
 * librealsense's additions to standard messages: `tf/0` below the name of each stream, the motion from the reference of the device into the
 * stream, and `option/Depth Units/value` below the name of each sensor, the unit of its depths.
 */
import { chained, inverseOf } from "../formats/poses.js";
import type { NamedPose, Pose } from "../types.js";
import type { Shot } from "./source.js";

const STREAM = /^(.*)\/image\/data$/;
const MOTION = /^(.*)\/tf\/(\d+)$/;
const UNITS = /^(.*)\/option\/depth[ _]?units\/value$/i;

export const isStreamMotion = (topic: string): boolean => MOTION.test(topic);
export const isDepthUnit = (topic: string): boolean => UNITS.test(topic);

/** Metres per stored unit of the sensor whose images a topic holds. */
export function unitOf(track: string, units: ReadonlyMap<string, number>): number | undefined {
  for (const [topic, unit] of units) {
    const sensor = UNITS.exec(topic)?.[1];
    if (sensor !== undefined && unit > 0 && track.startsWith(`${sensor}/`)) return unit;
  }
  return undefined;
}

/** The motion between two streams. It is computed from the motions from one reference into both: P_stream = R P_reference + t. */
export function betweenStreams(from: Shot, to: Shot, motions: ReadonlyMap<string, Pose>): NamedPose | undefined {
  const [a, b] = [from, to].map(({ track }) => STREAM.exec(track)?.[1]);
  if (a === undefined || b === undefined) return undefined;
  for (const [topic, pose] of motions) {
    const [, stream, group = ""] = MOTION.exec(topic) ?? [];
    const other = motions.get(`${b}/tf/${group}`);
    if (stream === a && other) return { name: "librealsense", pose: chained(other, inverseOf(pose)), from: a, to: b };
  }
  return undefined;
}
