/** Lines of equal value in a raster, for drawing them over its picture. */

/** The sides of a cell of four pixels between which a line runs, in pairs, for each combination of corners above the level. */
const SIDES: readonly (readonly number[])[] = [
  [],
  [3, 0],
  [0, 1],
  [3, 1],
  [1, 2],
  [3, 0, 1, 2],
  [0, 2],
  [3, 2],
  [2, 3],
  [2, 0],
  [0, 1, 2, 3],
  [2, 1],
  [1, 3],
  [1, 0],
  [0, 3],
  [],
];

/**
 * Pieces of the line at which the values cross a level, x and y in turn as shares of the raster's sides, with two NaN between the pieces.
 * Cells with a missing corner have none.
 */
export function contour(values: ArrayLike<number>, width: number, height: number, level: number): number[] {
  const points: number[] = [];
  const corners: [number, number, number, number] = [0, 0, 0, 0];
  for (let row = 0; row + 1 < height; row++)
    for (let column = 0; column + 1 < width; column++) {
      const at = row * width + column;
      // The corners of a cell in order from its first pixel: right, down, left.
      corners[0] = (values[at] ?? NaN) - level;
      corners[1] = (values[at + 1] ?? NaN) - level;
      corners[2] = (values[at + width + 1] ?? NaN) - level;
      corners[3] = (values[at + width] ?? NaN) - level;
      const [a, b, c, d] = corners;
      if (Number.isNaN(a + b + c + d)) continue;
      const form = (a > 0 ? 1 : 0) + (b > 0 ? 2 : 0) + (c > 0 ? 4 : 0) + (d > 0 ? 8 : 0);
      if (form === 0 || form === 15) continue;
      (SIDES[form] ?? []).forEach((side, end) => {
        const [x, y] = crossing(corners, side);
        points.push((column + x + 0.5) / width, (row + y + 0.5) / height);
        if (end % 2 === 1) points.push(NaN, NaN);
      });
    }
  return points;
}

/** The place of the value zero on one side of a cell: above, right, below, left. */
function crossing(corners: readonly number[], side: number): [number, number] {
  const [from, to] = [corners[side] ?? 0, corners[(side + 1) % 4] ?? 0];
  const share = from / (from - to);
  return (
    [
      [share, 0],
      [1, share],
      [1 - share, 1],
      [0, 1 - share],
    ] as const
  )[side] as [number, number];
}
