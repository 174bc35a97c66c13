/** A range image: the point of the scan that each of its cells holds, and the geometry of its rows and columns. */
import type { Frame } from "./frame.js";
import type { Row } from "./rows.js";

export interface Image {
  /** The method by which the rows were found. */
  how: "ring" | "order" | "elevation" | "sphere";
  width: number;
  height: number;
  /** Index of the point in each cell; -1 for an empty cell. */
  cells: Int32Array;
  frame: Frame;
  /** The cone of each row. */
  rows: Row[];
  /** Azimuth where the first column begins, radians. */
  first: number;
  /** Width of a column, radians. */
  step: number;
  /** Number of points that were left out because others hide them. */
  hidden: number;
}

/** Rows and columns of the smallest image that the package takes. */
export const LEAST_SIDE = 4;

/** A first and a last line, widened to the smallest side if the image has that many lines. */
function widened(first: number, last: number, count: number): [number, number] {
  const missing = Math.max(0, LEAST_SIDE - (last - first + 1));
  const end = Math.min(count - 1, last + Math.ceil(missing / 2));
  const start = Math.max(0, Math.min(first, end - LEAST_SIDE + 1));
  return [start, Math.min(count - 1, Math.max(end, start + LEAST_SIDE - 1))];
}

/** The part of a range image that holds the points of interest, without any others. */
export function cropped(image: Image, isOfInterest: (index: number) => boolean): Image {
  const { width, height, cells } = image;
  let [left, right, top, bottom] = [width, -1, height, -1];
  cells.forEach((index, cell) => {
    if (index < 0 || !isOfInterest(index)) return;
    const [column, row] = [cell % width, Math.floor(cell / width)];
    [left, right] = [Math.min(left, column), Math.max(right, column)];
    [top, bottom] = [Math.min(top, row), Math.max(bottom, row)];
  });
  if (right < 0) return image;
  [left, right] = widened(left, right, width);
  [top, bottom] = widened(top, bottom, height);
  const size = { width: right - left + 1, height: bottom - top + 1 };
  const part = new Int32Array(size.width * size.height);
  for (let row = 0; row < size.height; row++) {
    const from = (top + row) * width + left;
    const line = cells
      .subarray(from, from + size.width)
      .map((index) => (index >= 0 && isOfInterest(index) ? index : -1));
    part.set(line, row * size.width);
  }
  const { rows, first, step } = image;
  return { ...image, ...size, cells: part, rows: rows.slice(top, bottom + 1), first: first + left * step };
}
