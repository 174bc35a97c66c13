/** Files as pictures: colours as they are, depths in colours, masks in black and white. */

import { automaticRange, paintScalar } from "../draw/colours";
import type { CheckFrame } from "../../pkg/index.js";
import type { RigReading } from "./files";
import { metresOf } from "./restrict";

function colour({ width, height, data, transfer }: CheckFrame["image"]): ImageData {
  const out = new ImageData(width, height);
  if (data instanceof Float32Array) {
    let white = 0;
    for (const value of data) if (value > white) white = value;
    for (let i = 0; i < width * height; i++) {
      for (let c = 0; c < 3; c++) out.data[4 * i + c] = 255 * (Math.max(0, data[3 * i + c] ?? 0) / white) ** (1 / 2.2);
      out.data[4 * i + 3] = 255;
    }
    return out;
  }
  const wide = data instanceof Uint16Array;
  // Linear integers would look black in the shadows.
  const level = (value: number) =>
    transfer === "linear" ? 255 * (value / (wide ? 65535 : 255)) ** (1 / 2.2) : wide ? value / 257 : value;
  for (let i = 0; i < data.length; i++) out.data[i] = i % 4 === 3 ? 255 : level(data[i] ?? 0);
  return out;
}

/** Depths outside the range are grey: they are not used. Holes stay clear, so that the hatching behind shows. */
function depth(map: CheckFrame["depth"], range: readonly [number, number] | undefined): ImageData {
  const { width, height } = map;
  const metres = metresOf(map).map((z) => (z > 0 && z < 1e12 ? z : NaN));
  const raster = { left: 0, top: 0, width, height, stride: 1, channels: 1 as const, data: metres };
  const image = paintScalar(raster, automaticRange(raster) ?? { min: 0, max: 1 }, "viridis");
  if (range) {
    for (let i = 0; i < metres.length; i++) {
      const z = metres[i] ?? NaN;
      if (Number.isNaN(z) || (z >= range[0] && z <= range[1])) continue;
      image.data.set([128, 128, 128, 90], 4 * i);
    }
  }
  return image;
}

export function picture(reading: RigReading, range?: readonly [number, number], width?: number): Promise<ImageBitmap> {
  const made = pixels(reading, range);
  return createImageBitmap(
    made,
    width !== undefined && width < made.width ? { resizeWidth: width, resizeQuality: "medium" } : {},
  );
}

function pixels(reading: RigReading, range: readonly [number, number] | undefined): ImageData {
  switch (reading.kind) {
    case "colour":
      return colour(reading.image);
    case "depth":
      return depth(reading.depth, range);
    case "mask": {
      const { width, height, data } = reading.mask;
      const out = new ImageData(width, height);
      for (let i = 0; i < data.length; i++) out.data.set(data[i] ? [255, 255, 255, 255] : [0, 0, 0, 255], 4 * i);
      return out;
    }
    default:
      throw new Error(`${reading.name} is not an image.`);
  }
}
