/** Classical shape from shading: the reflectance map of one lamp, and strips from a bright spot of the bust. */

import { BimodalError, characteristicStrips, shadeLamp } from "../../../pkg/index.js";
import { contour } from "../../draw/contours";
import type { Drawing, Mark, PlotPanel, Values } from "../protocol";
import { atPixel, pictureOf, plot } from "./draw";
import { SIDE, grey, intensities, lampOf, shaded, shapeNamed, type Shape } from "./lamp";
import { isOn, numberOf, pixelAt, vectorAt } from "./scenes";

/** The reflectance map shows slopes from -REACH to REACH. */
const REACH = 2.5;
const LEVELS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
/** How far from the pointer a bright spot is looked for, px. */
const NEAR = 12;
const COUNT = 36;
/** Pixels around the spot within which strips are reliable. */
const BESIDE = 10;

/** The normals of all pairs of slopes p, q. */
function normalsOfSlopes(): Float32Array {
  const normals = new Float32Array(3 * SIDE * SIDE);
  for (let index = 0; index < SIDE * SIDE; index++) {
    const [p, q] = [index % SIDE, Math.floor(index / SIDE)].map((at) => REACH * ((2 * at + 1) / SIDE - 1)) as [
      number,
      number,
    ];
    const length = Math.hypot(p, q, 1);
    normals.set([p / length, q / length, -1 / length], 3 * index);
  }
  return normals;
}
const slopes = normalsOfSlopes();

/** Where the slopes of a normal are in the picture of the map. */
const inMap = ([x, y, z]: readonly [number, number, number]): [number, number] => [
  (1 - x / z / REACH) / 2,
  (1 - y / z / REACH) / 2,
];

/** The brightest pixel near a place. */
function brightSpot(intensity: Float32Array, { mask }: Shape, x: number, y: number): number {
  const middle = pixelAt(mask, SIDE, SIDE, x, y);
  const [column, row] = [middle % SIDE, Math.floor(middle / SIDE)];
  let best = middle;
  for (let dy = -NEAR; dy <= NEAR; dy++)
    for (let dx = -NEAR; dx <= NEAR; dx++) {
      const [there, down] = [column + dx, row + dy];
      if (Math.hypot(dx, dy) > NEAR || Math.min(there, down) < 0 || Math.max(there, down) >= SIDE) continue;
      const index = down * SIDE + there;
      if ((intensity[index] ?? NaN) > (intensity[best] ?? NaN)) best = index;
    }
  return best;
}

/** The strips, each as its points; undefined where no surface faces the lamp. */
function stripsFrom(intensity: Float32Array, lamp: number[], spot: number, dent: boolean): number[][][] | undefined {
  try {
    const centre = [spot % SIDE, Math.floor(spot / SIDE)];
    const flat = characteristicStrips({ intensity, width: SIDE, height: SIDE, lamp, centre, dent, count: COUNT });
    const all: number[][][] = [[]];
    for (let at = 0; at < flat.length; at += 3) {
      if (Number.isNaN(flat[at])) all.push([]);
      else all.at(-1)?.push([...flat.subarray(at, at + 3)]);
    }
    return all.slice(0, -1);
  } catch (error) {
    if (error instanceof BimodalError && error.code === "range") return undefined;
    throw error;
  }
}

/** Pixels between a point of a strip and the spot. */
const wayOf = ([x = NaN, y = NaN]: number[], spot: number): number =>
  Math.hypot(x - (spot % SIDE), y - Math.floor(spot / SIDE));

/** The median of the known values. */
function middleOf(values: number[]): number {
  const known = values.filter(Number.isFinite).sort((a, b) => a - b);
  return known[Math.floor(known.length / 2)] ?? NaN;
}

/** Bilinear interpolation, NaN outside the object. */
function sampled(values: Float32Array, [x = NaN, y = NaN]: number[]): number {
  const at = Math.floor(y) * SIDE + Math.floor(x);
  const [u, v] = [x - Math.floor(x), y - Math.floor(y)];
  const [a = NaN, b = NaN, c = NaN, d = NaN] = [0, 1, SIDE, SIDE + 1].map((step) => values[at + step] ?? NaN);
  return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
}

/** The strip whose error farther away is nearest to the one that the figure reports; any strip if none leads so far. */
function typical(strips: number[][][], far: number, errorFar: (strip: number[][]) => number): number[][] {
  const apart = (strip: number[][]) => Math.abs(errorFar(strip) - far);
  const long = strips.filter((strip) => Number.isFinite(apart(strip))).sort((a, b) => apart(a) - apart(b));
  return long[0] ?? strips[0] ?? [];
}

/** Found and true heights along a strip, beginning at the spot. */
function profile(chosen: number[][], heightAt: (point: number[]) => number): PlotPanel["series"] {
  const [start] = chosen;
  if (!start) return [];
  let way = 0;
  const along = chosen.map((point, i) => {
    const before = chosen[i - 1] ?? point;
    way += Math.hypot((point[0] ?? 0) - (before[0] ?? 0), (point[1] ?? 0) - (before[1] ?? 0));
    return way;
  });
  return [
    { name: "true", ink: "truth", points: chosen.flatMap((point, i) => [along[i] ?? NaN, heightAt(point)]) },
    { name: "strip", ink: "normal", points: chosen.flatMap((point, i) => [along[i] ?? NaN, -(point[2] ?? NaN)]) },
  ];
}

