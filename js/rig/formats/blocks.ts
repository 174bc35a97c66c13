/** Matrices of 3x4 and 4x4 as files write motions: some are transposed, and some are projections. */
import { type ReaderWarning, warning } from "../warnings.js";
import { type Numbers, transposed } from "./numbers.js";
import { isLastRow, isRotation, parted } from "./poses.js";

const near = (value: number | undefined, to: number): boolean => value !== undefined && Math.abs(value - to) < 1e-9;

/** Rows of a rotation have the length 1, and rows of a projection K [R | t] that of a focal length in pixels. */
const PIXELS = 10;

/** Whether numbers are a projection of points into pixels rather than a motion. */
export function isProjection(values: Numbers): boolean {
  const [block] = parted(values);
  const lengths = [0, 3].map((at) => Math.hypot(...block.slice(at, at + 3)));
  if (intrinsicsOf4x4(values) !== undefined) return false;
  return (values.length === 12 || values.length === 16) && lengths.every((length) => length > PIXELS);
}

/** The matrix of intrinsics in the upper left of a 4x4 matrix, as in ScanNet. */
export function intrinsicsOf4x4(values: Numbers): Numbers | undefined {
  if (values.length !== 16) return undefined;
  const zeros = [3, 4, 7, 8, 9, 11, 12, 13, 14].every((index) => near(values[index], 0));
  const isK = zeros && near(values[10], 1) && near(values[15], 1) && (values[0] ?? 0) > 2 && (values[5] ?? 0) > 2;
  return isK ? parted(values)[0] : undefined;
}

export const PROJECTION =
  "is a projection K [R | t] into pixels, not a motion; give K as a camera, and [R | t] as a pose";

/**
 * A 4x4 matrix that applies to column vectors. A matrix with its translation in the last row is transposed, because it applies to row
 * vectors (MATLAB's rigid3d) or lists columns (ARKit).
 */
export function forColumns(values: Numbers, name: string, warnings: ReaderWarning[]): Numbers {
  const last = [3, 7, 11, 15].map((at) => values[at] ?? NaN);
  if (values.length !== 16 || isLastRow(values.slice(12)) || !isLastRow(last)) return values;
  const turned = transposed(values, 4);
  if (!isRotation(parted(turned)[0])) return values;
  warnings.push(
    warning(
      "rotation-order",
      `The matrix${name === "" ? "" : ` "${name}"`} has its translation in the last row, as for row vectors (MATLAB) or as a list of columns (ARKit), and was transposed.`,
      { order: "columns" },
    ),
  );
  return turned;
}
