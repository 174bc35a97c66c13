/**
 * Scans without a header, as KITTI (x y z reflectance) and nuScenes (x y z intensity ring) have them: floats, point after point.
 *
 * How many floats a point has is not in the file. Of the lengths that divide the file the one whose points are places, each near the one
 * before it, is taken; at another length coordinates change places from point to point.
 */
import { channelOf, FEWEST_POINTS } from "./channels.js";
import { MOST_POINTS } from "./grid.js";
import type { Points } from "./picture.js";

/** Floats of a point, and what the fourth and further ones are. */
const LAYOUTS: [floats: number, others: string[], of: string][] = [
  [4, ["reflectance"], "KITTI"],
  [5, ["intensity", "ring"], "nuScenes"],
  [3, [], "x y z"],
  [6, [], "x y z and three more"],
];
/** Metres beyond which no LiDAR sees. */
const FARTHEST = 500;
/** Nearer to zero a float is no coordinate, but bits of something else. */
const LEAST = 1e-6;
/** Share of points that have to be places. */
const NEARLY_ALL = 0.99;
/** .. and that lie to the right, behind or below, so that a coordinate is negative: depths never are. */
const LEAST_NEGATIVE = 0.1;
/** Points that are looked at. */
const LOOKED_AT = 20_000;

/** Usual distance from point to point over the usual range; nothing where the numbers are no places. */
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
  const usual = (all: number[]) => all.sort((a, b) => a - b)[all.length >> 1] ?? 0;
  const range = usual(ranges);
  return range > 0.1 ? usual(steps) / range : undefined;
}

/** Whole numbers of few different values: the lasers of a scanner. */
function isRing(values: Float32Array): boolean {
  return values.every((value) => Number.isInteger(value) && value >= 0 && value < 512) && new Set(values).size > 1;
}

/** The scan in a file of nothing but floats; nothing where its numbers are no points. */
export function readBin(bytes: Uint8Array): Points | undefined {
  if (bytes.length % 4 !== 0 || bytes.length > 24 * MOST_POINTS) return undefined;
  const values = new Float32Array(bytes.slice().buffer);
  const fitting = LAYOUTS.flatMap(([floats, others, of]) => {
    const isWhole = values.length % floats === 0 && values.length / floats >= FEWEST_POINTS;
    const rough = isWhole ? unevenness(values, floats) : undefined;
    return rough === undefined ? [] : [{ floats, others, of, rough }];
  });
  const best = fitting.sort((a, b) => a.rough - b.rough)[0];
  if (best === undefined) return undefined;
  const { floats, others, of } = best;
  const column = (index: number) =>
    Float32Array.from({ length: values.length / floats }, (_, point) => values[floats * point + index] ?? NaN);
  const points = new Float32Array((3 * values.length) / floats);
  for (let point = 0; point < points.length / 3; point++)
    points.set(values.subarray(floats * point, floats * point + 3), 3 * point);
  const at = (channel: string) => others.findIndex((other) => channelOf(other) === channel);
  const ring = at("ring") < 0 ? undefined : column(3 + at("ring"));
  const scan = {
    points,
    ...(at("intensity") >= 0 && { intensity: column(3 + at("intensity")) }),
    ...(ring && isRing(ring) && { ring }),
  };
  const notes = [`${floats} floats to a point (guessed: ${of})`];
  return { format: "points without a header", scan, isMetric: true, notes, warnings: [] };
}
