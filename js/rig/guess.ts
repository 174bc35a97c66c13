/** The unit of a depth map, guessed from its values if neither the file nor the caller gives it, and the statistics of these values. */
import { quantile } from "./statistics.js";

/** The depths that the camera of a rig is expected to see, metres. */
export const NEAREST = 0.1;
export const FARTHEST = 20;
/** Largest median depth that an indoor sensor with integer depths measures, metres; beyond it, the unit is not the millimetre. */
const USUAL = 8;
/** Largest median depth that a LiDAR outdoors measures, metres. */
const USUAL_OUTDOORS = 40;
/** Share of the values for which a rule about their last digits has to hold. */
const NEARLY_ALL = 0.99;
/** A depth map with fewer different values was made by hand, and its round numbers do not show the unit. */
const MANY_VALUES = 16;

export interface Unit {
  /** Metres per stored unit. */
  metres: number;
  says: string;
  isGuessed: boolean;
  /** Whether the values also fit other units. */
  isOpen?: boolean;
}

const FIFTHS = 0.0002;
const NAMED: [number, string][] = [
  [1, "metres"],
  [0.001, "millimetres"],
  [0.01, "centimetres"],
  [FIFTHS, "fifths of a millimetre, 5000 to the metre"],
  [0.0001, "tenths of a millimetre"],
  [1 / 256, "256 to the metre, as in KITTI"],
];
export const nameOf = (metres: number): string =>
  NAMED.find(([unit]) => Math.abs(metres / unit - 1) < 1e-6)?.[1] ??
  `units of ${Number((1000 * metres).toPrecision(4))} mm`;

export const isThere = (value: number): boolean => value > 0 && value < 1e12;
export const metresText = (value: number): string =>
  value < 0.01 ? value.toPrecision(3) : value.toFixed(value < 1000 ? 2 : 0);

/** Largest number of values in a sample; quantiles need no more. */
const SAMPLE = 65_536;
/** An evenly spread sample of the valid values among `values[offset + i * step]`, in order. */
export function sampled(values: ArrayLike<number>, step = 1, offset = 0): Float64Array {
  const count = Math.floor((values.length - offset + step - 1) / step);
  const stride = step * Math.max(1, Math.ceil(count / SAMPLE));
  const found: number[] = [];
  for (let at = offset; at < values.length; at += stride) {
    const value = values[at] ?? 0;
    if (isThere(value)) found.push(value);
  }
  return Float64Array.from(found).sort();
}

/** The number and the range of the valid values of a depth map or a cloud. */
export interface Extent {
  count: number;
  nearest: number;
  farthest: number;
}

/** The number and the range of the values `values[offset + i * step]`. */
export function extentOf(values: ArrayLike<number>, step = 1, offset = 0): Extent {
  const found: Extent = { count: 0, nearest: Infinity, farthest: 0 };
  for (let at = offset; at < values.length; at += step) {
    const value = values[at] ?? 0;
    if (!isThere(value)) continue;
    found.count++;
    if (value < found.nearest) found.nearest = value;
    if (value > found.farthest) found.farthest = value;
  }
  return found;
}

export const shareOf = (values: Float64Array, rule: (value: number) => boolean): number =>
  values.reduce((sum, value) => sum + (rule(value) ? 1 : 0), 0) / values.length;

export const isVaried = (values: Float64Array): boolean => new Set(values).size >= MANY_VALUES;

/** Whether all values are multiples of 5, as in TUM's files, whose fifths of a millimetre come from a Kinect's whole millimetres. */
export const areFives = (values: Float64Array): boolean => shareOf(values, (value) => value % 5 === 0) >= NEARLY_ALL;

/** The unit of integers; valid values that are scattered come from a LiDAR. */
export function unitOfIntegers(values: Float64Array, isScattered = false): Unit {
  const guessed = (metres: number, why: string, isOpen: boolean): Unit => ({
    metres,
    says: `${nameOf(metres)} (guessed${why})`,
    isGuessed: true,
    isOpen,
  });
  const middle = quantile(values, 0.5);
  if (isVaried(values) && areFives(values) && middle > 1000 * NEAREST * 5)
    return guessed(FIFTHS, ": all values are multiples of 5", false);
  // The values do not distinguish KITTI's 256 units per metre from millimetres.
  if (isScattered && middle <= 1000 * USUAL_OUTDOORS) return guessed(0.001, ": scattered like a LiDAR's", true);
  if (middle > 1000 * USUAL) return guessed(FIFTHS, ": too far for millimetres", true);
  return guessed(0.001, "", false);
}

/** The unit of floats: metres, or millimetres where the median depth would be out of range in metres. */
export function unitOfFloats(values: Float64Array): Unit {
  const metres = quantile(values, 0.5) > FARTHEST ? 0.001 : 1;
  return { metres, says: `${nameOf(metres)} (guessed)`, isGuessed: true };
}

export const knownUnit = (metres: number): Unit => ({ metres, says: nameOf(metres), isGuessed: false });

/** The range of depths in the other common units that the values also fit. */
export function otherUnits({ metres, isOpen }: Unit, { nearest, farthest }: Extent): string {
  if (!isOpen) return "";
  const others = [0.001, 0.0001, FIFTHS, 1 / 256].filter((unit) => unit !== metres);
  const texts = others.map(
    (unit) => `${metresText(nearest * unit)} to ${metresText(farthest * unit)} m in ${nameOf(unit)}`,
  );
  return ` (${texts.join(", ")})`;
}
