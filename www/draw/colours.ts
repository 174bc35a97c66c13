/** From numbers to pixels: three ways to paint a raster, and nothing else. */

import type { Picture, Raster } from "../engine/protocol";

export interface Range {
  min: number;
  max: number;
}

export type MapName = "viridis" | "magma";

/** Coefficients of sixth-degree fits to the matplotlib colour maps (Matt Zucker, public domain), one row for each power. */
const fits: Record<MapName, readonly (readonly [number, number, number])[]> = {
  viridis: [
    [0.2777273, 0.0054073, 0.3340998],
    [0.105093, 1.4046135, 1.3845902],
    [-0.3308618, 0.2148476, 0.0950952],
    [-4.6342305, -5.799101, -19.332441],
    [6.2282699, 14.1799334, 56.6905526],
    [4.776385, -13.7451454, -65.3530326],
    [-5.4354559, 4.6458526, 26.3124352],
  ],
  magma: [
    [-0.0021365, -0.0007497, -0.0053861],
    [0.2516605, 0.6775232, 2.4940266],
    [8.3537173, -3.5777195, 0.314468],
    [-27.6687331, 14.2647308, -13.6492132],
    [52.1761398, -27.9436061, 12.9441694],
    [-50.7685254, 29.0465828, 4.234153],
    [18.6557051, -11.4897735, -5.6019615],
  ],
};

const toByte = (value: number): number => Math.max(0, Math.min(255, Math.round(255 * value)));

function tabulate(fit: (typeof fits)[MapName]): Uint8ClampedArray {
  const table = new Uint8ClampedArray(3 * 256);
  for (let i = 0; i < 256; i++) {
    for (let c = 0; c < 3; c++) {
      table[3 * i + c] = toByte(fit.reduceRight((sum, row) => sum * (i / 255) + (row[c] ?? 0), 0));
    }
  }
  return table;
}

const tables: Record<MapName, Uint8ClampedArray> = { viridis: tabulate(fits.viridis), magma: tabulate(fits.magma) };

/** The map's colour at a share of its way, in bytes. */
export function colourAt(map: MapName, share: number): [number, number, number] {
  const at = 3 * Math.max(0, Math.min(255, Math.round(255 * share)));
  const table = tables[map];
  return [table[at] ?? 0, table[at + 1] ?? 0, table[at + 2] ?? 0];
}

/** The map as a CSS gradient, for legends. */
export function gradient(map: MapName): string {
  const table = tables[map];
  const stops = Array.from({ length: 9 }, (_, i) => {
    const at = 3 * Math.round((i * 255) / 8);
    return `rgb(${table[at]} ${table[at + 1]} ${table[at + 2]})`;
  });
  return `linear-gradient(to right, ${stops.join(", ")})`;
}

/** Values outside the range take its end colours; NaN stays clear, so that the hatching behind shows. */
export function paintScalar(raster: Raster, { min, max }: Range, map: MapName): ImageData {
  const table = tables[map];
  const factor = max > min ? 255 / (max - min) : 0;
  return paint(raster, (data, i, out) => {
    const value = data[i] ?? NaN;
    if (Number.isNaN(value)) return false;
    const at = 3 * Math.max(0, Math.min(255, Math.round((value - min) * factor)));
    out[4 * i] = table[at] ?? 0;
    out[4 * i + 1] = table[at + 1] ?? 0;
    out[4 * i + 2] = table[at + 2] ?? 0;
    return true;
  });
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

function paint(raster: Raster, pixel: (data: Float32Array, i: number, out: Uint8ClampedArray) => boolean): ImageData {
  const image = new ImageData(raster.width, raster.height);
  const out = image.data;
  for (let i = 0; i < raster.width * raster.height; i++) {
    if (pixel(raster.data, i, out)) out[4 * i + 3] = 255;
  }
  return image;
}

/** Most values looked at for an automatic range. */
const SAMPLES = 4096;

/** The range of the middle 98 % of the finite values: single outliers must not flatten everything else. */
export function automaticRange(raster: Raster): Range | undefined {
  const every = Math.max(1, Math.floor(raster.data.length / SAMPLES));
  const finite: number[] = [];
  for (let i = 0; i < raster.data.length; i += every) {
    const value = raster.data[i] ?? NaN;
    if (Number.isFinite(value)) finite.push(value);
  }
  if (finite.length === 0) return undefined;
  finite.sort((a, b) => a - b);
  const at = (share: number) => finite[Math.round(share * (finite.length - 1))] ?? 0;
  return { min: at(0.01), max: at(0.99) };
}
