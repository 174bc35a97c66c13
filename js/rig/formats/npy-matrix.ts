/** Matrices that numpy.save wrote: intrinsics of 3x3, motions of 3x4 and 4x4. */
import { BimodalError } from "../../errors.js";
import { isNpy, readNpy } from "../../npy.js";
import { isLastRow } from "./poses.js";

/** Bytes of a file that holds the largest of them, at most. */
const MOST_BYTES = 1024;

/** The rows as numpy.savetxt writes them; undefined where the array is not such a matrix. */
export function matrixText(bytes: Uint8Array): string | undefined {
  if (bytes.length > MOST_BYTES || !isNpy(bytes)) return undefined;
  try {
    const { width, height, channels, data } = readNpy(bytes);
    if (channels !== 1 || height < 3 || height > 4 || width < 3 || width > 4) return undefined;
    const rows = Array.from({ length: height }, (_, at) =>
      Array.from(data.slice(at * width, (at + 1) * width), Number),
    );
    const [a = 0, b = 0, c = 0] = rows[2] ?? [];
    const isIntrinsics = width === 3 && height === 3 && a === 0 && b === 0 && c === 1;
    const isMotion =
      width === 4 && (height === 3 ? Math.abs(Math.hypot(a, b, c) - 1) < 1e-2 : isLastRow(rows[3] ?? []));
    return isIntrinsics || isMotion ? rows.map((row) => row.join(" ")).join("\n") : undefined;
  } catch (error) {
    if (error instanceof BimodalError) return undefined;
    throw error;
  }
}
