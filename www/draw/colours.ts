/** From numbers to pixels, for views without a layer in `Estimator.draw`: inputs, colours, errors, the lessons' own fields. */

import type { Picture, Range, Raster } from "../engine/protocol";

export type MapName = "viridis" | "magma";

/** Every fifteenth of the 256 colours that the library uses (matplotlib's maps); linear interpolation in between is accurate to five levels. */
const STOPS: Record<MapName, readonly string[]> = {
  viridis:
    "440154 481769 472a7a 433d84 3d4e8a 355e8d 2e6d8e 297b8e 23898e 1f978b 21a585 2eb37c 46c06f 65cb5e 89d548 b0dd2f d8e219 fde725".split(
      " ",
    ),
  magma:
    "000004 090720 1a1042 311165 4a1079 621980 792282 912b81 aa337d c23b75 d9466b ec5860 f7725c fc8e64 feaa74 fec68a fde2a3 fcfdbf".split(
      " ",
    ),
};
const BETWEEN = 15;

function tabulate(stops: readonly string[]): Uint8ClampedArray {
  const known = stops.map((stop) => [1, 2, 3].map((c) => parseInt(stop.slice(2 * c - 2, 2 * c), 16)));
  return Uint8ClampedArray.from({ length: 3 * 256 }, (_, at) => {
    const [i, c] = [Math.floor(at / 3), at % 3];
    const from = known[Math.floor(i / BETWEEN)]?.[c] ?? 0;
    const to = known[Math.ceil(i / BETWEEN)]?.[c] ?? 0;
    return from + ((i % BETWEEN) / BETWEEN) * (to - from);
  });
}

const tables: Record<MapName, Uint8ClampedArray> = { viridis: tabulate(STOPS.viridis), magma: tabulate(STOPS.magma) };

/** The map's colour at a position from 0 to 1, in bytes. */
export function colourAt(map: MapName, share: number): [number, number, number] {
  const at = 3 * Math.max(0, Math.min(255, Math.round(255 * share)));
  const table = tables[map];
  return [table[at] ?? 0, table[at + 1] ?? 0, table[at + 2] ?? 0];
}

/** The map as a CSS gradient, for legends. */
export const gradient = (map: MapName): string =>
  `linear-gradient(to right, ${STOPS[map].map((stop) => `#${stop}`).join(", ")})`;

/** The colours of a map as whole pixels, in the byte order of all machines that browsers run on. */
const whole = (table: Uint8ClampedArray): Uint32Array =>
  Uint32Array.from(
    { length: 256 },
    (_, i) =>
      ((255 << 24) | ((table[3 * i + 2] ?? 0) << 16) | ((table[3 * i + 1] ?? 0) << 8) | (table[3 * i] ?? 0)) >>> 0,
  );
const pixels: Record<MapName, Uint32Array> = { viridis: whole(tables.viridis), magma: whole(tables.magma) };

/** Values outside the range take its end colours; NaN stays clear, so that the hatching behind shows. */
export function paintScalar({ width, height, data }: Raster, { min, max }: Range, map: MapName): ImageData {
  const table = pixels[map];
  const factor = max > min ? 255 / (max - min) : 0;
  const image = new ImageData(width, height);
  const out = new Uint32Array(image.data.buffer);
  for (let i = 0; i < out.length; i++) {
    const value = data[i] ?? NaN;
    if (!Number.isNaN(value)) out[i] = table[Math.max(0, Math.min(255, Math.round((value - min) * factor)))] ?? 0;
  }
  return image;
}

/** Right is red, up is green, toward the camera is blue; the frame's y points down and its z away. */
export function normalColour(x: number, y: number, z: number): [number, number, number] {
  return [127.5 * (1 + x), 127.5 * (1 - y), 127.5 * (1 - z)];
}

export function paintNormals(raster: Raster): ImageData {
  return paint(raster, (data, i, out) => {
    const x = data[3 * i] ?? NaN;
    if (Number.isNaN(x)) return false;
    const [r, g, b] = normalColour(x, data[3 * i + 1] ?? 0, data[3 * i + 2] ?? 0);
    out[4 * i] = r;
    out[4 * i + 1] = g;
    out[4 * i + 2] = b;
    return true;
  });
}

export function paintPicture(raster: Picture): ImageData {
  const { white, encoded } = raster;
  const encode = (value: number) => 255 * (encoded ? value / white : Math.max(0, value / white) ** (1 / 2.2));
  return paint(raster, (data, i, out) => {
    if (Number.isNaN(data[3 * i])) return false;
    for (let c = 0; c < 3; c++) out[4 * i + c] = encode(data[3 * i + c] ?? 0);
    return true;
  });
}

/** Levels of the table for logarithms, and how far it extends below white: darker colours are black. */
const STEPS = 4096;
const REACH = 14;
const ofLog = Uint8ClampedArray.from(
  { length: STEPS },
  (_, step) => 255 * Math.exp((-REACH * step) / (STEPS - 1) / 2.2),
);

/** Draws logarithms of linear colours; `white` is the logarithm of the white level. */
export function paintLog({ width, height, data }: Raster, white: number): ImageData {
  const factor = (STEPS - 1) / REACH;
  const image = new ImageData(width, height);
  const out = image.data;
  for (let i = 0; 3 * i < data.length; i++) {
    const first = data[3 * i] ?? NaN;
    if (Number.isNaN(first)) continue;
    for (let c = 0; c < 3; c++)
      out[4 * i + c] =
        ofLog[Math.max(0, Math.min(STEPS - 1, Math.round(factor * (white - (data[3 * i + c] ?? 0)))))] ?? 0;
    out[4 * i + 3] = 255;
  }
  return image;
}

function paint(raster: Raster, pixel: (data: Float32Array, i: number, out: Uint8ClampedArray) => boolean): ImageData {
  const image = new ImageData(raster.width, raster.height);
  const out = image.data;
  for (let i = 0; i < raster.width * raster.height; i++) {
    if (pixel(raster.data, i, out)) out[4 * i + 3] = 255;
  }
  return image;
}

/** Largest number of values that are examined for an automatic range. */
const SAMPLES = 4096;

/** A sample of the finite values, sorted. */
export function someSorted(values: Float32Array): Float32Array {
  const every = Math.max(1, Math.floor(values.length / SAMPLES));
  const some = new Float32Array(Math.ceil(values.length / every));
  let count = 0;
  for (let i = 0; i < values.length; i += every) {
    const value = values[i] ?? NaN;
    if (value - value === 0) some[count++] = value;
  }
  return some.subarray(0, count).sort();
}

export const quantile = (sorted: Float32Array, share: number): number | undefined =>
  sorted[Math.round(share * (sorted.length - 1))];

/**
 * The range of the middle 98 % of the finite values, so that single outliers do not flatten the rest. The module uses the same range, but
 * does not report it.
 */
export function automaticRange({ data }: Pick<Raster, "data">): Range | undefined {
  const sorted = someSorted(data);
  const [min, max] = [quantile(sorted, 0.01), quantile(sorted, 0.99)];
  return min === undefined || max === undefined ? undefined : { min, max };
}
