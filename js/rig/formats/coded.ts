/**
 * Depths that an 8-bit picture stores in its colour channels: CARLA's and AirSim's 24 bits, or a high and a low byte.
 *
 * Carries distinguish such pictures from photographs and colour-mapped renderings: if the higher byte changes by one between two
 * neighbours, the lower byte wraps around. Limits: only the four orders of bytes below are known, and 24 bits are read in CARLA's unit.
 */
import { median } from "../statistics.js";
import { type ReaderWarning, warning } from "../warnings.js";
import type { Picture } from "./picture.js";

interface Code {
  /** Channels from the lowest byte to the highest. */
  order: readonly number[];
  says: string;
}

const CODES: readonly Code[] = [
  { order: [0, 1, 2], says: "24 bits, red the lowest byte" },
  { order: [2, 1, 0], says: "24 bits, blue the lowest byte" },
  { order: [0, 1], says: "16 bits, red the low byte and green the high one" },
  { order: [1, 0], says: "16 bits, green the low byte and red the high one" },
];
/** Metres per unit of CARLA's 24 bits, whose full range is 1000 m. */
const CARLA = 1000 / (2 ** 24 - 1);
/** The smallest change of the lower byte, in the direction opposite to that of the higher byte, that counts as a wrap. */
const WRAP = 64;
/** Smallest number of changes of the higher byte by one that a decision needs, and the smallest share of them that must be carries. */
const [FEWEST_MOVES, MOSTLY] = [20, 0.7];
/** The largest median of depths in millimetres. */
const USUAL = 8000;

/** The share of carries: how often the lower channel wraps around if the higher one changes by one between neighbours in a row. */
function carries({ data, width, channels }: Picture, low: number, high: number): number {
  let [moves, carried] = [0, 0];
  for (let pixel = 1; pixel < data.length / channels; pixel++) {
    const [at, before] = [pixel * channels, (pixel - 1) * channels];
    const moved = (data[at + high] ?? 0) - (data[before + high] ?? 0);
    if (Math.abs(moved) !== 1 || pixel % width === 0) continue;
    moves++;
    if (((data[before + low] ?? 0) - (data[at + low] ?? 0)) * moved > WRAP) carried++;
  }
  return moves < FEWEST_MOVES ? 0 : carried / moves;
}

const isEmpty = ({ data, channels }: Picture, channel: number): boolean => {
  for (let at = channel; at < data.length; at += channels) if (data[at] !== 0) return false;
  return true;
};

/** Largest share of neighbours between which the highest of three bytes may change. */
const SELDOM = 0.1;
/** Smallest median change of the lowest byte, and largest median second difference of the two lower bytes together. */
const [ROUGH, SMOOTH] = [16, 4096];

/** Whether three channels, from the lowest byte to the highest, hold one smooth number of 24 bits. */
function isSmooth({ data, width, channels }: Picture, [low = 0, middle = 0, high = 0]: readonly number[]): boolean {
  const [changes, bends]: [number[], number[]] = [[], []];
  let moved = 0;
  for (let pixel = 2; pixel < data.length / channels; pixel++) {
    if (pixel % width < 2) continue;
    const byte = (channel: number, back: number) => data[(pixel - back) * channels + channel] ?? 0;
    const pair = (back: number) => 256 * byte(middle, back) + byte(low, back);
    // All bytes of a hole are zero.
    if ([0, 1, 2].some((back) => pair(back) + byte(high, back) === 0)) continue;
    if (byte(high, 0) !== byte(high, 1)) moved++;
    changes.push(Math.abs(byte(low, 0) - byte(low, 1)));
    const bend = (pair(0) - 2 * pair(1) + pair(2)) & 0xffff;
    bends.push(Math.min(bend, 0x10000 - bend));
  }
  return (
    changes.length >= FEWEST_MOVES &&
    moved < SELDOM * changes.length &&
    median(changes) > ROUGH &&
    median(bends) < SMOOTH
  );
}

/** Whether a picture has carries, or three bytes that form a smooth number: near the camera, the highest byte hardly changes. */
function fits(picture: Picture, { order }: Code): boolean {
  // Codes of two bytes leave the blue channel empty.
  const isTwo = order.length === 2;
  if (isTwo ? !isEmpty(picture, 2) : order.some((channel) => isEmpty(picture, channel))) return false;
  const [low = 0, high = 1] = order.slice(-2);
  return carries(picture, low, high) >= MOSTLY || (order.length === 3 && isSmooth(picture, order));
}

const codeOf = (picture: Picture): Code | undefined =>
  picture.bits === 8 && picture.channels >= 3 ? CODES.find((each) => fits(picture, each)) : undefined;

/** Whether the colours of a picture encode a depth map. */
export const isCoded = (picture: Picture): boolean => codeOf(picture) !== undefined;

/** The depth map that the colours of a picture encode; undefined for other pictures. */
export function decoded(picture: Picture): Picture | undefined {
  const code = codeOf(picture);
  if (code === undefined) return undefined;
  const { width, height, channels, data } = picture;
  const values = new Float32Array(width * height);
  for (let pixel = 0; pixel < values.length; pixel++)
    values[pixel] = code.order.reduce(
      (sum, channel, byte) => sum + (data[pixel * channels + channel] ?? 0) * 256 ** byte,
      0,
    );
  // CARLA's depths below 3.9 m leave the highest byte empty; read as millimetres, they would be too far away.
  const is24 = code.order.length === 3 || (code.order[0] === 0 && median(values.filter((value) => value > 0)) > USUAL);
  const warnings: ReaderWarning[] = [
    ...picture.warnings,
    warning(
      "unit-guessed",
      `The depths are coded in the picture's colours (guessed: ${code.says}); they were read as ${is24 ? "CARLA's, whose full range is 1000 m; other programs have other ranges" : "millimetres"}. Give the unit if that is wrong.`,
      { unit: is24 ? CARLA : 0.001 },
    ),
  ];
  const rest = {
    format: picture.format,
    bits: is24 ? 24 : 16,
    notes: [...picture.notes, "coded in colours"],
    warnings,
  };
  if (!is24) return { width, height, channels: 1, data: Uint16Array.from(values), unit: 0.001, ...rest };
  // The largest number marks the sky.
  const sky = 2 ** 24 - 1;
  return { width, height, channels: 1, data: values.map((value) => (value === sky ? 0 : value)), unit: CARLA, ...rest };
}
