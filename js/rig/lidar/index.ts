/**
 * Unorganised clouds as range images: the points of a LiDAR in rows and columns, so that the check of a calibration finds neighbours.
 *
 * Points keep their coordinates in the cloud's own frame, so that extrinsics for that frame hold; only their order changes. Rows come from the
 * scanner's rings (`rows.ts`), or from a z-buffer for clouds without rings (`sphere.ts`); columns come from azimuths.
 *
 * Limits. All points count as measured at one moment and from one place. If the rig or the scene moves during a sweep, or between the sweep
 * and the picture, the range image and the picture disagree. A cloud of many sweeps is treated as if all of it had been seen from its
 * origin.
 */
import { buffered } from "./sphere.js";
import { spun } from "./columns.js";
import { type Vector, AXES, facesOneWay, frameOf, meanDirection, polarOf, unit, upright } from "./frame.js";
import { type Image, cropped } from "./image.js";
import { type Rows, byElevation, byOrder, byRing } from "./rows.js";
import { type Scan, measured, subset } from "./scan.js";
import { type View, forwardOf, seesOf, upOf } from "./view.js";

export type { Scan } from "./scan.js";
export type { View } from "./view.js";

/** A scan in rows and columns. */
export interface RangeImage extends Image {
  /** x, y, z of each cell in the cloud's frame, metres; NaN where the cell is empty. */
  points: Float32Array;
  /** The intensity of each cell if the scan has intensities, NaN if the cell is empty. */
  intensity?: Float32Array;
}

function rowsOf(scan: Scan, forward: Vector): Rows | undefined {
  const own = scan.ring && byRing(scan.points, scan.ring, forward);
  if (own) return own;
  const polars = AXES.map((axis) => polarOf(scan.points, frameOf(axis, forward)));
  for (const find of [byOrder, byElevation]) {
    for (const polar of polars) {
      const found = find(polar);
      if (found) return found;
    }
  }
  return undefined;
}

/** The range image of a scan, or of the part that a camera may see. Undefined for a scan without measurements. */
export function rangeImage(all: Scan, view?: View): RangeImage | undefined {
  const kept = measured(all);
  if (kept.length === 0) return undefined;
  const scan = subset(all, kept);
  const mean = meanDirection(scan.points);
  const forward: Vector = view ? forwardOf(view) : facesOneWay(mean) ? unit(mean) : [1, 0, 0];
  const rows = rowsOf(scan, forward);
  const sees = view && seesOf(view);
  const isSeen = (index: number) =>
    sees === undefined ||
    sees([scan.points[3 * index] ?? 0, scan.points[3 * index + 1] ?? 0, scan.points[3 * index + 2] ?? 0]);
  if (rows) return filled(sees ? cropped(spun(rows), isSeen) : spun(rows), scan);
  const indices = Uint32Array.from({ length: kept.length }, (_, index) => index);
  const seen = sees ? indices.filter(isSeen) : indices;
  const up = view ? upOf(view) : upright(forward);
  return filled(buffered(polarOf(scan.points, frameOf(up, forward)), seen.length > 0 ? seen : indices), scan);
}

function filled(image: Image, { points, intensity }: Scan): RangeImage {
  const cloud = new Float32Array(3 * image.cells.length).fill(NaN);
  const strength = intensity && new Float32Array(image.cells.length).fill(NaN);
  image.cells.forEach((index, cell) => {
    if (index < 0) return;
    for (let axis = 0; axis < 3; axis++) cloud[3 * cell + axis] = points[3 * index + axis] ?? NaN;
    if (strength) strength[cell] = intensity?.[index] ?? NaN;
  });
  return { ...image, points: cloud, ...(strength && { intensity: strength }) };
}
