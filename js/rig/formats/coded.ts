/**
 * Depths that a picture of 8 bits keeps in the bytes of its colours: CARLA's and AirSim's 24 bits, or a high and a low byte.
 *
 * They are told from photographs and from colour-mapped renderings by their carries: where the higher byte moves by one between two
 * neighbours, the lower one wraps around. Limits: an order of bytes that is none of these four; the unit of 24 bits other than CARLA's.
 */
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
/** CARLA's 24 bits reach to 1000 m. */
const CARLA = 1000 / (2 ** 24 - 1);
/** A wrap changes the lower byte by more than this, the other way. */
const WRAP = 64;
/** Moves of the higher byte that there have to be, and the share of them that has to be a carry. */
const [FEWEST_MOVES, MOSTLY] = [20, 0.7];
/** Half of what 16 bits in millimetres hold lies nearer, millimetres. */
const USUAL = 8000;

/** The share of moves of one channel by one, between neighbours in a row, with which the lower channel wraps around. */
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

/** Of 24 bits the highest byte changes between few neighbours .. */
const SELDOM = 0.1;
/** .. the lowest changes by more than this between most, and the two lower ones together are smooth. */
const [ROUGH, SMOOTH] = [16, 4096];

/** Whether three bytes from the lowest to the highest are those of one smooth number. */
function isSmooth({ data, width, channels }: Picture, [low = 0, middle = 0, high = 0]: readonly number[]): boolean {
  const [changes, bends]: [number[], number[]] = [[], []];
  let moved = 0;
  for (let pixel = 2; pixel < data.length / channels; pixel++) {
    if (pixel % width < 2) continue;
    const byte = (channel: number, back: number) => data[(pixel - back) * channels + channel] ?? 0;
    const pair = (back: number) => 256 * byte(middle, back) + byte(low, back);
    // Holes are zero in all bytes.
    if ([0, 1, 2].some((back) => pair(back) + byte(high, back) === 0)) continue;
    if (byte(high, 0) !== byte(high, 1)) moved++;
    changes.push(Math.abs(byte(low, 0) - byte(low, 1)));
    const bend = (pair(0) - 2 * pair(1) + pair(2)) & 0xffff;
    bends.push(Math.min(bend, 0x10000 - bend));
  }
  const middleOf = (values: number[]) => Float32Array.from(values).sort()[values.length >> 1] ?? 0;
  return (
    changes.length >= FEWEST_MOVES &&
    moved < SELDOM * changes.length &&
    middleOf(changes) > ROUGH &&
    middleOf(bends) < SMOOTH
  );
}

/** By carries, or of three bytes by their smoothness: near a camera the highest hardly changes. */
function fits(picture: Picture, { order }: Code): boolean {
  // Blue is one of three bytes, and not there of two.
  const isTwo = order.length === 2;
  if (isTwo ? !isEmpty(picture, 2) : order.some((channel) => isEmpty(picture, channel))) return false;
  const [low = 0, high = 1] = order.slice(-2);
  return carries(picture, low, high) >= MOSTLY || (order.length === 3 && isSmooth(picture, order));
}

const median = (values: Float32Array): number => {
  const there = values.filter((value) => value > 0).sort();
  return there[there.length >> 1] ?? 0;
};

/** The depth map that is coded in a picture of colours; nothing where none is. */
export function decoded(picture: Picture): Picture | undefined {
  if (picture.bits !== 8 || picture.channels < 3) return undefined;
  const code = CODES.find((each) => fits(picture, each));
  if (code === undefined) return undefined;
  const { width, height, channels, data } = picture;
  const values = new Float32Array(width * height);
  for (let pixel = 0; pixel < values.length; pixel++)
    values[pixel] = code.order.reduce(
      (sum, channel, byte) => sum + (data[pixel * channels + channel] ?? 0) * 256 ** byte,
      0,
    );
  // CARLA's depths below 3.9 m leave the highest byte empty, and are no millimetres.
  const is24 = code.order.length === 3 || (code.order[0] === 0 && median(values) > USUAL);
  const warnings: ReaderWarning[] = [
    ...picture.warnings,
    warning(
      "unit-guessed",
      `The depths are coded in the picture's colours (guessed: ${code.says}); they were read as ${is24 ? "CARLA's, 1000 m for the full range, and other programs have another range" : "millimetres"}. Give the unit if that is wrong.`,
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
  // The farthest there is means that nothing was hit.
  const sky = 2 ** 24 - 1;
  return { width, height, channels: 1, data: values.map((value) => (value === sky ? 0 : value)), unit: CARLA, ...rest };
}
