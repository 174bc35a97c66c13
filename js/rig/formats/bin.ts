/**
 * Scans without a header, as KITTI (x y z reflectance) and nuScenes (x y z intensity ring) store them: floats, point after point.
 *
 * The file does not give the number of floats per point. The reader tries each number that divides the length of the file, and takes the
 * one at which consecutive points are nearest to each other; at a wrong number, coordinates are mixed up.
 */
import { median } from "../statistics.js";
import { FEWEST_POINTS, channelOf, columnOf, pointsOf } from "./channels.js";
import { MOST_POINTS } from "./grid.js";
import type { Points } from "./picture.js";

/** Floats per point, the meaning of the channels after x, y, z, and a name. */
const LAYOUTS: [floats: number, others: string[], of: string][] = [
  [4, ["reflectance"], "KITTI"],
  [5, ["intensity", "ring"], "nuScenes"],
  [3, [], "x y z"],
  [6, ["intensity", "ring", "time"], "x y z intensity ring time"],
  [7, [], "x y z and four others"],
  [8, [], "x y z and five others"],
];
/** Largest coordinate of a LiDAR's points, metres. */
const FARTHEST = 500;
/** Smaller floats other than zero are bits of another type, not coordinates. */
const LEAST = 1e-6;
/** Share of points whose coordinates have to be plausible. */
const NEARLY_ALL = 0.99;
/** Smallest share of points with a negative coordinate, which distinguishes scans from depth maps. */
const LEAST_NEGATIVE = 0.1;
/** Largest number of points that are examined. */
const LOOKED_AT = 20_000;

/** Median distance from point to point over the median range; undefined where the numbers are not coordinates. */
function unevenness(values: Float32Array, floats: number): number | undefined {
  const count = Math.min(LOOKED_AT, values.length / floats);
  const isPlace = (value = NaN) => value === 0 || (Math.abs(value) > LEAST && Math.abs(value) < FARTHEST);
  let [places, negative] = [0, 0];
  const [steps, ranges]: [number[], number[]] = [[], []];
  for (let point = 0; point < count; point++) {
    const [x = 0, y = 0, z = 0] = values.subarray(floats * point, floats * point + 3);
    if (!isPlace(x) || !isPlace(y) || !isPlace(z)) continue;
    places++;
    if (x < 0 || y < 0 || z < 0) negative++;
    ranges.push(Math.hypot(x, y, z));
    const [a = 0, b = 0, c = 0] = values.subarray(floats * point - floats, floats * point - floats + 3);
    if (point > 0) steps.push(Math.hypot(x - a, y - b, z - c));
  }
  if (places < NEARLY_ALL * count || negative < LEAST_NEGATIVE * count) return undefined;
  const range = median(ranges);
  return range > 0.1 ? median(steps) / range : undefined;
}

/** Whether the values are laser numbers: several different small integers. */
function isRing(values: Float32Array): boolean {
  return values.every((value) => Number.isInteger(value) && value >= 0 && value < 512) && new Set(values).size > 1;
}

/** The scan in a file that consists of floats only; undefined if these are not points. */
export function readBin(bytes: Uint8Array): Points | undefined {
  if (bytes.length % 4 !== 0 || bytes.length > 32 * MOST_POINTS) return undefined;
  const values = new Float32Array(bytes.slice().buffer);
  const fitting = LAYOUTS.flatMap(([floats, others, of]) => {
    const isWhole = values.length % floats === 0 && values.length / floats >= FEWEST_POINTS;
    const rough = isWhole ? unevenness(values, floats) : undefined;
    return rough === undefined ? [] : [{ floats, others, of, rough }];
  });
  const best = fitting.sort((a, b) => a.rough - b.rough)[0];
  if (best === undefined) return undefined;
  const { floats, others, of } = best;
  const channel = (wanted: string) => {
    const at = others.findIndex((other) => channelOf(other) === wanted);
    return at < 0 ? undefined : columnOf(values, floats, 3 + at);
  };
  const [intensity, ring, times] = [channel("intensity"), channel("ring"), channel("times")];
  const scan = {
    points: pointsOf(values, floats),
    ...(intensity && { intensity }),
    ...(ring && isRing(ring) && { ring }),
    // The last number may have any meaning, because only the order of the points is used: a spinning scanner measures them one after the
    // other.
    ...(times && { times: Float64Array.from(times) }),
  };
  const notes = [`${floats} floats to a point (guessed: ${of})`];
  return { format: "points without a header", scan, isMetric: true, notes, warnings: [] };
}
