/** From numbers to the pixels and points of a panel. */

import { paintNormals, paintPicture, paintScalar, type MapName } from "../../draw/colours";
import type { Range } from "../../engine/protocol";
import type { ImagePanel, Mark, PlotPanel } from "../protocol";

type Words = Pick<ImagePanel, "key" | "title" | "alt" | "legend" | "details" | "state">;

interface Grid {
  width: number;
  height: number;
  mask?: Uint8Array;
}

const raster = ({ width, height }: Grid, channels: 1 | 3, data: Float32Array) => ({
  left: 0,
  top: 0,
  stride: 1,
  width,
  height,
  channels,
  data,
});
const panel = (words: Words, { width, height }: Grid, image: ImageData, marks: Mark[]): ImagePanel => ({
  kind: "image",
  ...words,
  width,
  height,
  pixels: image.data,
  marks,
});

/** Linear colours of the pixels in the grid's mask; `white` is the brightest. */
export function pictureOf(
  words: Words,
  grid: Grid,
  colours: Float32Array,
  marks: Mark[] = [],
  white = brightest(colours),
): ImagePanel {
  const { mask } = grid;
  const inside = mask ? colours.map((value, at) => (mask[Math.floor(at / 3)] ? value : NaN)) : colours;
  return panel(words, grid, paintPicture({ ...raster(grid, 3, inside), white, encoded: false }), marks);
}

export function normalsOf(words: Words, grid: Grid, normals: Float32Array, marks: Mark[] = []): ImagePanel {
  return panel(
    { legend: "right red, up green, near blue", ...words },
    grid,
    paintNormals(raster(grid, 3, normals)),
    marks,
  );
}

export function scalarOf(
  words: Words,
  grid: Grid,
  values: Float32Array,
  range: Range,
  map: MapName = "viridis",
  marks: Mark[] = [],
): ImagePanel {
  return panel(words, grid, paintScalar(raster(grid, 1, values), range, map), marks);
}

/** The brightest value without the highest hundredth. */
export function brightest(colours: Float32Array): number {
  const finite = colours.filter(Number.isFinite).sort();
  return Math.max(1e-6, finite[Math.floor(0.99 * (finite.length - 1))] ?? 1);
}

/** Where a unit normal lies in the picture of the hemisphere. */
export const onDisc = (normal: ArrayLike<number>): [number, number] => [
  ((normal[0] ?? 0) + 1) / 2,
  ((normal[1] ?? 0) + 1) / 2,
];

/** The middle of a pixel as shares of the sides. */
export const atPixel = (index: number, { width, height }: Grid): [number, number] => [
  ((index % width) + 0.5) / width,
  (Math.floor(index / width) + 0.5) / height,
];

/** Values along a row of a raster, x in pixels. */
export function alongRow(values: ArrayLike<number>, { width }: Grid, row: number, sign = 1): number[] {
  return Array.from({ length: width }, (_, column) => [column, sign * (values[row * width + column] ?? NaN)]).flat();
}

export const plot = (
  words: Words,
  x: string,
  y: string,
  series: PlotPanel["series"],
  rest: Partial<Pick<PlotPanel, "at" | "domain" | "range" | "hasAngles">> = {},
): PlotPanel => ({ kind: "plot", ...words, x, y, series, ...rest });
