/** A raster as a colour image or a mask, and what of it looks like something else. */
import { hasColour, toColour, toMask } from "../raster.js";
import { isGrey, type Found } from "./depth.js";
import type { Picture } from "./formats/picture.js";
import type { RigReading } from "./types.js";
import { warning } from "./warnings.js";

const CHANNELS = ["", "grey", "grey with alpha", "RGB", "RGB with alpha"];
const stored = ({ width, height, bits, channels, data }: Picture): string =>
  `${width}x${height}, ${bits}-bit${data instanceof Float32Array ? " float" : ""} ${CHANNELS[channels] ?? ""}`;

/** Whether it is what depth cameras write: one channel of more than 8 bits. */
export const looksLikeDepth = (picture: Picture): boolean =>
  picture.bits > 8 && picture.channels !== 4 && isGrey(picture);

export function pictureColour(picture: Picture): Found<Extract<RigReading, { kind: "colour" }>> {
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

export function pictureMask(picture: Picture): Found<Extract<RigReading, { kind: "mask" }>> {
  const mask = toMask(picture);
  const share = mask.data.reduce((sum, value) => sum + (value > 0 ? 1 : 0), 0) / mask.data.length;
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

/** Different levels of a grey picture of whole numbers, the lowest first; nothing where there are more than so many. */
function levelsOf({ data, channels }: Picture, most: number): number[] | undefined {
  const levels = new Set<number>();
  for (let at = 0; at < data.length; at += channels) {
    levels.add(data[at] ?? 0);
    if (levels.size > most) return undefined;
  }
  return [...levels].sort((a, b) => a - b);
}

/** Whether a grey picture has two levels only, one of them zero. */
export function looksLikeMask(picture: Picture): boolean {
  if (picture.data instanceof Float32Array || !isGrey(picture)) return false;
  const levels = levelsOf(picture, 2);
  const isMask = levels?.length === 2 && levels[0] === 0;
  // Of 16 bits a wall before nothing may be one, too; masks are as bright as can be, or ones.
  return isMask && (picture.bits <= 8 || levels[1] === 0xffff || levels[1] === 1 || levels[1] === 255);
}

/** Objects that labels tell apart. */
const MOST_LABELS = 64;
/** Pixels of a picture whose few levels say something. */
const FEWEST_PIXELS = 1000;

/** Whether 16 bits hold a few small numbers, as no depth camera's millimetres are. */
export function looksLikeLabels(picture: Picture): boolean {
  if (!(picture.data instanceof Uint16Array) || picture.data.length < FEWEST_PIXELS || !isGrey(picture)) return false;
  const levels = levelsOf(picture, MOST_LABELS);
  return levels !== undefined && (levels.at(-1) ?? 0) <= MOST_LABELS;
}
