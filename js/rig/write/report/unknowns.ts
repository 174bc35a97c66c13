/**
 * The six unknowns of the extrinsics with their sigmas. The check's covariance is that of a rotation vector about the scene's centre and of
 * the centre's shift; a file states angles and the translation at the camera, so the covariance is converted.
 */
import type { CheckReport } from "../../../types/index.js";

const [DEGREES, MILLIMETRES] = [180 / Math.PI, 1000];

type Known = Pick<CheckReport, "estimate" | "covariance" | "middle">;

/** Rows of the derivatives of alpha, beta, gamma (R = Rx Ry Rz) and of t with respect to the check's unknowns. */
function derivatives({ estimate: { angles, translation }, middle }: Known): number[][] {
  const [a, b] = [angles.alpha / DEGREES, angles.beta / DEGREES];
  const [sa, ca, cb, tb] = [Math.sin(a), Math.cos(a), Math.cos(b), Math.tan(b)];
  // A rotation w about the centre and a shift d move t by w x (t - centre) + d.
  const [x = NaN, y = NaN, z = NaN] = translation.map((value, axis) => value - (middle?.[axis] ?? NaN));
  return [
    [1, sa * tb, -ca * tb, 0, 0, 0],
    [0, ca, sa, 0, 0, 0],
    [0, -sa / cb, ca / cb, 0, 0, 0],
    [0, z, -y, 1, 0, 0],
    [-z, 0, x, 0, 1, 0],
    [y, -x, 0, 0, 0, 1],
  ];
}

/** One sigma of the angles in degrees, then of the translation in millimetres. */
export function sigmasOf(known: Known): number[] {
  const variance = (row: readonly number[]) =>
    row.reduce(
      (sum, one, i) =>
        sum + row.reduce((part, other, j) => part + one * other * (known.covariance[6 * i + j] ?? NaN), 0),
      0,
    );
  return derivatives(known).map((row, k) => Math.sqrt(variance(row)) * (k < 3 ? DEGREES : MILLIMETRES));
}

type Extrinsics = Pick<CheckReport["estimate"], "angles" | "translation">;

/** Angles in degrees, then the translation in millimetres. */
export const valuesOf = ({ angles: { alpha, beta, gamma }, translation }: Extrinsics): number[] => [
  ...[alpha, beta, gamma],
  ...translation.slice(0, 3).map((metres) => MILLIMETRES * metres),
];
