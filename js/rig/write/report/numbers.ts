/** Numbers for people: three digits, a true minus, a thin space before the unit, and a word in place of an invalid number. */

const NONE = "not known";
const [MOST_PLAIN, LEAST_PLAIN] = [1e5, 1e-3];
const SPACE = "\u202f";

/** A number with this many digits, without an exponent if a few zeros suffice. */
export function digits(value: number, count = 3): string {
  if (!Number.isFinite(value)) return NONE;
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size < LEAST_PLAIN || size >= MOST_PLAIN) return value.toExponential(count - 1).replaceAll("-", "\u2212");
  const decimals = Math.max(0, count - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(decimals).replace("-", "\u2212");
}

/** A round number for an axis. */
export const brief = (value: number): string => digits(value, 2).replace(/\.0$/, "");

/** A number with its unit; the degree sign follows without a space. */
export function measure(value: number, unit: string, count = 3): string {
  const text = digits(value, count);
  return text === NONE ? text : unit === "°" ? `${text}°` : `${text}${SPACE}${unit}`;
}

/** A range "from .. to", with the unit once. */
export function span([from, to]: readonly [number, number], unit: string): string {
  return Number.isFinite(from) && Number.isFinite(to) ? `${digits(from)} to ${measure(to, unit)}` : NONE;
}

export const percent = (share: number): string =>
  Number.isFinite(share) ? `${(100 * share).toFixed(0)}${SPACE}%` : NONE;

const LEAST_PROBABILITY = 0.001;

export function probability(value: number): string {
  if (!Number.isFinite(value)) return NONE;
  return value < LEAST_PROBABILITY ? `below ${LEAST_PROBABILITY}` : value.toFixed(3);
}

/** A fixed number of decimals, so that a column is aligned. */
export function fixed(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return NONE;
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "\u2212");
}
