/**
 * NumPy's .npy, the few kinds that images and depth maps come in.
 *
 * Written here because npyjs (1.2) checks neither the length against the shape nor the order of axes, fails on data that
 * are not aligned, and brings a fetch library along.
 */
import { badFile as bad } from "./errors.js";

/** Raster data with its channels interleaved. */
export interface Raster<T> {
  width: number;
  height: number;
  channels: number;
  data: T;
}

const MAGIC = "\x93NUMPY";
/** Magic, two bytes of version, two or four of header length. */
const SHORTEST = 10;

/** Red, green, blue and alpha. */
const MOST_CHANNELS = 4;

export const isNpy = (bytes: Uint8Array): boolean => [...MAGIC].every((letter, i) => bytes[i] === letter.charCodeAt(0));

/** Bytes for each element, and how `count` of them are read from aligned little-endian memory. */
const KINDS = {
  "<f4": { size: 4, read: (memory: ArrayBuffer, count: number) => new Float32Array(memory, 0, count) },
  "<f8": {
    size: 8,
    read: (memory: ArrayBuffer, count: number) => new Float32Array(new Float64Array(memory, 0, count)),
  },
  "<i4": { size: 4, read: (memory: ArrayBuffer, count: number) => new Float32Array(new Int32Array(memory, 0, count)) },
  "<u2": { size: 2, read: (memory: ArrayBuffer, count: number) => new Uint16Array(memory, 0, count) },
  "|u1": { size: 1, read: (memory: ArrayBuffer, count: number) => new Uint8Array(memory, 0, count) },
  "|b1": { size: 1, read: (memory: ArrayBuffer, count: number) => new Uint8Array(memory, 0, count) },
} as const;

const isKind = (name: string): name is keyof typeof KINDS => Object.hasOwn(KINDS, name);

/** Data in column order (the first index runs fastest) in row order. */
function inRows<T extends Float32Array | Uint16Array | Uint8Array>(
  data: T,
  height: number,
  width: number,
  channels: number,
): T {
  const rows = data.slice() as T;
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      for (let channel = 0; channel < channels; channel++) {
        rows[(row * width + column) * channels + channel] = data[row + height * (column + width * channel)] ?? 0;
      }
    }
  }
  return rows;
}

/** Reads rows x columns, or rows x columns x channels, in either order; 64-bit floats and 32-bit integers become 32-bit floats. */
export function readNpy(bytes: Uint8Array): Raster<Float32Array | Uint16Array | Uint8Array> {
  if (bytes.length < SHORTEST) throw bad("this .npy file is cut off in its header");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const short = view.getUint8(6) === 1;
  const from = short ? SHORTEST : SHORTEST + 2;
  const until = from + (short ? view.getUint16(8, true) : bytes.length >= from ? view.getUint32(8, true) : Infinity);
  if (until > bytes.length) throw bad("this .npy file is cut off in its header");
  const header = new TextDecoder("latin1").decode(bytes.subarray(from, until));

  const kind = /'descr': '([^']*)'/.exec(header)?.[1] ?? "unknown";
  if (!isKind(kind)) {
    throw bad(`a .npy file of type "${kind}" is not read here; save it as float32, float64, uint16, uint8 or int32`);
  }
  const order = /'fortran_order': (True|False)/.exec(header)?.[1];
  if (!order) throw bad("this .npy file has no fortran_order");
  const listed = /'shape': \(([^)]*)\)/.exec(header)?.[1] ?? "";
  const axes = listed
    .split(",")
    .map((part) => part.trim())
    .filter((part) => part !== "");
  if (axes.length < 2 || axes.length > 3) {
    throw bad(`this .npy file has ${axes.length} axes; rows and columns, or rows, columns and channels are needed`);
  }
  // Nothing but digits: Number() would also take "2.5", "-2" and "0x2".
  if (!axes.every((axis) => /^[0-9]+$/.test(axis) && Number(axis) > 0)) {
    throw bad(`this .npy file has the shape (${listed.trim()}); whole numbers above zero are needed`);
  }
  const [height = 0, width = 0, channels = 1] = axes.map(Number);
  if (channels > MOST_CHANNELS)
    throw bad(`this .npy file has ${channels} channels; 1 to ${MOST_CHANNELS} are read here`);
  const count = height * width * channels;
  const { size, read } = KINDS[kind];
  // A copy, because typed arrays want aligned memory; Node's Buffer would not make one by its own slice.
  const body = new Uint8Array(bytes.subarray(until)).buffer;
  if (body.byteLength < count * size)
    throw bad(`this .npy file is cut off: ${body.byteLength} of ${count * size} bytes`);
  const data = read(body, count);
  return { width, height, channels, data: order === "True" ? inRows(data, height, width, channels) : data };
}
