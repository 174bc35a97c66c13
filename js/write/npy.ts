/** NumPy's .npy, version 1: a header that fills whole blocks of 64 bytes, then the numbers, row by row. */
import type { Raster } from "../npy.js";
import { checkRaster } from "./check.js";

/** Kinds of numbers that are written. */
export type NpyData = Float32Array | Float64Array | Uint16Array | Uint8Array;

const BLOCK = 64;
/** Magic, version and the header's length. */
const LEAD = 10;

function kindOf(data: NpyData): string {
  if (data instanceof Float64Array) return "<f8";
  if (data instanceof Float32Array) return "<f4";
  return data instanceof Uint16Array ? "<u2" : "|u1";
}

/** The shape: rows x columns, or rows x columns x channels. */
export function writeNpy(raster: Raster<NpyData>): Uint8Array<ArrayBuffer> {
  checkRaster(raster, "raster", Float32Array, Float64Array, Uint16Array, Uint8Array);
  const { width, height, channels, data } = raster;
  const shape = channels === 1 ? `${height}, ${width}` : `${height}, ${width}, ${channels}`;
  const said = `{'descr': '${kindOf(data)}', 'fortran_order': False, 'shape': (${shape}), }`;
  const total = Math.ceil((LEAD + said.length + 1) / BLOCK) * BLOCK;
  const file = new Uint8Array(total + data.byteLength);
  const view = new DataView(file.buffer);
  const length = total - LEAD;
  file.set([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, length & 255, length >> 8]);
  file.set(new TextEncoder().encode(`${said.padEnd(length - 1, " ")}\n`), LEAD);
  if (data instanceof Float64Array) data.forEach((value, i) => view.setFloat64(total + 8 * i, value, true));
  else if (data instanceof Float32Array) data.forEach((value, i) => view.setFloat32(total + 4 * i, value, true));
  else if (data instanceof Uint16Array) data.forEach((value, i) => view.setUint16(total + 2 * i, value, true));
  else file.set(data, total);
  return file;
}
