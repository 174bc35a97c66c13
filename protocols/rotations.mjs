// Rotations as nine numbers, row-major, and the measures of the tables. Degrees throughout.

const DEGREE = Math.PI / 180;
export const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export const transpose = ([a, b, c, d, e, f, g, h, i]) => [a, d, g, b, e, h, c, f, i];

export const product = (a, b) =>
  IDENTITY.map((_, at) => [0, 1, 2].reduce((sum, k) => sum + a[3 * Math.floor(at / 3) + k] * b[3 * k + (at % 3)], 0));

export const turn = (rotation, [x, y, z]) =>
  [0, 3, 6].map((row) => rotation[row] * x + rotation[row + 1] * y + rotation[row + 2] * z);

/** The rotation by an angle about a unit axis (Rodrigues). */
export function aboutAxis([x, y, z], degrees) {
  const [s, c] = [Math.sin(degrees * DEGREE), Math.cos(degrees * DEGREE)];
  const d = 1 - c;
  return [
    ...[c + x * x * d, x * y * d - z * s, x * z * d + y * s],
    ...[y * x * d + z * s, c + y * y * d, y * z * d - x * s],
    ...[z * x * d - y * s, z * y * d + x * s, c + z * z * d],
  ];
}

export const aboutY = (degrees) => aboutAxis([0, 1, 0], degrees);

/** Angles of R = Rx(alpha) Ry(beta) Rz(gamma); not valid at beta = 90. */
export const anglesOf = (r) => ({
  alpha: Math.atan2(-r[5], r[8]) / DEGREE,
  beta: Math.asin(Math.min(1, Math.max(-1, r[2]))) / DEGREE,
  gamma: Math.atan2(-r[1], r[0]) / DEGREE,
});

/** Rotation vector (axis times angle) from `truth` to `found`, in the colour view's frame. */
export function offBy(found, truth) {
  const r = product(found, transpose(truth));
  const axis = [r[7] - r[5], r[2] - r[6], r[3] - r[1]];
  const sine = Math.hypot(...axis) / 2;
  const angle = Math.atan2(sine, (r[0] + r[4] + r[8] - 1) / 2) / DEGREE;
  // Near half a turn the differences no longer determine the axis, but no table has such an error.
  return axis.map((part) => (sine > 0 ? (part / (2 * sine)) * angle : 0));
}

/** The angle between two rotations. */
export function degreesBetween(found, truth) {
  const r = product(found, transpose(truth));
  const sine = Math.hypot(r[7] - r[5], r[2] - r[6], r[3] - r[1]) / 2;
  return Math.atan2(sine, (r[0] + r[4] + r[8] - 1) / 2) / DEGREE;
}

/** The paper's error: the spectral norm of the difference of two rotations this many degrees apart. */
export const paperError = (degrees) => 2 * Math.sin((degrees * DEGREE) / 2);
/** The inverse. */
export const paperDegrees = (error) => (2 * Math.asin(Math.min(1, error / 2))) / DEGREE;

/** Degrees between two directions. */
export function angleBetween(a, b) {
  const cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  return Math.atan2(Math.hypot(...cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / DEGREE;
}
