/**
 * Depth maps made from points in metres whose z is not forward: those of LiDARs and of mapping tools.
 *
 * Points keep their frame, in which x is forward and z up for most LiDARs; extrinsics have to be those of this frame.
 */
import type { Cloud } from "./formats/picture.js";
import { extentOf, isThere, sampled } from "./guess.js";
import { facesOneWay, meanDirection } from "./lidar/frame.js";
import { rangeOf } from "./lidar/scan.js";
import { quantile } from "./statistics.js";
import type { DepthReading, Unnamed } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Depth = Unnamed<DepthReading>;

/** Largest median distance of a LiDAR's points, metres; beyond it, the unit is the millimetre. */
const FARTHEST = 200;
/** The distance of each point from the origin. */
export function ranges(points: Float32Array): Float64Array {
  const found = new Float64Array(points.length / 3);
  for (let point = 0; point < found.length; point++) found[point] = rangeOf(points, 3 * point);
  return found;
}

/** Whether z is forward, as in a depth camera's frame: the points lie on one side, and extend farther along z than along x and y. */
export function isOptical(points: Float32Array): boolean {
  const mean = meanDirection(points);
  const [x, y, z] = mean;
  if (x === 0 && y === 0 && z === 0) return true;
  return facesOneWay(mean) && Math.abs(z) > Math.max(Math.abs(x), Math.abs(y));
}

interface Unit {
  metres: number;
  warnings: ReaderWarning[];
}

export function unitOf(sorted: Float64Array, isMetric: boolean, given: number | undefined): Unit {
  if (given !== undefined) return { metres: given, warnings: [] };
  const metres = quantile(sorted, 0.5) > FARTHEST ? 0.001 : 1;
  if (isMetric && metres === 1) return { metres, warnings: [] };
  const words = `The file does not state its unit. It was guessed to be ${metres === 1 ? "metres" : "millimetres"}; give the unit if that is wrong.`;
  return { metres, warnings: [warning("unit-guessed", words, { unit: metres })] };
}

interface Size {
  width: number;
  height: number;
  intensity?: Float32Array;
}

interface Seen {
  format: string;
  says: string;
  unit: Unit;
  notes: string[];
  warnings: ReaderWarning[];
}

/** The reading of a depth map of points in metres. */
export function reading(
  { width, height, intensity }: Size,
  points: Float32Array,
  { format, says, unit, notes, warnings }: Seen,
): Depth {
  const depth = { width, height, points, ...(intensity && { intensity }) };
  const { count, nearest, farthest } = extentOf(ranges(points));
  const valid = count / (width * height);
  const range: [number, number] = [nearest, farthest];
  return {
    kind: "depth",
    depth,
    guessed: unit.warnings.length > 0 ? ["unit"] : [],
    measured: { stored: format, valid, range },
    says: [
      says,
      `${(100 * valid).toFixed(1)} % valid`,
      `${range.map((value) => value.toFixed(2)).join(" to ")} m away`,
      ...notes,
    ].join(", "),
    warnings: [...warnings, ...unit.warnings],
  };
}

/** An organised cloud whose z is not forward. */
export function turnedCloud(cloud: Cloud, given: number | undefined): Depth {
  const { points, width, height, notes } = cloud;
  const unit = unitOf(sampled(ranges(points)), false, given);
  for (let at = 0; at < points.length; at += 3) {
    const there = isThere(rangeOf(points, at));
    for (let axis = 0; axis < 3; axis++) points[at + axis] = there ? (points[at + axis] ?? NaN) * unit.metres : NaN;
  }
  const warnings = [...cloud.warnings, warning("lidar-axes", AXES)];
  const says = `${width}x${height}, an organised cloud with the axes of a LiDAR`;
  return reading(cloud, points, { format: "an organised cloud", says, unit, notes, warnings });
}
const AXES =
  "The cloud's axes are not those of a camera: z is not forward, as with a LiDAR (x forward, z up). The points keep these axes, so that extrinsics have to be those of this frame.";
