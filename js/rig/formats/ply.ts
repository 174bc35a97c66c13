/** PLY of points, as text or binary: organised (Stanford's range grids, or a size in a comment) or unorganised. */
import { badFile } from "../../errors.js";
import type { Scan } from "../lidar/scan.js";
import { FEWEST_POINTS, channelOf, roomFor } from "./channels.js";
import { checkGrid, checkPoints, isImage, sizeOfCount } from "./grid.js";
import { checkBytes } from "./limits.js";
import type { Cloud, Points } from "./picture.js";
import { Words } from "./tokens.js";
import { type ReaderWarning, warning } from "../warnings.js";

type Read = (view: DataView, at: number, little: boolean) => number;
const TYPES: Record<string, { size: number; read: Read }> = {};
for (const [names, size, read] of [
  ["char int8", 1, (view, at) => view.getInt8(at)],
  ["uchar uint8", 1, (view, at) => view.getUint8(at)],
  ["short int16", 2, (view, at, little) => view.getInt16(at, little)],
  ["ushort uint16", 2, (view, at, little) => view.getUint16(at, little)],
  ["int int32", 4, (view, at, little) => view.getInt32(at, little)],
  ["uint uint32", 4, (view, at, little) => view.getUint32(at, little)],
  ["float float32", 4, (view, at, little) => view.getFloat32(at, little)],
  ["double float64", 8, (view, at, little) => view.getFloat64(at, little)],
] as [string, number, Read][]) {
  for (const name of names.split(" ")) TYPES[name] = { size, read };
}
const typeOf = (name = "") => {
  const type = Object.hasOwn(TYPES, name) ? TYPES[name] : undefined;
  if (type === undefined) throw badFile(`this PLY has a property of the unknown type "${name.slice(0, 20)}"`);
  return type;
};

interface Property {
  name: string;
  size: number;
  read: Read;
  /** For a list, the type of its length. */
  count?: { size: number; read: Read };
}

interface Element {
  name: string;
  count: number;
  properties: Property[];
}

interface Header {
  format: string;
  elements: Element[];
  columns?: number;
  rows?: number;
  end: number;
}

const MOST_LINES = 500;

function header(bytes: Uint8Array): Header {
  const words = new Words(bytes);
  const found: Header = { format: "", elements: [], end: 0 };
  for (let number = 0; ; number++) {
    const line = words.line();
    if (line === undefined || number > MOST_LINES) throw badFile("this PLY is cut off: its header has no end");
    const [key, ...rest] = line.trim().split(/\s+/);
    if (key === "end_header") break;
    if (key === "format") found.format = rest[0] ?? "";
    if (key === "element") found.elements.push({ name: rest[0] ?? "", count: countOf(rest[1]), properties: [] });
    if (key === "property") property(found.elements.at(-1), rest);
    if (key === "obj_info" || key === "comment") {
      const columns = /\b(?:num_cols|width)\s*[:=]?\s*(\d{1,6})\b/i.exec(line)?.[1];
      const rows = /\b(?:num_rows|height)\s*[:=]?\s*(\d{1,6})\b/i.exec(line)?.[1];
      if (columns !== undefined) found.columns = Number(columns);
      if (rows !== undefined) found.rows = Number(rows);
    }
  }
  found.end = words.at;
  return found;
}

function countOf(text = ""): number {
  if (!/^\d{1,9}$/.test(text))
    throw badFile(`this PLY has an element with the invalid count ${JSON.stringify(text.slice(0, 20))}`);
  return Number(text);
}

function property(element: Element | undefined, [type, ...rest]: string[]): void {
  if (element === undefined) throw badFile("this PLY has a property before its first element");
  if (type === "list") element.properties.push({ name: rest[2] ?? "", ...typeOf(rest[1]), count: typeOf(rest[0]) });
  else element.properties.push({ name: rest[0] ?? "", ...typeOf(type) });
  if (element.properties.length > 100) throw badFile("this PLY has more than 100 properties");
}

/** Reads one number after the other. */
interface Source {
  next(type: { size: number; read: Read }): number;
}

class TextSource implements Source {
  readonly #words: Words;
  constructor(bytes: Uint8Array) {
    this.#words = new Words(bytes);
  }
  next(): number {
    const word = this.#words.next();
    if (word === "") throw badFile("this PLY is cut off: it has fewer numbers than it declares");
    const value = /^[-+]?(?:nan|inf)/i.test(word) ? NaN : Number(word);
    if (Number.isNaN(value) && !/nan|inf/i.test(word))
      throw badFile(`this PLY has ${JSON.stringify(word.slice(0, 20))} where a number is needed`);
    return value;
  }
}

