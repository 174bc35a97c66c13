// Random numbers from a seed and the statistics of the tables, the same on every platform.

/** Random numbers that are the same everywhere: sfc32, seeded by splitmix. */
export function chance(seed) {
  let mixed = Math.imul(seed, 0x9e3779b1) >>> 0;
  const next = () => {
    mixed = (mixed + 0x9e3779b9) >>> 0;
    let z = mixed;
    z = Math.imul(z ^ (z >>> 16), 0x85ebca6b);
    z = Math.imul(z ^ (z >>> 13), 0xc2b2ae35);
    return (z ^ (z >>> 16)) >>> 0;
  };
  let [a, b, c, count] = [next(), next(), next(), 1];
  const whole = () => {
    const sum = (a + b + count++) >>> 0;
    a = b ^ (b >>> 9);
    b = (c + (c << 3)) >>> 0;
    c = (((c << 21) | (c >>> 11)) + sum) >>> 0;
    return sum;
  };
  const uniform = (low = 0, high = 1) => low + ((high - low) * whole()) / 2 ** 32;
  return {
    uniform,
    below: (count) => Math.floor(uniform(0, count)),
    /** Standard normal, by Box and Muller. */
    gaussian: () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform()),
  };
}

/** A separate seed for each name (FNV-1a), so that no two cells share their noise. */
export function seedOf(name) {
  let hash = 0x811c9dc5;
  for (const letter of name) hash = Math.imul(hash ^ letter.charCodeAt(0), 0x01000193) >>> 0;
  return hash;
}

/** Lower triangle of the Cholesky factor of a symmetric positive definite matrix, as a list of rows. */
function cholesky(matrix) {
  const lower = matrix.map((row) => row.map(() => 0));
  for (let i = 0; i < matrix.length; i++) {
    for (let j = 0; j <= i; j++) {
      let rest = matrix[i][j];
      for (let k = 0; k < j; k++) rest -= lower[i][k] * lower[j][k];
      lower[i][j] = i === j ? Math.sqrt(rest) : rest / lower[j][j];
    }
  }
  return lower;
}

/** A draw from a Gaussian with this mean and covariance. */
export function drawGaussian({ mean, covariance }, { gaussian }) {
  const whitened = mean.map(() => gaussian());
  return cholesky(covariance).map((row, i) => mean[i] + row.reduce((sum, value, j) => sum + value * whitened[j], 0));
}

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

/** The values in order, without missing ones. */
const sorted = (values) => values.filter(isNumber).sort((a, b) => a - b);

/** The quantile, interpolated linearly; null if there are no values. */
export function quantile(values, share) {
  const all = sorted(values);
  if (all.length === 0) return null;
  const at = share * (all.length - 1);
  const [low, high] = [all[Math.floor(at)], all[Math.ceil(at)]];
  return low + (high - low) * (at - Math.floor(at));
}

export const median = (values) => quantile(values, 0.5);
export const worst = (values) => quantile(values, 1);

export function mean(values) {
  const all = values.filter(isNumber);
  return all.length === 0 ? null : all.reduce((sum, value) => sum + value, 0) / all.length;
}

/** Share of the items that pass; null for an empty list. */
export const share = (items, passes) => (items.length === 0 ? null : items.filter(passes).length / items.length);

export const rms = (values) => (values.length === 0 ? null : Math.sqrt(mean(values.map((value) => value * value))));
