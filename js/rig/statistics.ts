/** Order statistics of values that the readers examine. */

/** The upper median; NaN if there is no value. */
export const median = (values: ArrayLike<number>): number =>
  Float64Array.from(values).sort()[values.length >> 1] ?? NaN;

/** The quantile, 0 to 1, of sorted values; NaN if there is no value. */
export const quantile = (sorted: Float64Array, share: number): number =>
  sorted[Math.floor(share * (sorted.length - 1))] ?? NaN;
