/** Files as pictures: colour images unchanged, depths in colours, masks in black and white. */

import { automaticRange, paintScalar } from "../draw/colours";
import type { CheckFrame } from "../../pkg/index.js";
import type { RigReading } from "./files";
import { metresOf } from "./restrict";

/** Subsampled pixels of a picture. */
interface Grid {
  width: number;
  height: number;
  /** The index of each pixel in the whole picture. */
  from(pixel: number): number;
}

/** Ratio of width to height at which a picture counts as a range image of a LiDAR. */
const PANORAMA = 4;

/** A preview is subsampled to twice its width first, because scaling a whole photograph would take long. */
function gridOf({ width, height }: { width: number; height: number }, wanted: number | undefined): Grid {
  const stride = wanted === undefined ? 1 : Math.max(1, Math.floor(width / (2 * wanted)));
  // Every row of a range image is kept, because it is many times as wide as high.
  const down = width > PANORAMA * height ? 1 : stride;
  const columns = Math.ceil(width / stride);
  const from = (pixel: number) => down * Math.floor(pixel / columns) * width + stride * (pixel % columns);
  return { width: columns, height: Math.ceil(height / down), from };
}

function colour({ data, transfer }: CheckFrame["image"], { width, height, from }: Grid): ImageData {
  const out = new ImageData(width, height);
  if (data instanceof Float32Array) {
    let white = 0;
    for (const value of data) if (value > white) white = value;
    for (let i = 0; i < width * height; i++) {
      const at = 3 * from(i);
      for (let c = 0; c < 3; c++) out.data[4 * i + c] = 255 * (Math.max(0, data[at + c] ?? 0) / white) ** (1 / 2.2);
      out.data[4 * i + 3] = 255;
    }
    return out;
  }
  const wide = data instanceof Uint16Array;
  // Linear integers would look black in the shadows.
  const level = (value: number) =>
    transfer === "linear" ? 255 * (value / (wide ? 65535 : 255)) ** (1 / 2.2) : wide ? value / 257 : value;
  for (let i = 0; i < width * height; i++) {
    const at = 4 * from(i);
    for (let c = 0; c < 3; c++) out.data[4 * i + c] = level(data[at + c] ?? 0);
    out.data[4 * i + 3] = 255;
  }
  return out;
}

/** Depths of a camera's map, or distances of a LiDAR's scan, half of whose points lie below the LiDAR. */
function distancesOf(map: CheckFrame["depth"]): Float32Array {
  const { points } = map;
  if (!points) return metresOf(map);
  const isBehind = points.some((value, i) => i % 3 === 2 && value < 0);
  if (!isBehind) return metresOf(map);
  return Float32Array.from({ length: points.length / 3 }, (_, i) =>
    Math.hypot(points[3 * i] ?? NaN, points[3 * i + 1] ?? NaN, points[3 * i + 2] ?? NaN),
  );
}

/** Depths outside the range are grey: they are not used. Holes stay clear, so that the hatching behind shows. */
function depth(
  map: CheckFrame["depth"],
  range: readonly [number, number] | undefined,
  { width, height, from }: Grid,
): ImageData {
  const metres = distancesOf(map);
  const data = Float32Array.from({ length: width * height }, (_, i) => {
    const z = metres[from(i)] ?? NaN;
    return z > 0 && z < 1e12 ? z : NaN;
  });
  const raster = { left: 0, top: 0, width, height, stride: 1, channels: 1 as const, data };
  const image = paintScalar(raster, automaticRange(raster) ?? { min: 0, max: 1 }, "viridis");
  if (range) {
    for (let i = 0; i < data.length; i++) {
      const z = data[i] ?? NaN;
      if (Number.isNaN(z) || (z >= range[0] && z <= range[1])) continue;
      image.data.set([128, 128, 128, 90], 4 * i);
    }
  }
  return image;
}

function mask(data: Uint8Array, { width, height, from }: Grid): ImageData {
  const out = new ImageData(width, height);
  for (let i = 0; i < width * height; i++) {
    out.data.fill(data[from(i)] ? 255 : 0, 4 * i, 4 * i + 3);
    out.data[4 * i + 3] = 255;
  }
  return out;
}

export function picture(reading: RigReading, range?: readonly [number, number], width?: number): Promise<ImageBitmap> {
  const made = pixels(reading, range, width);
  const isWide = made.width > PANORAMA * made.height;
  const small =
    width === undefined || width >= made.width
      ? {}
      : {
          resizeWidth: width,
          resizeQuality: "medium" as const,
          ...(isWide && { resizeHeight: Math.round(width / PANORAMA) }),
        };
  return createImageBitmap(made, small);
}

function pixels(
  reading: RigReading,
  range: readonly [number, number] | undefined,
  width: number | undefined,
): ImageData {
  switch (reading.kind) {
    case "colour":
      return colour(reading.image, gridOf(reading.image, width));
    case "depth":
      return depth(reading.depth, range, gridOf(reading.depth, width));
    case "mask":
      return mask(reading.mask.data, gridOf(reading.mask, width));
    default:
      throw new Error(`${reading.name} is not an image.`);
  }
}
