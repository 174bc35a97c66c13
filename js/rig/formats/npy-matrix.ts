/** Calibrations in .npy and .npz files: intrinsics of 3x3, motions of 3x4 and 4x4, and arrays by their names, which are too small to be images. */
import { BimodalError } from "../../errors.js";
import { isNpy, readNpy, readSmall } from "../../npy.js";
import { entriesOf, unpacked } from "./zip.js";
import { isLastRow } from "./poses.js";

/** Most bytes of such a file, with any header. */
const MOST_BYTES = 1024;

/** Whether rows are intrinsics of 3x3, or a motion of 3x4 or 4x4. */
function isMatrix(rows: readonly (readonly number[])[]): boolean {
  const [width = 0, height] = [rows[0]?.length, rows.length];
  const [a = 0, b = 0, c = 0] = rows[2] ?? [];
  if (width === 3) return height === 3 && a === 0 && b === 0 && c === 1;
  if (width !== 4 || (height !== 3 && height !== 4)) return false;
  return height === 3 ? Math.abs(Math.hypot(a, b, c) - 1) < 1e-2 : isLastRow([...(rows[3] ?? [])]);
}

/** The rows as text, as numpy.savetxt writes them; undefined where the array is not such a matrix. */
export function matrixText(bytes: Uint8Array): string | undefined {
  if (bytes.length > MOST_BYTES || !isNpy(bytes)) return undefined;
  try {
    const { width, height, channels, data } = readNpy(bytes);
    if (channels !== 1 || height < 3 || height > 4 || width < 3 || width > 4) return undefined;
    const rows = Array.from({ length: height }, (_, at) =>
      Array.from(data.slice(at * width, (at + 1) * width), Number),
    );
    return isMatrix(rows) ? rows.map((row) => row.join(" ")).join("\n") : undefined;
  } catch (error) {
    if (error instanceof BimodalError) return undefined;
    throw error;
  }
}

/** Most numbers of an array of a calibration: matrices of 16 and lenses of 14, and motions of the views that it was made from. */
const MOST_NUMBERS = 400;
/** Shortest side of an image. */
const LEAST_SIDE = 32;
/** Bytes at the start of an archive that has one array at least. */
const IS_ZIP = [0x50, 0x4b, 0x03, 0x04];

/** The arrays of an archive by their names, as JSON, where they are those of a calibration, as OpenCV's users save it; undefined where one is an image. */
export function archiveText(bytes: Uint8Array): string | undefined {
  if (!IS_ZIP.every((byte, at) => bytes[at] === byte)) return undefined;
  const found: Record<string, number[] | number[][]> = {};
  try {
    const entries = entriesOf(bytes).filter(({ name }) => /\.npy$/i.test(name));
    for (const entry of entries) {
      const array = unpacked(bytes, entry);
      if (!isNpy(array)) return undefined;
      const { axes, values } = readSmall(array, MOST_NUMBERS);
      if (axes.length >= 2 && axes.length <= 3 && axes.slice(0, 2).every((side) => side >= LEAST_SIDE))
        return undefined;
      const [height = 1, width = 1] = axes;
      if (values === undefined) continue;
      const rows = Array.from({ length: height }, (_, at) => values.slice(at * width, (at + 1) * width));
      found[entry.name.replace(/\.npy$/i, "")] = axes.length < 2 || height === 1 || width === 1 ? values : rows;
    }
  } catch (error) {
    // What reads it as an image says what is wrong with it.
    if (error instanceof BimodalError || error instanceof RangeError) return undefined;
    throw error;
  }
  const hasMatrix = Object.values(found).some((rows) => Array.isArray(rows[0]) && isMatrix(rows as number[][]));
  return hasMatrix ? JSON.stringify(found) : undefined;
}
