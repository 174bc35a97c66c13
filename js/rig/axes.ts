/**
 * Whether the axes of an organised cloud are those of a camera: x grows along its rows, y down its columns, z is depth.
 *
 * The test is the correlation of columns with x / z and of rows with y / z, which is next to 1 for cameras and for LiDARs in optical axes,
 * whatever their lens. Limits: clouds of few points are not tested.
 */
import { badFile } from "../errors.js";

/** Fewest points for a correlation, and most points that are examined. */
const [FEWEST, MOST] = [200, 20_000];
/** Smallest number of rows and of columns for a correlation. */
const FEWEST_LINES = 8;
/** Smaller correlations are not those of a camera. */
const LEAST = 0.6;

interface Size {
  width: number;
  height: number;
}

/** Pearson's correlation of two functions over the same points. */
function correlation(pairs: [number, number][]): number {
  const mean = (which: 0 | 1) => pairs.reduce((sum, pair) => sum + pair[which], 0) / pairs.length;
  const [first, second] = [mean(0), mean(1)];
  let [both, one, other] = [0, 0, 0];
  for (const [a, b] of pairs) {
    both += (a - first) * (b - second);
    one += (a - first) ** 2;
    other += (b - second) ** 2;
  }
  return one > 0 && other > 0 ? both / Math.sqrt(one * other) : 0;
}

/** Angles rather than ratios, which grow without bound where z is next to zero. */
const bounded = (ratio: number): number => Math.atan(ratio);

/** Throws where rows and columns do not follow the axes; z is positive for most points. */
export function checkAxes(points: Float32Array, { width, height }: Size): void {
  if (width < FEWEST_LINES || height < FEWEST_LINES) return;
  const count = width * height;
  const step = Math.max(1, Math.floor(count / MOST));
  const [across, down]: [number, number][][] = [[], []];
  const upwards: [number, number][] = [];
  for (let at = 0; at < count; at += step) {
    const [x, y, z] = [0, 1, 2].map((axis) => points[3 * at + axis] ?? NaN) as [number, number, number];
    if (!(z > 0) || !Number.isFinite(x) || !Number.isFinite(y) || (x === 0 && y === 0)) continue;
    across?.push([at % width, bounded(x / z)]);
    down?.push([Math.floor(at / width), bounded(y / z)]);
    upwards.push([Math.floor(at / width), Math.atan2(z, Math.hypot(x, y))]);
  }
  if (across === undefined || down === undefined || across.length < FEWEST) return;
  const [columns, rows] = [correlation(across), correlation(down)];
  if (columns >= LEAST && rows >= LEAST) return;
  const isLidar = Math.abs(correlation(upwards)) > 0.9;
  throw badFile(
    isLidar
      ? "its axes are those of a LiDAR (x forward, z up), not a camera's: turn the points so that x looks right along the rows, y down the columns and z forward"
      : `its rows and columns do not follow a camera's axes (x right along the rows, y down the columns, z forward; they correlate by ${columns.toFixed(2)} and ${rows.toFixed(2)}): turn the points, or flip the rows`,
  );
}
