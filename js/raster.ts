/** Rasters of any number of channels as the contract has them: colours, one channel, masks. */
import { badFile } from "./errors.js";
import type { Raster } from "./npy.js";
import type { ColorImage, Mask } from "./types/index.js";

export type Pixels = Uint8Array | Uint16Array | Float32Array;

export const hasColour = (channels: number): boolean => channels >= 3;
const hasAlpha = (channels: number): boolean => channels === 2 || channels === 4;

/** Copies pixels into another number of channels; grey is repeated. */
function spread<T extends Pixels>(
  { data, channels: from }: Raster<Pixels>,
  to: T,
  channels: number,
  opaque: number,
): T {
  const [green, blue] = hasColour(from) ? [1, 2] : [0, 0];
  const alpha = channels === 4 && hasAlpha(from) ? from - 1 : undefined;
  for (let at = 0, out = 0; out < to.length; at += from, out += channels) {
    to[out] = data[at] ?? 0;
    to[out + 1] = data[at + green] ?? 0;
    to[out + 2] = data[at + blue] ?? 0;
    if (channels === 4) to[out + 3] = alpha === undefined ? opaque : (data[at + alpha] ?? 0);
  }
  return to;
}

/** 255 where a pixel is at least half opaque; undefined without alpha, or if all pixels are opaque. */
function alphaMask({ width, height, channels, data }: Raster<Pixels>): Uint8Array | undefined {
  if (!hasAlpha(channels) || data instanceof Float32Array) return undefined;
  const half = data instanceof Uint16Array ? 0x8000 : 0x80;
  const mask = new Uint8Array(width * height);
  for (let pixel = 0; pixel < mask.length; pixel++) {
    mask[pixel] = (data[pixel * channels + channels - 1] ?? 0) >= half ? 255 : 0;
  }
  return mask.includes(0) ? mask : undefined;
}

/** A colour image; floats are linear. */
export function toColour(raster: Raster<Pixels>): ColorImage {
  const { width, height, data } = raster;
  const pixels = width * height;
  if (data instanceof Float32Array) return { width, height, data: spread(raster, new Float32Array(3 * pixels), 3, 1) };
  const rgba =
    data instanceof Uint16Array
      ? spread(raster, new Uint16Array(4 * pixels), 4, 0xffff)
      : spread(raster, new Uint8Array(4 * pixels), 4, 0xff);
  return { width, height, data: rgba };
}

/** The channel of a depth map, even if a program has saved it as grey RGB. */
export function single({ width, height, channels, data }: Raster<Pixels>): Pixels {
  if (channels === 1) return data;
  const levels = data instanceof Uint16Array ? new Uint16Array(width * height) : new Uint8Array(width * height);
  for (let pixel = 0; pixel < levels.length; pixel++) {
    const at = pixel * channels;
    const level = data[at] ?? 0;
    if (hasColour(channels) && (data[at + 1] !== level || data[at + 2] !== level)) {
      throw badFile(
        "a depth map has one value per pixel, but this picture is coloured; is it a rendering of the depth?",
      );
    }
    levels[pixel] = level;
  }
  return levels;
}

/** Pixels that are neither zero nor transparent belong to the object. */
export function toMask(raster: Raster<Pixels>): Mask {
  const { width, height, channels, data } = raster;
  const opaque = alphaMask(raster);
  const visible = hasColour(channels) ? 3 : 1;
  const mask = new Uint8Array(width * height);
  for (let pixel = 0, at = 0; pixel < mask.length; pixel++, at += channels) {
    let isLit = false;
    for (let channel = 0; channel < visible; channel++) isLit ||= (data[at + channel] ?? 0) > 0;
    if (isLit && opaque?.[pixel] !== 0) mask[pixel] = 255;
  }
  return { width, height, data: mask };
}
