/** Members that look like poses. */
import { isNoMotion, isTranslation, rotationName, wordsOf } from "./names.js";
import { isNode, matrixOf } from "./numbers.js";
import { isRotation, parted } from "./poses.js";

/** Names of transforms. A matrix under another name counts only if its numbers are a motion. */
export const TRANSFORM = /^T_|(?:_to_|_from_|2)[a-z]|transform|extrinsic|pose/i;
/** Names of lists of poses, such as those of a calibration board. */
const SERIES =
  /^(?:rvecs|tvecs|rotations|translations|poses|extrinsics|transforms|rotation vectors|translation vectors)$/;

/** Whether a member that was not read looks like a pose. */
export function isPoseLike(key: string, value: unknown, rectifies: boolean): boolean {
  const words = wordsOf(key).join(" ");
  const isMatrix = (each: unknown) => [12, 16].includes(matrixOf(each)?.values.length ?? 0);
  if (SERIES.test(words))
    return Array.isArray(value) && value.length > 0 && !value.every(isMatrix) && !value.some(isNode);
  if (/rect|essential|fundamental|homography/.test(words) || isNoMotion(key) !== undefined) return false;
  const values = matrixOf(value)?.values;
  if (values === undefined) return false;
  if (values.length === 16 || values.length === 12) return isRotation(parted(values)[0]);
  if ((values.length === 6 || values.length === 7) && TRANSFORM.test(key)) return true;
  // An identity in a camera belongs to the rectification, whatever its name.
  const isIdentity = values.length === 9 && values.every((each, index) => each === (index % 4 === 0 ? 1 : 0));
  if (rectifies && isIdentity) return false;
  if (rotationName(key) !== undefined && !/^[qr]\d*$/i.test(key))
    return values.length === 9 ? isRotation(values) : values.length === 4 || values.length === 3;
  if (rotationName(key) !== undefined) return !rectifies && values.length === 9 && isRotation(values);
  return values.length === 3 && isTranslation(key) && !/^[pt]\d*$/i.test(key);
}
