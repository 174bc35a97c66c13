/** Calibrations in .npy and .npz files: intrinsics of 3x3 and motions of 3x4 and 4x4, which are too small to be images. */
import { BimodalError } from "../../errors.js";
import { isNpy, readSmall } from "../../npy.js";
import { entriesOf, unpacked } from "./zip.js";
import { isLastRow } from "./poses.js";

/** Largest number of bytes of such a file, with any header. */
const MOST_BYTES = 1024;

/** Whether rows are intrinsics of 3x3, or a motion of 3x4 or 4x4. */
function isMatrix(rows: readonly (readonly number[])[]): boolean {
  const [width = 0, height] = [rows[0]?.length, rows.length];
  const [a = 0, b = 0, c = 0] = rows[2] ?? [];
  if (width === 3) return height === 3 && a === 0 && b === 0 && c === 1;
  if (width !== 4 || (height !== 3 && height !== 4)) return false;
  return height === 3 ? Math.abs(Math.hypot(a, b, c) - 1) < 1e-2 : isLastRow([...(rows[3] ?? [])]);
}

/** The numbers in rows of one width. */
const inRows = (values: readonly number[], [height = 1, width = 1]: readonly number[]): number[][] =>
  Array.from({ length: height }, (_, at) => values.slice(at * width, (at + 1) * width));

/** The numbers of a small array with the lengths of its axes; undefined for other files. */
export function smallArray(bytes: Uint8Array): { axes: number[]; values: number[] } | undefined {
  if (bytes.length > MOST_BYTES || !isNpy(bytes)) return undefined;
  try {
    const { axes, values } = readSmall(bytes, MOST_NUMBERS);
    return values && { axes, values };
  } catch (error) {
    if (error instanceof BimodalError) return undefined;
    throw error;
  }
}

/** The rows as text, as numpy.savetxt writes them; undefined where the array is not such a matrix. */
export function matrixText(bytes: Uint8Array): string | undefined {
  const array = smallArray(bytes);
  const rows = array && inRows(array.values, array.axes);
  return rows && isMatrix(rows) ? rows.map((row) => row.join(" ")).join("\n") : undefined;
}

/**
 * Largest number of numbers in an array of a calibration. A matrix has 16 and a lens 14; the motions of the views that were used have more.
 */
const MOST_NUMBERS = 400;
/** Largest number of bytes of such an archive; a picture beside the matrices takes more. */
const MOST_ARCHIVE = 1 << 17;
/** The usual names of a depth map in an archive. */
export const DEPTH = /^(?:depth|depths|depth_?map|depth_?image)$/i;
/** First bytes of a ZIP archive that is not empty. */
const IS_ZIP = [0x50, 0x4b, 0x03, 0x04];

/** An array as JSON has it: a list, or rows; undefined where it is too large for a calibration. */
function listed(bytes: Uint8Array): number[] | number[][] | undefined {
  const { axes, values } = readSmall(bytes, MOST_NUMBERS);
  if (values === undefined) return undefined;
  return axes.length < 2 || axes.includes(1) ? values : inRows(values, axes);
}

/**
 * The arrays of an archive by their names, as JSON, if one of them is a matrix of a calibration, as users of OpenCV save it.
 * Larger arrays, such as the corners of a board, are left out.
 */
export function archiveText(bytes: Uint8Array): string | undefined {
  if (bytes.length > MOST_ARCHIVE || !IS_ZIP.every((byte, at) => bytes[at] === byte)) return undefined;
  try {
    const arrays = entriesOf(bytes).map(
      (entry) => [entry.name.replace(/\.npy$/i, ""), unpacked(bytes, entry)] as const,
    );
    const found = arrays.filter(([, array]) => isNpy(array)).map(([name, array]) => [name, listed(array)] as const);
    if (found.some(([name]) => DEPTH.test(name))) return undefined;
    const isCalibration = found.some(([, rows]) => Array.isArray(rows?.[0]) && isMatrix(rows as number[][]));
    return isCalibration ? JSON.stringify(Object.fromEntries(found)) : undefined;
  } catch (error) {
    // The reader of images reports the fault of a damaged archive.
    if (error instanceof BimodalError || error instanceof RangeError) return undefined;
    throw error;
  }
}
