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

/** By the two upper bytes; the lowest of three is mostly noise. */
function fits(picture: Picture, { order }: Code): boolean {
  // Blue is the lowest or the highest byte of three, and not there of two.
  if (isEmpty(picture, order.length === 2 ? 2 : (order[0] ?? 0)) !== (order.length === 2)) return false;
  const [low = 0, high = 1] = order.slice(-2);
  return carries(picture, low, high) >= MOSTLY;
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
