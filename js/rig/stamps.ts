/**
 * Time stamps in names that have other numbers as well: counters, sizes, dates.
 *
 * All names of a set must have the same words and the same form of stamp. Stamps show which frames belong together only if they are finer
 * than half the time between two frames.
 */
import { folderOf, stem, timeOf } from "./names.js";

/** The time of a match, seconds from any origin, and the step of its last digit. */
type Form = [pattern: RegExp, time: (parts: string[]) => number, step: (parts: string[]) => number];

const FRACTION = String.raw`(\d{3}|\d{6}|\d{9})`;
const fraction = (digits = ""): number => (digits === "" ? 0 : Number(`0.${digits}`));
const stepOf = (digits = ""): number => 10 ** -digits.length;
const TICK: Record<string, number> = { ms: 1e-3, us: 1e-6, ns: 1e-9 };

const FORMS: Form[] = [
  // 2024-05-06-12-30-00-123, 20240506_123000_123456
  [
    new RegExp(
      String.raw`(?<!\d)(20\d\d)([-_.]?)([01]\d)\2([0-3]\d)[-_.t ]?([0-2]\d)[-_.h]?([0-5]\d)[-_.m]?([0-6]\d)(?:[-_.s]?${FRACTION})?(?![-_.]?\d)`,
    ),
    ([year, , month, day, hour, minute, second, digits]) =>
      Date.UTC(Number(year), Number(month) - 1, Number(day), Number(hour), Number(minute), Number(second)) / 1000 +
      fraction(digits),
    ([, , , , , , , digits]) => stepOf(digits),
  ],
  // Seconds since 1970 with their fraction: 1700000000.033, 1700000000_004000000.
  [
    new RegExp(String.raw`(?<!\d)([1-3]\d{9})[-_.]${FRACTION}(?![-_.]?\d)`),
    ([seconds, digits]) => Number(seconds) + fraction(digits),
    ([, digits]) => stepOf(digits),
  ],
  // Milliseconds, microseconds or nanoseconds since 1970.
  [
    /(?<!\d)([1-3]\d{9})(\d{3}|\d{6}|\d{9})(?![-_.]?\d)/,
    ([seconds, digits]) => Number(seconds) + fraction(digits),
    ([, digits]) => stepOf(digits),
  ],
  [
    /(?<![\d.])(\d+)(ms|us|ns)(?![a-z])/,
    ([ticks, unit = ""]) => Number(ticks) * (TICK[unit] ?? NaN),
    ([, unit = ""]) => TICK[unit] ?? NaN,
  ],
  // SUN3D's counter, then microseconds since the start.
  [/(?<!\d)\d+[-_](\d{9,15})$/, ([ticks]) => Number(ticks) * 1e-6, () => 1e-6],
];

export interface Times {
  colours: number[];
  depths: number[];
  /** Whether the names consist of times only. */
  isAlone: boolean;
}

/** Half the median time between two frames, in the set whose frames are closer together. */
export function halfFrame(...sets: number[][]): number {
  const medians = sets.map((times) => {
    const order = [...times].sort((a, b) => a - b);
    const gaps = order.slice(1).map((time, at) => time - (order[at] ?? NaN));
    const sorted = gaps.filter((gap) => gap > 0).sort((a, b) => a - b);
    return sorted[(sorted.length - 1) >> 1] ?? Infinity;
  });
  return Math.min(...medians) / 2;
}

/** The times of one set, and their step; undefined where a name differs from the others in more than digits, or two have the same time. */
function ofSet(names: string[], [pattern, time, step]: Form): { times: number[]; step: number } | undefined {
  const shapes = new Set(names.map((name) => folderOf(name) + stem(name).replace(/\d+/g, "0")));
  if (shapes.size !== 1) return undefined;
  const found = names.flatMap((name) => {
    const match = pattern.exec(stem(name).toLowerCase());
    return match ? [match.slice(1)] : [];
  });
  const [times, steps] = [found.map(time), new Set(found.map(step))];
  const [only = NaN] = steps;
  const isGood = times.length === names.length && steps.size === 1 && new Set(times).size === times.length;
  return isGood && times.every(Number.isFinite) ? { times, step: only } : undefined;
}

/** The times in the names of colour images and depth maps; undefined where they have none that distinguishes the frames. */
export function timesOf(colours: string[], depths: string[]): Times | undefined {
  const [ours, theirs] = [colours.map(timeOf), depths.map(timeOf)];
  const isTime = (time: number | undefined): time is number => time !== undefined;
  if (ours.every(isTime) && theirs.every(isTime)) return { colours: ours, depths: theirs, isAlone: true };
  for (const form of FORMS) {
    const [one, other] = [ofSet(colours, form), ofSet(depths, form)];
    if (one === undefined || other === undefined) continue;
    if (Math.max(one.step, other.step) > halfFrame(one.times, other.times)) continue;
    return { colours: one.times, depths: other.times, isAlone: false };
  }
  return undefined;
}
