/**
 * NumPy's .npy: images, depth maps and clouds of any number type and byte order.
 *
 * Written here because npyjs (1.2) checks neither the length against the shape nor the order of axes, fails on data that
 * are not aligned, and brings a fetch library along.
 */
import { badFile as bad } from "./errors.js";
import { half } from "./half.js";

/** Raster data with its channels interleaved. */
export interface Raster<T> {
  width: number;
  height: number;
  channels: number;
  data: T;
}

type Pixels = Float32Array | Uint16Array | Uint8Array;

const MAGIC = "\x93NUMPY";
/** Smallest length of a file: the magic, two bytes of version, and two or four of header length. */
const SHORTEST = 10;

/** Largest number of channels: red, green, blue and alpha. */
const MOST_CHANNELS = 4;

export const isNpy = (bytes: Uint8Array): boolean => [...MAGIC].every((letter, i) => bytes[i] === letter.charCodeAt(0));

type Whole = Int8Array | Int16Array | Int32Array | Uint32Array | BigInt64Array | BigUint64Array;
/** The elements as they are stored. */
type Stored = Pixels | Float64Array | Whole;

interface Kind {
  /** Bytes of an element. */
  size: number;
  /** `count` elements of aligned memory in this machine's order. */
  read: (memory: ArrayBuffer, count: number) => Stored;
}

const KINDS: Record<string, Kind> = {
  f2: { size: 2, read: (memory, count) => Float32Array.from(new Uint16Array(memory, 0, count), half) },
  f4: { size: 4, read: (memory, count) => new Float32Array(memory, 0, count) },
  f8: { size: 8, read: (memory, count) => new Float64Array(memory, 0, count) },
  i1: { size: 1, read: (memory, count) => new Int8Array(memory, 0, count) },
  i2: { size: 2, read: (memory, count) => new Int16Array(memory, 0, count) },
  i4: { size: 4, read: (memory, count) => new Int32Array(memory, 0, count) },
  i8: { size: 8, read: (memory, count) => new BigInt64Array(memory, 0, count) },
  u1: { size: 1, read: (memory, count) => new Uint8Array(memory, 0, count) },
  u2: { size: 2, read: (memory, count) => new Uint16Array(memory, 0, count) },
  u4: { size: 4, read: (memory, count) => new Uint32Array(memory, 0, count) },
  u8: { size: 8, read: (memory, count) => new BigUint64Array(memory, 0, count) },
  b1: { size: 1, read: (memory, count) => new Uint8Array(memory, 0, count) },
};

/** Converts the types that a raster cannot have to 32-bit floats. */
function pixelsOf(stored: Stored): Pixels {
  if (stored instanceof Uint8Array || stored instanceof Uint16Array || stored instanceof Float32Array) return stored;
  if (stored instanceof BigInt64Array || stored instanceof BigUint64Array) return Float32Array.from(stored, Number);
  return new Float32Array(stored);
}

/** The remedy for a type that is not read. */
function refusal(type: string): string {
  const advice = "save it as float32 or uint16";
  if (/^[<>|=]?O/.test(type))
    return `a .npy file of type "${type}" holds Python objects (a pickle), which may run code; ${advice}`;
  if (type.startsWith("["))
    return `this .npy file is a structured array (${type.slice(0, 80)}); save the field that holds the depth, as float32 or uint16`;
  return `a .npy file of type "${type}" is not supported; ${advice}`;
}

/** Elements of `size` bytes from the other byte order, in place. */
function swap(body: Uint8Array, size: number): void {
  for (let at = 0; at + size <= body.length; at += size) body.subarray(at, at + size).reverse();
}

