/** The unit of a depth map by its values, where neither the file nor anybody says it; and the statistics that this rests on. */

/** Depths of which a rig's camera is expected to see, metres. */
export const NEAREST = 0.1;
export const FARTHEST = 20;
/** Half of what indoor sensors with integer depths see lies nearer, metres; beyond it the unit is not the millimetre. */
const USUAL = 8;
/** .. but a LiDAR's millimetres reach farther. */
const USUAL_OUTDOORS = 40;
/** Share of values that a rule about their last digits has to hold for. */
const NEARLY_ALL = 0.99;
/** Fewer different depths are a scene made by hand, whose round numbers say nothing of the unit. */
const MANY_VALUES = 16;

export interface Unit {
  /** Metres per stored unit. */
  metres: number;
  says: string;
  isGuessed: boolean;
  /** Whether other units would do nearly as well. */
  isOpen?: boolean;
}

const FIFTHS = 0.0002;
const NAMED: [number, string][] = [
  [1, "metres"],
  [0.001, "millimetres"],
  [0.01, "centimetres"],
  [FIFTHS, "fifths of a millimetre, 5000 to the metre"],
  [0.0001, "tenths of a millimetre"],
  [1 / 256, "256 to the metre, as KITTI has it"],
];
export const nameOf = (metres: number): string =>
  NAMED.find(([unit]) => Math.abs(metres / unit - 1) < 1e-6)?.[1] ??
  `units of ${Number((1000 * metres).toPrecision(4))} mm`;

export const isThere = (value: number): boolean => value > 0 && value < 1e12;
export const metresText = (value: number): string =>
  value < 0.01 || value >= 1000 ? value.toPrecision(3) : value.toFixed(2);

/** The valid values in order, at most so many of them: quantiles need no more. */
const SAMPLE = 65_536;
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

export const quantile = (sorted: Float64Array, share: number): number =>
  sorted[Math.floor(share * (sorted.length - 1))] ?? NaN;
export const shareOf = (values: Float64Array, rule: (value: number) => boolean): number =>
  values.reduce((sum, value) => sum + (rule(value) ? 1 : 0), 0) / values.length;

export const isVaried = (values: Float64Array): boolean => new Set(values).size >= MANY_VALUES;

/** Of TUM's files all values are multiples of 5, since they are fives of a Kinect's millimetres. */
export const areFives = (values: Float64Array): boolean => shareOf(values, (value) => value % 5 === 0) >= NEARLY_ALL;

/** The unit of whole numbers; scattered ones are those of a LiDAR. */
export function unitOfIntegers(values: Float64Array, isScattered = false): Unit {
  const guessed = (metres: number, why: string, isOpen: boolean): Unit => ({
    metres,
    says: `${nameOf(metres)} (guessed${why})`,
    isGuessed: true,
    isOpen,
  });
  const median = quantile(values, 0.5);
  if (isVaried(values) && areFives(values) && median > 1000 * NEAREST * 5)
    return guessed(FIFTHS, ": all values are multiples of 5", false);
  // KITTI's 256 to the metre or millimetres: nothing in the values tells.
  if (isScattered && median <= 1000 * USUAL_OUTDOORS) return guessed(0.001, ": scattered, as a LiDAR's", true);
  if (median > 1000 * USUAL) return guessed(FIFTHS, ": too far for millimetres", true);
  return guessed(0.001, "", false);
}

/** The unit of floats: millimetres if half of them lay beyond what metres would reach. */
export function unitOfFloats(values: Float64Array): Unit {
  const metres = quantile(values, 0.5) > FARTHEST ? 0.001 : 1;
  return { metres, says: `${nameOf(metres)} (guessed)`, isGuessed: true };
}

export const told = (metres: number): Unit => ({ metres, says: nameOf(metres), isGuessed: false });

/** What depths from and to would be in other common units, where these would do nearly as well. */
export function otherUnits({ metres, isOpen }: Unit, nearest: number, farthest: number): string {
  if (!isOpen) return "";
  const others = [0.001, 0.0001, FIFTHS, 1 / 256].filter((unit) => unit !== metres);
  const texts = others.map(
    (unit) => `${metresText(nearest * unit)} to ${metresText(farthest * unit)} m in ${nameOf(unit)}`,
  );
  return ` (${texts.join(", ")})`;
}
