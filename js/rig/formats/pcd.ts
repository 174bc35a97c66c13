/** PCD of the point cloud library, organised or not: ASCII, binary, and binary_compressed (LZF, field after field). */
import { badFile } from "../../errors.js";
import type { Scan } from "../lidar/scan.js";
import { FEWEST_POINTS, channelOf, roomFor } from "./channels.js";
import { checkGrid, checkPoints, isImage, sizeOfCount } from "./grid.js";
import { checkBytes } from "./limits.js";
import type { Cloud, Points } from "./picture.js";
import { Words } from "./tokens.js";
import type { ReaderWarning } from "../warnings.js";

interface Field {
  name: string;
  size: number;
  type: string;
  count: number;
  /** Number of bytes before the field in a point. */
  offset: number;
}

interface Header {
  fields: Field[];
  /** Number of bytes of a point. */
  stride: number;
  width: number;
  height: number;
  points: number;
  data: string;
  end: number;
}

const MOST_LINES = 100;
const MOST_FIELDS = 64;
const MOST_STRIDE = 4096;

function header(bytes: Uint8Array): Header {
  const words = new Words(bytes);
  const entries = new Map<string, string[]>();
  for (let number = 0; !entries.has("DATA"); number++) {
    const line = words.line();
    if (line === undefined || number > MOST_LINES) throw badFile("this PCD is cut off: its header has no DATA");
    const [key = "", ...rest] = line.trim().split(/\s+/);
    if (key !== "" && !key.startsWith("#")) entries.set(key, rest);
  }
  const one = (key: string): number => {
    const text = entries.get(key)?.[0] ?? "";
    if (!/^\d{1,9}$/.test(text)) throw badFile(`this PCD has the invalid ${key} ${JSON.stringify(text.slice(0, 20))}`);
    return Number(text);
  };
  const fields = fieldsOf(entries);
  const stride = fields.reduce((sum, { size, count }) => sum + size * count, 0);
  if (stride > MOST_STRIDE) throw badFile(`this PCD has points of ${stride} bytes; up to ${MOST_STRIDE} are supported`);
  const [width, height] = [one("WIDTH"), one("HEIGHT")];
  const points = entries.has("POINTS") ? one("POINTS") : width * height;
  if (points !== width * height)
    throw badFile(`this PCD declares ${points} points in ${width}x${height} rows and columns`);
  return { fields, stride, width, height, points, data: entries.get("DATA")?.[0] ?? "", end: words.at };
}

function fieldsOf(entries: Map<string, string[]>): Field[] {
  const names = entries.get("FIELDS") ?? entries.get("COLUMNS") ?? [];
  const [sizes = [], types = []] = [entries.get("SIZE"), entries.get("TYPE")];
  const counts = entries.get("COUNT") ?? names.map(() => "1");
  if (names.length === 0 || names.length > MOST_FIELDS)
    throw badFile(`this PCD has ${names.length} fields; 1 to ${MOST_FIELDS} are supported`);
  if (sizes.length !== names.length || types.length !== names.length || counts.length !== names.length)
    throw badFile("this PCD does not give size, type and count of every field");
  let offset = 0;
  return names.map((name, index) => {
    const [size, count, type] = [Number(sizes[index]), Number(counts[index]), types[index] ?? ""];
    if (![1, 2, 4, 8].includes(size) || !Number.isInteger(count) || count < 0 || count > MOST_STRIDE)
      throw badFile(
        `this PCD has the field ${name.slice(0, 20)} with the invalid size ${sizes[index]} or count ${counts[index]}`,
      );
    const field = { name, size, type, count, offset };
    offset += size * count;
    return field;
  });
}

function axesOf({ fields }: Header): Field[] {
  return ["x", "y", "z"].map((axis) => {
    const field = fields.find(({ name }) => name === axis);
    if (field?.type !== "F" || field.count !== 1 || field.size < 4)
      throw badFile(`this PCD has no floating-point field ${axis}`);
    return field;
  });
}

/** LZF: runs of literals, and references up to 8 kB back. */
function lzf(bytes: Uint8Array, length: number): Uint8Array {
  const out = new Uint8Array(length);
  const damaged = () => badFile("this PCD is damaged or cut off in its compressed points");
  let made = 0;
  for (let at = 0; at < bytes.length; ) {
    const head = bytes[at++] ?? 0;
    if (head < 32) {
      if (at + head + 1 > bytes.length || made + head + 1 > length) throw damaged();
      out.set(bytes.subarray(at, at + head + 1), made);
      at += head + 1;
      made += head + 1;
      continue;
    }
    let count = head >> 5;
    if (count === 7) count += bytes[at++] ?? 0;
    let from = made - ((head & 31) << 8) - (bytes[at++] ?? 0) - 1;
    if (from < 0 || at > bytes.length || made + count + 2 > length) throw damaged();
    for (let left = count + 2; left > 0; left--) out[made++] = out[from++] ?? 0;
  }
  if (made !== length) throw damaged();
  return out;
}

