/**
 * Points in no rows and columns, and clouds whose z is not forward, as depth maps in metres: LiDARs, and clouds of mapping tools.
 *
 * Points keep their frame: extrinsics have to be those of that very frame, x forward and z up for most LiDARs.
 */
import { badFile } from "../errors.js";
import { meanDirection } from "./lidar/frame.js";
import type { RangeImage, Scan, View } from "./lidar/index.js";
import { rangeOf } from "./lidar/scan.js";
import type { Cloud, Points } from "./formats/picture.js";
import type { ReadOptions, RigReading } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Depth = Extract<RigReading, { kind: "depth" }>;
type Found<T> = Omit<T, "name">;

/** Half of the points lying farther away than this, metres, the unit is the millimetre: no LiDAR sees so far. */
const FARTHEST = 200;
/** Directions whose mean is shorter look all around. */
const ALL_AROUND = 0.5;
const HOW: Record<RangeImage["how"], string> = {
  ring: "by the file's rings",
  order: "by the turns in the order of its points",
  elevation: "by clusters of elevations",
  sphere: "by a z-buffer over the sphere",
};

const isThere = (range: number): boolean => range > 0 && range < 1e12;

/** Distances of the points that are there, in order. */
function ranges(points: Float32Array): Float64Array {
  const found = new Float64Array(points.length / 3);
  let count = 0;
  for (let at = 0; at < points.length; at += 3) {
    const range = rangeOf(points, at);
    if (isThere(range)) found[count++] = range;
  }
  return found.slice(0, count).sort();
}

/** Whether z looks forward, as a depth camera's does: what is not seen all around, and mostly along z, or against it. */
export function isOptical(points: Float32Array): boolean {
  const [x, y, z] = meanDirection(points);
  const length = Math.hypot(x, y, z);
  if (length === 0) return true;
  return length > ALL_AROUND && Math.abs(z) > Math.max(Math.abs(x), Math.abs(y));
}

/** Units of the file from the origin, and the spread of distances as a share of them, from which on points are those of a map. */
const [FAR_OFF, NARROWLY] = [10_000, 0.05];

/** Eastings and northings, or a mesh far off: a cloud that no sensor at its origin has measured. */
function checkSensor(sorted: Float64Array): void {
  const at = (share: number) => sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
  if (at(0.5) > FAR_OFF && at(0.99) - at(0.01) < NARROWLY * at(0.5))
    throw badFile(
      `its points lie ${at(0.5).toPrecision(3)} from the origin and close together, as in the coordinates of a map, in which no sensor is; move them into the frame of the sensor that extrinsics are given for`,
    );
}

interface Unit {
  metres: number;
  warnings: ReaderWarning[];
}

function unitOf(sorted: Float64Array, isMetric: boolean, told: number | undefined): Unit {
  if (told !== undefined) return { metres: told, warnings: [] };
  const metres = (sorted[sorted.length >> 1] ?? 0) > FARTHEST ? 0.001 : 1;
  if (isMetric && metres === 1) return { metres, warnings: [] };
  const words = `The file does not give its unit. Its points were read as ${metres === 1 ? "metres" : "millimetres"}; give the unit if that is wrong.`;
  return { metres, warnings: [warning("unit-guessed", words, { unit: metres })] };
}

interface Seen {
  format: string;
  says: string;
  unit: Unit;
  sorted: Float64Array;
  notes: string[];
  warnings: ReaderWarning[];
}

/** The reading of points in metres. */
function reading(depth: Depth["depth"], { format, says, unit, sorted, notes, warnings }: Seen): Found<Depth> {
  const valid = sorted.length / (depth.width * depth.height);
  const range: [number, number] = [(sorted[0] ?? 0) * unit.metres, (sorted.at(-1) ?? 0) * unit.metres];
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
export function turnedCloud(cloud: Cloud, told: number | undefined): Found<Depth> {
  const { points, width, height, notes } = cloud;
  const sorted = ranges(points);
  const unit = unitOf(sorted, false, told);
  for (let at = 0; at < points.length; at += 3) {
    const there = isThere(rangeOf(points, at));
    for (let axis = 0; axis < 3; axis++) points[at + axis] = there ? (points[at + axis] ?? NaN) * unit.metres : NaN;
  }
  const warnings = [...cloud.warnings, warning("lidar-axes", AXES)];
  const says = `${width}x${height}, an organised cloud with the axes of a LiDAR`;
  return reading({ width, height, points }, { format: "an organised cloud", says, unit, sorted, notes, warnings });
}
const AXES =
  "The cloud's axes are not those of a camera: z is not forward, as with a LiDAR (x forward, z up). Its points were kept as they are, so that extrinsics have to be those of this frame.";

/** Time stamps that differ: all points count as measured at one moment. */
function timed({ times }: Scan): ReaderWarning[] {
  if (times === undefined) return [];
  const [least, most] = times.reduce(
    ([low, high], time) => [Math.min(low, time), Math.max(high, time)],
    [Infinity, -Infinity],
  );
  if (!(most > least)) return [];
  const words =
    "Each of its points has a time of its own, and all are taken for one moment: what moved meanwhile, the rig included, is bent. Take frames that stand still, or undo the motion first.";
  return [warning("point-times", words, { span: most - least })];
}

/** The range image of a scan in metres as a depth map; of what a camera may see, where one is given. */
export async function scanDepth(scan: Scan, view?: View): Promise<{ depth: Depth["depth"]; image: RangeImage }> {
  const { rangeImage } = await import("./lidar/index.js");
  const image = rangeImage(scan, view);
  if (image === undefined)
    throw badFile("it holds no point that a sensor may have measured: all are at the origin, or none is a number");
  const { width, height, points } = image;
  return { depth: { width, height, points }, image };
}

/** Points in no rows and columns, sorted into a range image. */
export async function pointsDepth(cloud: Points, { unit: told }: ReadOptions): Promise<Found<Depth>> {
  const { scan, format } = cloud;
  const sorted = ranges(scan.points);
  checkSensor(sorted);
  const unit = unitOf(sorted, cloud.isMetric, told);
  if (unit.metres !== 1) scan.points = scan.points.map((value) => value * unit.metres);
  const { depth, image } = await scanDepth(scan);
  const size = `${image.width}x${image.height}`;
  const count = scan.points.length / 3;
  const words = `Its ${count} points are in no rows and columns (unorganised), as those of a LiDAR are; they were sorted into a range image of ${size} ${HOW[image.how]}, in the cloud's own axes.`;
  const warnings = [
    ...cloud.warnings,
    warning("points-sorted", words, { points: count, rows: image.height }),
    ...timed(scan),
  ];
  const notes = [...(image.hidden > 0 ? [`${image.hidden} hidden by others left out`] : []), ...cloud.notes];
  const says = `${count} points (${format}), sorted into ${size} ${HOW[image.how]}`;
  const kept = ranges(depth.points ?? new Float32Array());
  return {
    ...reading(depth, { format: "points", says, unit: { ...unit, metres: 1 }, sorted: kept, notes, warnings }),
    scan,
  };
}
