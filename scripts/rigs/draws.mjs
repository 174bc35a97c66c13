// Tools for a draw of a check: random candidates, the error of an estimate, and formatted shares.
import { aboutAxis, offBy, product, transpose, turn } from "../../protocols/rotations.mjs";

/** Random numbers from a seed (Steele and Vigna's splitmix32); directions from normal variates by Box and Muller. */
export function chance(seed) {
  let state = seed >>> 0;
  const uniform = () => {
    state = (state + 0x9e3779b9) >>> 0;
    let z = state;
    z = Math.imul(z ^ (z >>> 16), 0x21f0aaad);
    z = Math.imul(z ^ (z >>> 15), 0x735a2d97);
    return ((z ^ (z >>> 15)) >>> 0) / 2 ** 32;
  };
  const normal = () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());
  const direction = () => {
    const vector = [normal(), normal(), normal()];
    return vector.map((value) => value / Math.hypot(...vector));
  };
  return { uniform, direction };
}

export const poseOf = (rotation, translation) => ({ scale: 1, rotation, translation });
export const moved = ({ rotation, translation }, point) =>
  turn(rotation, point).map((value, k) => value + translation[k]);

/** The motion that applies `inner` first, then `outer`. */
export const after = (outer, inner) => poseOf(product(outer.rotation, inner.rotation), moved(outer, inner.translation));

export function inverse({ rotation, translation }) {
  const back = transpose(rotation);
  return poseOf(
    back,
    turn(back, translation).map((value) => -value),
  );
}

/** A pose with an error: degrees about a random axis through a point of the colour frame, and millimetres in a random direction. */
export function wrong(pose, { degrees, millimetres }, direction, centre = [0, 0, 0]) {
  const rotation = aboutAxis(direction(), degrees);
  const shift = direction().map((value) => (value * millimetres) / 1000);
  const held = turn(rotation, centre).map((value, k) => centre[k] - value + shift[k]);
  return { ...pose, ...after(poseOf(rotation, held), pose) };
}

/** A frame that keeps a random share of its depths, or only a number of evenly spaced rows. */
export function thinned(frame, { keep, rings }) {
  if (keep === 1 && rings === Infinity) return frame;
  const { width, height, data } = frame.depth;
  const count = Math.min(rings, height);
  const rows = new Set(Array.from({ length: count }, (_, k) => Math.floor(((k + 0.5) * height) / count)));
  const { uniform } = chance(1);
  const kept = data.map((depth, index) => (rows.has(Math.floor(index / width)) && uniform() < keep ? depth : 0));
  return { ...frame, depth: { ...frame.depth, data: kept } };
}

/** Rotation vector from one pose to another, and shift of a point of the colour frame. */
export function offset(estimate, truth, middle) {
  const w = offBy(truth.rotation, estimate.rotation).map((degrees) => (degrees * Math.PI) / 180);
  const v = moved(truth, moved(inverse(estimate), middle)).map((value, k) => value - middle[k]);
  return [...w, ...v];
}

/** Degrees and millimetres of an offset. */
export const sizes = (d) => ({
  degrees: (Math.hypot(...d.slice(0, 3)) * 180) / Math.PI,
  millimetres: 1000 * Math.hypot(...d.slice(3)),
});

/** d^T C^-1 d by elimination. */
export function mahalanobis(covariance, d) {
  const rows = d.map((value, i) => [...covariance.slice(6 * i, 6 * i + 6), value]);
  for (let k = 0; k < 6; k++) {
    for (let i = k + 1; i < 6; i++) {
      const factor = rows[i][k] / rows[k][k];
      for (let j = k; j < 7; j++) rows[i][j] -= factor * rows[k][j];
    }
  }
  const x = Array(6).fill(0);
  for (let i = 5; i >= 0; i--)
    x[i] = (rows[i][6] - rows[i].slice(i + 1, 6).reduce((sum, value, j) => sum + value * x[i + 1 + j], 0)) / rows[i][i];
  return d.reduce((sum, value, i) => sum + value * x[i], 0);
}

export const quantile = (values, share) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(values.length * share))] ?? NaN;
export const percent = (some, all) => (all === 0 ? "-" : `${Math.round((100 * some) / all)} %`);
