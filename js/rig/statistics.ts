/** Order statistics of what the readers see. */

/** The upper of the middle values; NaN where there is no value. */
export const median = (values: ArrayLike<number>): number =>
  Float64Array.from(values).sort()[values.length >> 1] ?? NaN;

/** The value at a share, 0 to 1, of values in order; NaN where there is no value. */
export const quantile = (sorted: Float64Array, share: number): number =>
  sorted[Math.floor(share * (sorted.length - 1))] ?? NaN;