/** Converts data from column order (the first index runs fastest) to row order. */
function inRows<T extends Pixels | number[]>(data: T, height: number, width: number, channels: number): T {
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

/** Moves channels behind rows and columns; PyTorch has them in front. */
function channelsLast<T extends Pixels>(data: T, channels: number): T {
  const last = data.slice() as T;
  const pixels = data.length / channels;
  for (let channel = 0; channel < channels; channel++)
    for (let at = 0; at < pixels; at++) last[at * channels + channel] = data[channel * pixels + at] ?? 0;
  return last;
}

interface Shape {
  height: number;
  width: number;
  channels: number;
  isChannelFirst: boolean;
}

function axesOf(listed: string): number[] {
  const parts = listed
    .split(",")
    .map((part) => part.trim())
    .filter((part) => part !== "");
  // The pattern accepts only digits, because Number() would also accept "2.5", "-2" and "0x2".
  if (!parts.every((axis) => /^[0-9]+$/.test(axis) && Number(axis) > 0))
    throw bad(`this .npy file has the shape (${listed.trim()}); whole numbers above zero are needed`);
  return parts.map(Number);
}

/** Rows, columns and channels of an array. Axes of length 1 around an image are ignored. */
function shapeOf(all: readonly number[]): Shape {
  const axes = all.slice();
  // Batch and channel of a tensor.
  if (axes.length === 4 && axes[0] === 1 && axes[1] === 1) axes.splice(0, 2);
  while (axes.length > 3 && axes[0] === 1) axes.shift();
  if (axes.length > 3 && axes.at(-1) === 1) axes.pop();
  if (axes.length === 3 && axes[0] === 1 && (axes[2] ?? 0) > MOST_CHANNELS) axes.shift();
  const [first = 0, second = 0, third = 1] = axes;
  if (axes.length === 4)
    throw bad(
      `this .npy file has 4 axes (${axes.join(" x ")}): a stack of pictures. Save each of them as a file: rows and columns, or rows, columns and channels`,
    );
  if (axes.length < 2 || axes.length > 3)
    throw bad(`this .npy file has ${axes.length} axes; rows and columns, or rows, columns and channels are needed`);
  if (third <= MOST_CHANNELS) return { height: first, width: second, channels: third, isChannelFirst: false };
  if (first <= MOST_CHANNELS) return { height: second, width: third, channels: first, isChannelFirst: true };
  throw bad(
    `this .npy file has ${third} channels; 1 to ${MOST_CHANNELS} are supported. If it is a stack of ${first} pictures, save each of them as a file`,
  );
}

interface Header {
  /** NumPy's name of the type, without the order of bytes. */
  type: string;
  kind: Kind;
  isBigEndian: boolean;
  byColumns: boolean;
  axes: number[];
  /** Where the data begin. */
  end: number;
}

function headerOf(bytes: Uint8Array): Header {
  if (bytes.length < SHORTEST) throw bad("this .npy file is cut off in its header");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const short = view.getUint8(6) === 1;
  const from = short ? SHORTEST : SHORTEST + 2;
  const end = from + (short ? view.getUint16(8, true) : bytes.length >= from ? view.getUint32(8, true) : Infinity);
  if (end > bytes.length) throw bad("this .npy file is cut off in its header");
  const header = new TextDecoder("latin1").decode(bytes.subarray(from, end));
  const [, plain, fields] = /'descr': (?:'([^']*)'|(\[.*?\]))/s.exec(header) ?? [];
  const written = plain ?? fields ?? "unknown";
  const [, order = "", type = ""] = /^([<>|=]?)([fiub]\d)$/.exec(written) ?? [];
  const kind = Object.hasOwn(KINDS, type) ? KINDS[type] : undefined;
  if (kind === undefined) throw bad(refusal(written));
  const columns = /'fortran_order': (True|False)/.exec(header)?.[1];
  if (!columns) throw bad("this .npy file has no fortran_order");
  const axes = axesOf(/'shape': \(([^)]*)\)/.exec(header)?.[1] ?? "");
  return { type, kind, isBigEndian: order === ">", byColumns: columns === "True", axes, end };
}

/** Reads this many elements in their stored order. */
function elementsOf(bytes: Uint8Array, { kind, isBigEndian, end }: Header, count: number): Stored {
  // A copy, because typed arrays need aligned memory; the slice of a Node Buffer would be only a view.
  const body = new Uint8Array(bytes.subarray(end));
  if (body.byteLength < count * kind.size)
    throw bad(`this .npy file is cut off: ${body.byteLength} of ${count * kind.size} bytes`);
  if (isBigEndian && kind.size > 1) swap(body, kind.size);
  return kind.read(body.buffer, count);
}

/**
 * The axes of an array. Its values follow row by row if it has at most two axes and at most `most` numbers, as in a calibration.
 */
export function readSmall(bytes: Uint8Array, most: number): { axes: number[]; values?: number[] } {
  const header = headerOf(bytes);
  const axes = header.axes.filter((length, at, all) => length > 1 || all.length <= 2 || at < 1);
  const count = axes.reduce((product, length) => product * length, 1);
  if (axes.length > 2 || count > most) return { axes };
  const [height = 1, width = 1] = axes;
  const values = Array.from<number | bigint, number>(elementsOf(bytes, header, count), Number);
  return { axes, values: header.byColumns ? inRows(values, height, width, 1) : values };
}

/** Whether two or three planes are a stack: a cloud would have negative values, and colours would not exceed 1. */
const isStack = (data: Pixels): boolean =>
  !data.some((value) => value < 0) && data.some((value) => value > 1 && value < Infinity);

/**
 * Reads rows x columns, or rows x columns x channels, in either order; floats of all sizes and whole numbers that may be negative or longer
 * than 16 bits become 32-bit floats.
 */
export function readNpy(bytes: Uint8Array): Raster<Pixels> & { type: string } {
  const header = headerOf(bytes);
  const { type, kind, byColumns } = header;
  const { height, width, channels, isChannelFirst } = shapeOf(header.axes);
  const read = pixelsOf(elementsOf(bytes, header, height * width * channels));
  if (!isChannelFirst)
    return { width, height, channels, type, data: byColumns ? inRows(read, height, width, channels) : read };
  if ((channels === 2 || channels === 3) && kind.size > 1 && isStack(read))
    throw bad(
      `this .npy file has ${channels} planes without a value below zero: a stack of ${channels} pictures? Save each of them as a file`,
    );
  const inOrder = byColumns ? inRows(read, channels, height, width) : read;
  return { width, height, channels, type, data: channelsLast(inOrder, channels) };
}
