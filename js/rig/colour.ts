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

/** Whether a grey picture of 8 bits has two levels only, one of them zero. */
export function looksLikeMask(picture: Picture): boolean {
  if (picture.bits > 8 || !isGrey(picture)) return false;
  const { data, channels } = picture;
  let level = 0;
  let [dark, lit] = [false, false];
  for (let at = 0; at < data.length; at += channels) {
    const value = data[at] ?? 0;
    if (value === 0) dark = true;
    else if (level === 0 || value === level) [level, lit] = [value, true];
    else return false;
  }
  return dark && lit;
}
