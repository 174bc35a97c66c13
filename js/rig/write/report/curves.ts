/**
 * The meaning of a sensitivity curve: its best offset, and the offsets that the likelihood does not exclude. Heights are in sigmas, the
 * square root of twice the fall of the log likelihood; flanks are straight if the noise is Gaussian, and all cues and axes have the same
 * scale.
 */

/** Sigmas within which 95 % of a Gaussian lie. */
export const SIGMAS_95 = 1.959964;

export interface Curve {
  /** In order of increasing offset; height in sigmas, zero at the best offset. */
  points: { offset: number; height: number }[];
  best: number;
  /** Ends of the 95 % interval about the best offset; undefined if the curve's range ends before. */
  from: number | undefined;
  to: number | undefined;
}

type Points = Curve["points"];

/** The place where the height first exceeds the 95 % level along these points, starting at the best one. */
function crossing(points: Points): number | undefined {
  const after = points.findIndex(({ height }) => height > SIGMAS_95);
  const [a, b] = [points[after - 1], points[after]];
  if (a === undefined || b === undefined) return undefined;
  return a.offset + ((SIGMAS_95 - a.height) / (b.height - a.height)) * (b.offset - a.offset);
}

/** The result is undefined if fewer than two values are numbers. */
export function curve(offsets: readonly number[], values: readonly number[]): Curve | undefined {
  const known = offsets
    .map((offset, index) => ({ offset, value: values[index] ?? NaN }))
    .filter(({ offset, value }) => Number.isFinite(offset) && Number.isFinite(value))
    .sort((a, b) => a.offset - b.offset);
  if (known.length < 2) return undefined;
  const peak = known.reduce((most, { value }) => Math.max(most, value), -Infinity);
  // If several offsets are equally good, the one nearest to the estimate counts.
  const best = known.reduce(
    (found, { offset, value }) => (value === peak && Math.abs(offset) < Math.abs(found) ? offset : found),
    Infinity,
  );
  const points = known.map(({ offset, value }) => ({ offset, height: Math.sqrt(2 * (peak - value)) }));
  const at = points.findIndex(({ offset }) => offset === best);
  return { points, best, from: crossing(points.slice(0, at + 1).reverse()), to: crossing(points.slice(at)) };
}
