// Turns rasters into pictures: converts numbers to colours, crops to an object, and encodes a JPEG as a data address.
import jpeg from "jpeg-js";

const QUALITY = 88;
/** Approximate gamma of sRGB. */
const GAMMA = 2.2;

export const WHITE = [255, 255, 255];
export const clamped = (value, least, most) => Math.min(most, Math.max(least, value));
/** Converts a share of light, 0 to 1, to a byte of sRGB. */
export const byteOf = (share) => 255 * clamped(share, 0, 1) ** (1 / GAMMA);
/** A colour mixed with white: a share of 0 gives white, 1 the colour itself. */
export const tint = (share, colour) => colour.map((end) => 255 + (end - 255) * clamped(share, 0, 1));
export const grey = (share) => Array(3).fill(byteOf(share));
/** A normal as a colour: red is x to the right, green y downward, blue toward the camera. */
export const normalColour = ([x, y, z]) => [x, y, -z].map((part) => 127.5 * (1 + part));

export const triple = (raster, index) => [raster[3 * index], raster[3 * index + 1], raster[3 * index + 2]];
/** The indices of a raster's pixels that meet a condition. */
export const indices = ({ width, height }, holds) =>
  Array.from({ length: width * height }, (_, index) => index).filter(holds);

/** The smallest box around the pixels that meet a condition, with a margin that stays inside the raster. */
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

/** The pixels of a box as a picture with a data address. `pixel` gives R, G, B from 0 to 255, or undefined for white. */
export function picture({ width }, box, pixel) {
  const data = new Uint8Array(4 * box.width * box.height);
  for (let at = 0; at < box.width * box.height; at++) {
    const index = (box.top + Math.floor(at / box.width)) * width + box.left + (at % box.width);
    data.set([...(pixel(index) ?? WHITE), 255].map(Math.round), 4 * at);
  }
  const file = jpeg.encode({ width: box.width, height: box.height, data }, QUALITY).data;
  return { box, address: `data:image/jpeg;base64,${Buffer.from(file).toString("base64")}` };
}

/** The median; of an even number of values, the upper of the two in the middle. */
export const median = (values) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];
