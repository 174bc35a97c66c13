/**
 * Unorganised points and clouds whose z is not forward as depth maps in metres: those of LiDARs and of mapping tools.
 *
 * Points keep their frame, in which x is forward and z up for most LiDARs; extrinsics have to be those of this frame.
 */
import { badFile } from "../errors.js";
import type { Cloud, Points } from "./formats/picture.js";
import { extentOf, isThere, sampled } from "./guess.js";
import { facesOneWay, meanDirection } from "./lidar/frame.js";
import type { RangeImage, Scan } from "./lidar/index.js";
import { rangeOf } from "./lidar/scan.js";
import { quantile } from "./statistics.js";
import type { DepthReading, ReadOptions, Unnamed } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Depth = Unnamed<DepthReading>;

/** The median distance of a LiDAR's points, metres, at most; beyond it, the unit is the millimetre. */
const FARTHEST = 200;
const HOW: Record<RangeImage["how"], string> = {
  ring: "by the file's rings",
  order: "by the turns in the order of its points",
  elevation: "by clusters of elevations",
  sphere: "by a z-buffer over the sphere",
};

/** The distance of each point from the origin. */
function ranges(points: Float32Array): Float64Array {
  const found = new Float64Array(points.length / 3);
  for (let point = 0; point < found.length; point++) found[point] = rangeOf(points, 3 * point);
  return found;
}

/** Whether z is forward, as in a depth camera's frame: the points lie to one side, and along z more than along x and y. */
export function isOptical(points: Float32Array): boolean {
  const mean = meanDirection(points);
  const [x, y, z] = mean;
  if (x === 0 && y === 0 && z === 0) return true;
  return facesOneWay(mean) && Math.abs(z) > Math.max(Math.abs(x), Math.abs(y));
}

/** The median distance, units of the file, beyond which points have the coordinates of a map if their distances spread by less than this share. */
const [FAR_OFF, NARROWLY] = [10_000, 0.05];

/** Throws for eastings and northings, or a mesh far from the origin: no sensor at the origin has measured such a cloud. */
function checkSensor(sorted: Float64Array): void {
  const at = (share: number) => quantile(sorted, share);
  if (at(0.5) > FAR_OFF && at(0.99) - at(0.01) < NARROWLY * at(0.5))
    throw badFile(
      `its points lie ${at(0.5).toPrecision(3)} from the origin and close together, as in the coordinates of a map rather than of a sensor; move them into the frame of the sensor that the extrinsics are for`,
    );
}

interface Unit {
  metres: number;
  warnings: ReaderWarning[];
}

function unitOf(sorted: Float64Array, isMetric: boolean, given: number | undefined): Unit {
  if (given !== undefined) return { metres: given, warnings: [] };
  const metres = quantile(sorted, 0.5) > FARTHEST ? 0.001 : 1;
  if (isMetric && metres === 1) return { metres, warnings: [] };
  const words = `The file does not give its unit. Its points were read as ${metres === 1 ? "metres" : "millimetres"}; give the unit if that is wrong.`;
  return { metres, warnings: [warning("unit-guessed", words, { unit: metres })] };
}

interface Size {
  width: number;
  height: number;
}

interface Seen {
  format: string;
  says: string;
  unit: Unit;
  notes: string[];
  warnings: ReaderWarning[];
}

/** The reading of a depth map of points in metres. */
function reading(size: Size, points: Float32Array, { format, says, unit, notes, warnings }: Seen): Depth {
  const depth = { width: size.width, height: size.height, points };
  const { count, nearest, farthest } = extentOf(ranges(points));
  const valid = count / (size.width * size.height);
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

/** A warning where the points were measured at different times. */
function timed({ times }: Scan): ReaderWarning[] {
  if (times === undefined) return [];
  let [least, most] = [Infinity, -Infinity];
  for (const time of times) [least, most] = [Math.min(least, time), Math.max(most, time)];
  if (!(most > least)) return [];
  const words =
    "Its points were measured at different times, and are taken for one moment: where the rig or the scene moves, the cloud is distorted. Take frames in which both stand still, or correct the cloud for the motion first.";
  return [warning("point-times", words, { span: most - least })];
}

/** Unorganised points, sorted into a range image. */
export async function pointsDepth(cloud: Points, { unit: given }: ReadOptions): Promise<Depth> {
  const { scan, format } = cloud;
  const sorted = sampled(ranges(scan.points));
  checkSensor(sorted);
  const unit = unitOf(sorted, cloud.isMetric, given);
  if (unit.metres !== 1) scan.points = scan.points.map((value) => value * unit.metres);
  const { rangeImage } = await import("./lidar/index.js");
  const image = rangeImage(scan);
  if (image === undefined)
    throw badFile("it holds no point that a sensor may have measured: all are at the origin, or none is a number");
  const size = `${image.width}x${image.height}`;
  const count = scan.points.length / 3;
  const words = `Its ${count} points are not in rows and columns (unorganised), as with a LiDAR; they were sorted into a range image of ${size} ${HOW[image.how]}, in the cloud's own axes.`;
  const warnings = [
    ...cloud.warnings,
    warning("points-sorted", words, { points: count, rows: image.height }),
    ...timed(scan),
  ];
  const notes = [...(image.hidden > 0 ? [`${image.hidden} hidden by others left out`] : []), ...cloud.notes];
  const says = `${count} points (${format}), sorted into ${size} ${HOW[image.how]}`;
  return { ...reading(image, image.points, { format: "points", says, unit, notes, warnings }), scan };
}
