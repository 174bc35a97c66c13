/** Converts a raster to a colour image or a mask, with warnings if it looks like something else. */
import { hasColour, toColour, toMask } from "../raster.js";
import { isGrey } from "./depth.js";
import type { Picture } from "./formats/picture.js";
import type { RigReading, Unnamed } from "./types.js";
import { warning } from "./warnings.js";

const CHANNELS = ["", "grey", "grey with alpha", "RGB", "RGB with alpha"];
const stored = ({ width, height, bits, channels, data }: Picture): string =>
  `${width}x${height}, ${bits}-bit${data instanceof Float32Array ? " float" : ""} ${CHANNELS[channels] ?? ""}`;

/** Whether a picture is like those of depth cameras: one channel of more than 8 bits. */
export const looksLikeDepth = (picture: Picture): boolean =>
  picture.bits > 8 && picture.channels !== 4 && isGrey(picture);

export function pictureColour(picture: Picture): Unnamed<Extract<RigReading, { kind: "colour" }>> {
  const image = { ...toColour(picture), ...(picture.transfer && { transfer: picture.transfer }) };
  const warnings = [...picture.warnings];
  if (looksLikeDepth(picture))
    warnings.push(
      warning(
        "files-swapped",
        `It looks like a depth map (${picture.bits}-bit, grey) where a colour image was expected: were the files swapped?`,
      ),
    );
  return {
    kind: "colour",
    image,
    isGrey: !hasColour(picture.channels),
    says: [stored(picture), ...picture.notes].join(", "),
    warnings,
  };
}

export function pictureMask(picture: Picture): Unnamed<Extract<RigReading, { kind: "mask" }>> {
  const mask = toMask(picture);
  let inside = 0;
  for (const value of mask.data) if (value > 0) inside++;
  const share = inside / mask.data.length;
  const warnings = [...picture.warnings];
  if (share === 0) warnings.push(warning("mask-empty", "The mask is empty: no pixel belongs to the object."));
  if (share === 1) warnings.push(warning("mask-full", "The mask covers the whole picture."));
  return {
    kind: "mask",
    mask,
    isGrey: !hasColour(picture.channels),
    says: `${stored(picture)}, a mask of ${(100 * share).toFixed(1)} % of the pixels`,
    warnings,
  };
}

/** The different levels of a grey picture of integers, the lowest first; undefined for more than `most`. */
function levelsOf({ data, channels }: Picture, most: number): number[] | undefined {
  const levels = new Set<number>();
  let last: number | undefined;
  for (let at = 0; at < data.length; at += channels) {
    const level = data[at] ?? 0;
    // The level of the last pixel is compared first, because neighbours mostly have the same level and a set is slow.
    if (level === last) continue;
    last = level;
    levels.add(level);
    if (levels.size > most) return undefined;
  }
  return [...levels].sort((a, b) => a - b);
}

/** Whether a grey picture has only two levels, one of them zero, and is not a depth map of one distance. */
export function looksLikeMask(picture: Picture): boolean {
  if (picture.data instanceof Float32Array || !isGrey(picture)) return false;
  const levels = levelsOf(picture, 2);
  const isMask = levels?.length === 2 && levels[0] === 0;
  // A 16-bit depth map of a flat wall has two levels as well; the level of a mask is the largest value, or 1.
  return isMask && (picture.bits <= 8 || levels[1] === 0xffff || levels[1] === 1 || levels[1] === 255);
}

/**
 * In a mask with soft edges, the smallest share of the pixels that are wholly inside or outside, and the smallest share of each of these
 * two.
 */
const [HARD, EACH] = [0.95, 0.02];

/** Whether nearly all pixels of a grey picture have one of two levels, zero and the largest of its bit depth or, if `ofName`, its own largest. */
export function looksLikeSoftMask(picture: Picture, ofName: boolean): boolean {
  const { data, channels, bits } = picture;
  if (data instanceof Float32Array || bits < 8 || !isGrey(picture)) return false;
  let most = bits > 8 ? 0xffff : 0xff;
  if (ofName) {
    most = 0;
    for (let at = 0; at < data.length; at += channels) most = Math.max(most, data[at] ?? 0);
  }
  let [outside, inside] = [0, 0];
  for (let at = 0; at < data.length; at += channels) {
    if (data[at] === 0) outside++;
    else if (data[at] === most) inside++;
  }
  const count = data.length / channels;
  return inside >= EACH * count && outside >= EACH * count && inside + outside >= HARD * count;
}

/** The largest number of an object's label. */
const MOST_LABELS = 64;
/** Smallest number of pixels of a picture in which few different levels suggest labels. */
const FEWEST_PIXELS = 1000;

/** Whether a 16-bit picture holds only a few small numbers, which are labels rather than a depth camera's millimetres. */
export function looksLikeLabels(picture: Picture): boolean {
  if (!(picture.data instanceof Uint16Array) || picture.data.length < FEWEST_PIXELS || !isGrey(picture)) return false;
  const levels = levelsOf(picture, MOST_LABELS);
  return levels !== undefined && (levels.at(-1) ?? 0) <= MOST_LABELS;
}