class BinarySource implements Source {
  #at = 0;
  readonly #view: DataView;
  readonly #little: boolean;
  constructor(bytes: Uint8Array, little: boolean) {
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.#little = little;
  }
  next({ size, read }: { size: number; read: Read }): number {
    checkBytes(this.#at + size, this.#view.byteLength, "this PLY");
    const value = read(this.#view, this.#at, this.#little);
    this.#at += size;
    return value;
  }
}

/** Longest list of a mesh's faces or a grid's cell. */
const MOST_LIST = 1000;

function listOf(source: Source, property: Property): number[] {
  const count = property.count ? source.next(property.count) : 1;
  if (!(count >= 0 && count <= MOST_LIST)) throw badFile(`this PLY has a list of the invalid length ${count}`);
  return Array.from({ length: count }, () => source.next(property));
}

function scanOf(source: Source, { count, properties }: Element): Scan {
  const axes = ["x", "y", "z"].map((axis) =>
    properties.findIndex(({ name, count: list }) => name === axis && list === undefined),
  );
  if (axes.includes(-1)) throw badFile("this PLY has no x, y and z");
  if (properties.some((each) => each.count))
    throw badFile("this PLY has lists in its vertices, which is not supported");
  const channels = properties.map(({ name }) => channelOf(name));
  const scan: Scan = { points: new Float32Array(3 * count), ...roomFor(count, channels) };
  const places = properties.map((_, index) => axes.indexOf(index));
  const others = channels.map((channel) => channel && scan[channel]);
  for (let at = 0; at < scan.points.length; at += 3) {
    for (let index = 0; index < properties.length; index++) {
      const value = source.next(properties[index] as Property);
      const axis = places[index] ?? -1;
      if (axis >= 0) scan.points[at + axis] = value;
      const other = others[index];
      if (other) other[at / 3] = value;
    }
  }
  return scan;
}

/** The points in the cells of a grid. Each cell holds the index of its point, or no index. */
function inCells(
  source: Source,
  grid: Element,
  { points: cloud, intensity }: Scan,
): Pick<Cloud, "points" | "intensity"> {
  const points = new Float32Array(3 * grid.count).fill(NaN);
  const strength = intensity && new Float32Array(grid.count).fill(NaN);
  for (let cell = 0; cell < grid.count; cell++) {
    for (const each of grid.properties) {
      const [point] = listOf(source, each);
      if (each.name !== "vertex_indices" || point === undefined) continue;
      if (!(Number.isInteger(point) && point >= 0 && 3 * point < cloud.length))
        throw badFile(`this PLY's grid refers to point ${point} of ${cloud.length / 3}`);
      points.set(cloud.subarray(3 * point, 3 * point + 3), 3 * cell);
      if (strength) strength[cell] = intensity?.[point] ?? NaN;
    }
  }
  return { points, ...(strength && { intensity: strength }) };
}

export function readPly(bytes: Uint8Array): Cloud | Points {
  const { format, elements, columns, rows, end } = header(bytes);
  if (!["ascii", "binary_little_endian", "binary_big_endian"].includes(format))
    throw badFile(`this PLY has the unknown format "${format.slice(0, 30)}"`);
  const [vertices, ...others] = elements;
  if (vertices?.name !== "vertex") throw badFile("this PLY does not begin with its vertices");
  checkPoints(vertices.count);
  const warnings: ReaderWarning[] = [];
  const grid = others[0]?.name === "range_grid" ? others[0] : undefined;
  const body = bytes.subarray(end);
  // Smallest number of bytes of a number as text: a digit and a space.
  const least =
    vertices.count * vertices.properties.reduce((sum, { size }) => sum + (format === "ascii" ? 2 : size), 0) - 1;
  checkBytes(least, body.length, "this PLY");
  if (grid) {
    checkPoints(grid.count);
    checkGrid(columns ?? 0, rows ?? 0, grid.count);
    checkBytes(grid.count, body.length - least, "this PLY's grid");
  }
  const source = format === "ascii" ? new TextSource(body) : new BinarySource(body, format === "binary_little_endian");
  const scan = scanOf(source, vertices);
  const cloud = { points: scan.points, ...(scan.intensity && { intensity: scan.intensity }) };
  if (grid)
    return {
      format: "PLY",
      width: columns ?? 0,
      height: rows ?? 0,
      ...inCells(source, grid, scan),
      notes: [],
      warnings,
    };
  if (others.some(({ name, count }) => name === "face" && count > 0))
    warnings.push(warning("mesh-faces-ignored", "The file is a mesh; only its vertices are read."));
  if (columns !== undefined && rows !== undefined && columns * rows === vertices.count) {
    checkGrid(columns, rows, vertices.count);
    return { format: "PLY", width: columns, height: rows, ...cloud, notes: [], warnings };
  }
  if (vertices.count >= FEWEST_POINTS && (scan.ring || !isImage(vertices.count)))
    return { format: "PLY", scan, isMetric: scan.ring !== undefined, notes: [], warnings };
  return { format: "PLY", ...sizeOfCount(vertices.count, warnings), ...cloud, notes: [], warnings };
}
