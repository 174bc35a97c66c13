/** Whether an image without a mask shows more than an object in front of black. */
import type { ColorImage } from "../types/index.js";

/** The background counts as visible if more than this share of the pixels along the frame's sides is not black. */
const VISIBLE = 0.25;
/** Darkest usable levels of a run (src/view/colour.rs), as shares of the largest; linear floats have none. */
const BLACK = { 8: 4 / 255, 16: 64 / 65_535 } as const;

/** Whether the sides of the frame are not black, so that without a mask the background would count as the object. */
export function showsBackground({ width, height, data, mask }: ColorImage): boolean {
  if (mask !== undefined) return false;
  const [channels, most, black] =
    data instanceof Float32Array
      ? [3, 1, 0]
      : data instanceof Uint16Array
        ? [4, 0xffff, BLACK[16]]
        : [4, 0xff, BLACK[8]];
  let [seen, all] = [0, 0];
  const look = (column: number, row: number) => {
    const at = channels * (row * width + column);
    const isOpaque = channels === 3 || (data[at + 3] ?? 0) > 0;
    all++;
    if (isOpaque && [0, 1, 2].every((c) => (data[at + c] ?? 0) / most > black)) seen++;
  };
  for (let column = 0; column < width; column++) for (const row of [0, height - 1]) look(column, row);
  for (let row = 0; row < height; row++) for (const column of [0, width - 1]) look(column, row);
  return seen > VISIBLE * all;
}