type Read = (view: DataView, at: number) => number;
const READS: Record<string, Read> = {
  F4: (view, at) => view.getFloat32(at, true),
  F8: (view, at) => view.getFloat64(at, true),
  U1: (view, at) => view.getUint8(at),
  U2: (view, at) => view.getUint16(at, true),
  U4: (view, at) => view.getUint32(at, true),
  U8: (view, at) => Number(view.getBigUint64(at, true)),
  I1: (view, at) => view.getInt8(at),
  I2: (view, at) => view.getInt16(at, true),
  I4: (view, at) => view.getInt32(at, true),
  I8: (view, at) => Number(view.getBigInt64(at, true)),
};

/** The places of a field's values: `first`, and then every `step` places. */
interface Target {
  field: Field;
  into: Float32Array | Float64Array;
  first: number;
  step: number;
}

/** A scan without values, and the fields whose values fill it. */
function targetsOf(head: Header): { scan: Scan; targets: Target[] } {
  const others = head.fields.filter(({ name, count }) => count === 1 && channelOf(name) !== undefined);
  const room = roomFor(
    head.points,
    others.map(({ name }) => channelOf(name)),
  );
  const scan: Scan = { points: new Float32Array(3 * head.points), ...room };
  const targets: Target[] = axesOf(head).map((field, axis) => ({ field, into: scan.points, first: axis, step: 3 }));
  for (const field of others) {
    const channel = channelOf(field.name);
    const into = channel && scan[channel];
    if (into && !targets.some((each) => each.into === into)) targets.push({ field, into, first: 0, step: 1 });
  }
  return { scan, targets };
}

function ofBinary(body: Uint8Array, head: Header, isApart: boolean): Scan {
  const { points, stride } = head;
  checkBytes(points * stride, body.length, "this PCD");
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const { scan, targets } = targetsOf(head);
  for (const { field, into, first, step } of targets) {
    const { type, size, offset, name } = field;
    const read = READS[`${type}${size}`];
    if (read === undefined)
      throw badFile(`this PCD has ${name.slice(0, 20)} of the unsupported type ${type.slice(0, 5)}${size}`);
    const [from, by] = isApart ? [offset * points, size] : [offset, stride];
    for (let point = 0; point < points; point++) into[step * point + first] = read(view, from + point * by);
  }
  return scan;
}

function ofText(body: Uint8Array, head: Header): Scan {
  const words = new Words(body);
  const perPoint = head.fields.reduce((sum, { count }) => sum + count, 0);
  checkBytes(2 * head.points * perPoint - 1, body.length, "this PCD");
  const { scan, targets } = targetsOf(head);
  const places: (Target | undefined)[] = [];
  for (const field of head.fields)
    for (let each = 0; each < field.count; each++) places.push(targets.find((target) => target.field === field));
  for (let point = 0; point < head.points; point++) {
    for (const target of places) {
      const word = words.next();
      if (word === "") throw badFile(`this PCD is cut off: ${point} of ${head.points} points`);
      if (target === undefined) continue;
      const value = /^[-+]?(?:nan|inf)/i.test(word) ? NaN : Number(word);
      if (Number.isNaN(value) && !/nan|inf/i.test(word))
        throw badFile(`this PCD has ${JSON.stringify(word.slice(0, 20))} where a number is needed`);
      target.into[target.step * point + target.first] = value;
    }
  }
  return scan;
}

function scanOf(body: Uint8Array, head: Header): Scan {
  if (head.data === "ascii") return ofText(body, head);
  if (head.data === "binary") return ofBinary(body, head, false);
  if (head.data !== "binary_compressed")
    throw badFile(
      `this PCD has DATA ${JSON.stringify(head.data.slice(0, 20))}; ascii, binary and binary_compressed are supported`,
    );
  checkBytes(8, body.length, "this PCD");
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  const [packed, length] = [view.getUint32(0, true), view.getUint32(4, true)];
  if (length !== head.points * head.stride)
    throw badFile(`this PCD declares ${length} bytes of points, but ${head.points * head.stride} are needed`);
  checkBytes(8 + packed, body.length, "this PCD");
  return ofBinary(lzf(body.subarray(8, 8 + packed), length), head, true);
}

/** Largest number of bytes of uncompressed points; a short file may declare any number. */
const MOST_BYTES = 2 ** 28;

export function readPcd(bytes: Uint8Array): Cloud | Points {
  const head = header(bytes);
  checkPoints(head.points);
  if (head.points * head.stride > MOST_BYTES)
    throw badFile(`this PCD declares ${head.points * head.stride} bytes of points, which is too large`);
  const warnings: ReaderWarning[] = [];
  const isLidar = head.fields.some(({ name }) => channelOf(name) === "ring");
  const isFlat = head.height === 1 || head.width === 1;
  if (isFlat && head.points >= FEWEST_POINTS && (isLidar || !isImage(head.points))) {
    const scan = scanOf(bytes.subarray(head.end), head);
    return { format: "PCD", scan, isMetric: isLidar || scan.intensity !== undefined, notes: [], warnings };
  }
  const size = head.height === 1 ? sizeOfCount(head.points, warnings) : { width: head.width, height: head.height };
  checkGrid(size.width, size.height, head.points);
  const { points, intensity } = scanOf(bytes.subarray(head.end), head);
  return { format: "PCD", ...size, points, ...(intensity && { intensity }), notes: [], warnings };
}
