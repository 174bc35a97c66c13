// Brown's lens with five coefficients, in OpenCV's order, for costs computed outside the package.

/** Rounds of the fixed-point iteration, enough to invert a lens of k1 = 0.2 to a thousandth of a pixel. */
const ROUNDS = 30;

function bent([x, y], [k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0]) {
  const r = x * x + y * y;
  const radial = 1 + r * (k1 + r * (k2 + r * k3));
  return [x * radial + 2 * p1 * x * y + p2 * (r + 2 * x * x), y * radial + p1 * (r + 2 * y * y) + 2 * p2 * x * y];
}

/** Column and row of a point in front of the camera. */
export function project({ fx, fy, cx, cy, distortion = [] }, [x, y, z]) {
  const [u, v] = bent([x / z, y / z], distortion);
  return [fx * u + cx, fy * v + cy];
}

/** x and y of a pixel's ray at z = 1. */
export function ray({ fx, fy, cx, cy, distortion = [] }, [column, row]) {
  const told = [(column - cx) / fx, (row - cy) / fy];
  let at = told;
  if (distortion.every((value) => value === 0)) return at;
  for (let round = 0; round < ROUNDS; round++) {
    const now = bent(at, distortion);
    at = at.map((value, k) => value + told[k] - now[k]);
  }
  return at;
}

/** The organised cloud of a depth map, metres; missing depths are NaN. */
export function cloud({ width, height, data, camera, unit }) {
  const NOTHING = 65535;
  const points = new Float32Array(3 * width * height).fill(NaN);
  for (let index = 0; index < width * height; index++) {
    const z = data[index] * unit;
    if (!(z > 0) || data[index] === NOTHING) continue;
    const [x, y] = ray(camera, [index % width, Math.floor(index / width)]);
    points.set([x * z, y * z, z], 3 * index);
  }
  return points;
}
