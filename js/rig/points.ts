/** Unorganised points as depth maps in metres. */
import { badFile } from "../errors.js";
import type { Points } from "./formats/picture.js";
import { sampled } from "./guess.js";
import { type RangeImage, type Scan, rangeImage } from "./lidar/index.js";
import { ranges, reading, unitOf } from "./scan.js";
import { quantile } from "./statistics.js";
import type { DepthReading, ReadOptions, Unnamed } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

const HOW: Record<RangeImage["how"], string> = {
  ring: "by the file's rings",
  order: "by the turns in the order of its points",
  elevation: "by clusters of elevations",
  sphere: "by a z-buffer over the sphere",
};

/**
 * Points count as coordinates of a map if the median of their distances exceeds the first number, in units of the file. The spread of the
 * distances must also be less than the second number times this median.
 */
const [FAR_OFF, NARROWLY] = [10_000, 0.05];

/** Throws for eastings and northings, or a mesh far from the origin, because no sensor at the origin can have measured such a cloud. */
function checkSensor(sorted: Float64Array): void {
  const at = (share: number) => quantile(sorted, share);
  if (at(0.5) > FAR_OFF && at(0.99) - at(0.01) < NARROWLY * at(0.5))
    throw badFile(
      `its points lie ${at(0.5).toPrecision(3)} from the origin and close together, so they seem to be in the coordinates of a map instead of a sensor; move them into the frame of the sensor that the extrinsics are for`,
    );
}

/** A warning if the points were measured at different times. */
function timed({ times }: Scan): ReaderWarning[] {
  if (times === undefined) return [];
  let [least, most] = [Infinity, -Infinity];
  for (const time of times) [least, most] = [Math.min(least, time), Math.max(most, time)];
  if (!(most > least)) return [];
  const words =
    "Its points were measured at different times but are treated as simultaneous: if the rig or the scene moves, the cloud is distorted. Record frames while both stand still, or correct the cloud for the motion first.";
  return [warning("point-times", words, { span: most - least })];
}

/** Unorganised points, sorted into a range image. */
export function pointsDepth(cloud: Points, { unit: given }: ReadOptions): Unnamed<DepthReading> {
  const { scan, format } = cloud;
  const sorted = sampled(ranges(scan.points));
  checkSensor(sorted);
  const unit = unitOf(sorted, cloud.isMetric, given);
  if (unit.metres !== 1) scan.points = scan.points.map((value) => value * unit.metres);
  const image = rangeImage(scan);
  if (image === undefined) throw badFile("it has no measured point: all are at the origin or not numbers");
  const size = `${image.width}x${image.height}`;
  const count = scan.points.length / 3;
  const words = `Its ${count} points are not in rows and columns (unorganised), like those of a LiDAR; they were sorted into a range image of ${size} ${HOW[image.how]}, in the cloud's own axes.`;
  const warnings = [
    ...cloud.warnings,
    warning("points-sorted", words, { points: count, rows: image.height }),
    ...timed(scan),
  ];
  const notes = [...(image.hidden > 0 ? [`${image.hidden} left out because others hide them`] : []), ...cloud.notes];
  const says = `${count} points (${format}), sorted into ${size} ${HOW[image.how]}`;
  return { ...reading(image, image.points, { format: "points", says, unit, notes, warnings }), scan };
}
