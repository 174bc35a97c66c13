/** The curves of normals that explain one colour each of a pixel, over the picture of the hemisphere. */

import { shadeNormals } from "../../../pkg/index.js";
import { contour } from "../../draw/contours";
import { ballNormals } from "../../engine/ball";
import type { Mark } from "../protocol";

const SIDE = 128;
const COLOURS = ["red", "green", "blue"] as const;
const hemisphere = ballNormals(SIDE);

/** Three lines: the normals whose predicted log intensity in a colour is that of the pixel. */
export function curvesOf(log: readonly number[], light: Float64Array): Mark[] {
  const predicted = shadeNormals(light, hemisphere);
  return COLOURS.map((ink, channel) => {
    const values = Float32Array.from({ length: SIDE * SIDE }, (_, at) => predicted[3 * at + channel] ?? NaN);
    return { ink, shape: "line", points: contour(values, SIDE, SIDE, log[channel] ?? NaN) };
  });
}

type Normal = readonly [number, number, number];

/** The normals at the points of a line in the picture of the hemisphere. */
function normalsOn({ points }: Mark): Normal[] {
  return Array.from({ length: points.length / 2 }, (_, i): Normal => {
    const [x, y] = [2 * (points[2 * i] ?? NaN) - 1, 2 * (points[2 * i + 1] ?? NaN) - 1];
    return [x, y, -Math.sqrt(Math.max(0, 1 - x * x - y * y))];
  }).filter(([x, y]) => Number.isFinite(x + y));
}

const degreesBetween = (a: Normal, b: Normal): number =>
  (180 / Math.PI) * Math.acos(Math.min(1, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
const degreesTo = (normal: Normal, line: Normal[]): number =>
  line.reduce((least, each) => Math.min(least, degreesBetween(normal, each)), Infinity);

/** The distance of a normal from the curve that is farthest from it, degrees. */
export const degreesToCurves = (normal: Normal, curves: readonly Mark[]): number =>
  Math.max(...curves.map((curve) => degreesTo(normal, normalsOn(curve))));

/** The mean distance of a curve from the next one, for the two curves that are farthest apart, degrees. */
export function degreesApart(curves: readonly Mark[]): number {
  const all = curves.map(normalsOn);
  const mean = (from: Normal[], to: Normal[]) =>
    from.reduce((sum, normal) => sum + degreesTo(normal, to), 0) / from.length;
  return Math.max(...all.map((from, at) => mean(from, all[(at + 1) % all.length] ?? [])));
}
