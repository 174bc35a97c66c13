// Rasters as pictures: numbers to colours, the part of a raster where an object is, and JPEG in an address.
import jpeg from "jpeg-js";

const QUALITY = 88;
/** Of sRGB, nearly. */
const GAMMA = 2.2;

export const WHITE = [255, 255, 255];
export const clamped = (value, least, most) => Math.min(most, Math.max(least, value));
/** A share of light, 0 to 1, as a byte of sRGB. */
export const byteOf = (share) => 255 * clamped(share, 0, 1) ** (1 / GAMMA);
/** A share from white, 0, to a colour, 1. */
export const tint = (share, colour) => colour.map((end) => 255 + (end - 255) * clamped(share, 0, 1));
export const grey = (share) => Array(3).fill(byteOf(share));
/** A normal as a colour: x to the right, y down, toward the camera. */
export const normalColour = ([x, y, z]) => [x, y, -z].map((part) => 127.5 * (1 + part));

export const triple = (raster, index) => [raster[3 * index], raster[3 * index + 1], raster[3 * index + 2]];
/** The indices of a raster's pixels for which something holds. */
export const indices = ({ width, height }, holds) =>
  Array.from({ length: width * height }, (_, index) => index).filter(holds);

/** The smallest box around the pixels for which something holds, with a margin inside the raster. */
export function boxAround(size, holds, margin = 3) {
  const inside = indices(size, holds);
  const columns = inside.map((index) => index % size.width);
  const rows = inside.map((index) => Math.floor(index / size.width));
  const ends = (values, most) => [
    Math.max(0, values.reduce((a, b) => Math.min(a, b)) - margin),
    Math.min(most - 1, values.reduce((a, b) => Math.max(a, b)) + margin),
  ];
  const [[left, right], [top, bottom]] = [ends(columns, size.width), ends(rows, size.height)];
  return { left, top, width: right - left + 1, height: bottom - top + 1 };
}

/** A box's pixels as a picture in an address: `pixel` gives R, G, B, 0 to 255, or nothing, which is white. */
export function picture({ width }, box, pixel) {
  const data = new Uint8Array(4 * box.width * box.height);
  for (let at = 0; at < box.width * box.height; at++) {
    const index = (box.top + Math.floor(at / box.width)) * width + box.left + (at % box.width);
    data.set([...(pixel(index) ?? WHITE), 255].map(Math.round), 4 * at);
  }
  const file = jpeg.encode({ width: box.width, height: box.height, data }, QUALITY).data;
  return { box, address: `data:image/jpeg;base64,${Buffer.from(file).toString("base64")}` };
}

/** The middle of some numbers: half of them are smaller. */
export const median = (values) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];