function reflectanceMap(lamp: number[], brightness: number, truth: readonly [number, number, number]) {
  const values = shadeLamp(lamp, slopes);
  const line = (level: number) => contour(values, SIDE, SIDE, level);
  const marks: Mark[] = [
    { ink: "isophote", shape: "line", points: LEVELS.flatMap(line), isFine: true },
    { ink: "intensity", shape: "line", points: line(brightness) },
    { ink: "normal", shape: "cross", points: inMap(truth), size: 3 },
  ];
  return pictureOf(
    {
      key: "map",
      title: "Reflectance map R(p, q)",
      alt: "Intensity for every pair of slopes. One line has the intensity of the chosen pixel; a cross marks its true slopes.",
      legend: "across: p; down: q; line: the pixel's intensity; cross: the truth",
    },
    { width: SIDE, height: SIDE },
    grey(values),
    marks,
    1,
  );
}

export function* strips(values: Values): Generator<Drawing> {
  const shape = shapeNamed("bust");
  const lamp = lampOf(values);
  const intensity = intensities(lamp, shape);
  const pixel = pixelAt(shape.mask, SIDE, SIDE, numberOf(values, "px"), numberOf(values, "py"));
  const spot = brightSpot(intensity, shape, numberOf(values, "sx"), numberOf(values, "sy"));
  const found = stripsFrom(intensity, [...lamp], spot, isOn(values, "dent"));
  const all = found ?? [];
  const origin = shape.depth[spot] ?? NaN;
  const heightAt = (point: number[]) => origin - sampled(shape.depth, point);
  const points = all.flat();
  const errorOf = (point: number[]) => Math.abs(-(point[2] ?? NaN) - heightAt(point));
  const lineOf = (strip: number[][]) => [
    ...strip.flatMap(([x = NaN, y = NaN]) => [(x + 0.5) / SIDE, (y + 0.5) / SIDE]),
    NaN,
    NaN,
  ];
  const errorFar = (each: number[][]) => middleOf(each.filter((point) => wayOf(point, spot) > BESIDE).map(errorOf));
  const far = errorFar(points);
  const plotted = typical(all, far, errorFar);
  const brightness = intensity[pixel] ?? NaN;
  const truth = vectorAt(shape.normals, pixel);
  yield {
    panels: [
      shaded(
        {
          key: "picture",
          title: "The bust under one lamp",
          alt: "A bust under one lamp, with strips that run outward from a bright spot.",
          legend: found
            ? "drag to choose the pixel; thick line: the plotted strip"
            : "no surface near this spot faces the lamp",
          ...(found ? {} : { state: "none" }),
        },
        shape,
        intensity,
        [
          { ink: "normal", shape: "line", points: all.flatMap(lineOf), isFine: true },
          { ink: "normal", shape: "line", points: lineOf(plotted) },
          { ink: "normal", shape: "dot", points: atPixel(spot, shape), size: 1.6 },
          { ink: "pixel", shape: "ring", points: atPixel(pixel, shape), size: 3 },
        ],
      ),
      reflectanceMap([...lamp], brightness, truth),
      {
        kind: "cloud",
        key: "cloud",
        title: "The strips in space",
        alt: "The strips as points in space beside the points of the true surface.",
        sets: [
          { name: "true surface", ink: "truth", points: surfacePoints(shape, origin) },
          { name: "strips", ink: "normal", points: Float32Array.from(points.flat()) },
        ],
      },
      plot(
        { key: "along", title: "Along the thick strip", alt: "Heights along the thick strip: true and found." },
        "way, px",
        "height, px",
        profile(plotted, heightAt),
      ),
    ],
    numbers: {
      intensity: brightness,
      strips: all.length,
      // How far the intensity of the pixel's true slopes is off, and the pieces of its isophote in the map.
      off: Math.abs((shadeLamp(lamp, Float32Array.from(truth))[0] ?? NaN) - brightness),
      curve: contour(shadeLamp(lamp, slopes), SIDE, SIDE, brightness).length / 6,
      near: middleOf(all.flatMap((strip) => strip.filter((point) => wayOf(point, spot) <= BESIDE).map(errorOf))),
      far,
      plotted: errorFar(plotted),
    },
  };
}

/** Every fourth pixel of the true surface, with the spot at depth zero. */
function surfacePoints({ depth }: Shape, origin: number): Float32Array {
  const points: number[] = [];
  for (let row = 0; row < SIDE; row += 4)
    for (let column = 0; column < SIDE; column += 4) {
      const z = depth[row * SIDE + column] ?? NaN;
      if (Number.isFinite(z)) points.push(column, row, z - origin);
    }
  return Float32Array.from(points);
}
