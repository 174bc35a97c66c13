/** The side of a picture that is up, according to EXIF. */
import type { Picture } from "./picture.js";
import { type ReaderWarning, warning } from "../warnings.js";

const ORIENTATION = 0x0112;
const MOST_TAGS = 500;

/** The orientation, 1 to 8, from EXIF, which is a TIFF without pixels; 1 if EXIF does not state it. */
export function exifOrientation(exif: Uint8Array): number {
  if (exif.length < 14) return 1;
  const view = new DataView(exif.buffer, exif.byteOffset, exif.byteLength);
  const little = view.getUint16(0) === 0x4949;
  const at = view.getUint32(4, little);
  if (at + 2 > exif.length) return 1;
  const count = Math.min(view.getUint16(at, little), MOST_TAGS);
  for (let index = 0; index < count; index++) {
    const entry = at + 2 + 12 * index;
    if (entry + 12 > exif.length) break;
    if (view.getUint16(entry, little) === ORIENTATION) return view.getUint16(entry + 8, little);
  }
  return 1;
}

const TURNS = [
  "",
  "",
  "mirrored",
  "rotated by 180 degrees",
  "mirrored upside down",
  "mirrored and rotated",
  "rotated by 90 degrees",
  "mirrored and rotated",
  "rotated by 270 degrees",
];

/** The note and the warning about a picture that was turned: most intrinsics are those of the sensor's frame. */
export function turnedWords(orientation: number, why: string): { note: string; turned: ReaderWarning } {
  const note = `${TURNS[orientation]} as ${why}`;
  const message = `The picture was ${note}; the intrinsics must be those of the rotated picture.`;
  return { note, turned: warning("image-turned", message, { orientation }) };
}

/** The picture upright. */
export function turnedBy(picture: Picture, orientation: number, why: string): Picture {
  if (!(orientation >= 2 && orientation <= 8)) return picture;
  const { width, height, channels, data } = picture;
  const isSwapped = orientation >= 5;
  const [across, down] = isSwapped ? [height, width] : [width, height];
  const out = data.slice() as typeof data;
  // Whether columns and rows are stored in reverse order.
  const [flipX, flipY] = [[2, 3, 7, 8].includes(orientation), [3, 4, 6, 7].includes(orientation)];
  for (let y = 0; y < down; y++) {
    for (let x = 0; x < across; x++) {
      const [column, row] = isSwapped ? [y, x] : [x, y];
      const from = ((flipY ? height - 1 - row : row) * width + (flipX ? width - 1 - column : column)) * channels;
      const to = (y * across + x) * channels;
      for (let channel = 0; channel < channels; channel++) out[to + channel] = data[from + channel] ?? 0;
    }
  }
  const { note, turned } = turnedWords(orientation, why);
  return {
    ...picture,
    width: across,
    height: down,
    data: out,
    notes: [...picture.notes, note],
    warnings: [...picture.warnings, turned],
  };
}
