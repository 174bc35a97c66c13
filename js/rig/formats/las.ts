/**
 * LAS 1.0 to 1.4 of the ASPRS: points as scaled integers, metres, with the intensity and the time of each pulse; and LAZ, its compressed form.
 *
 * LAS is parsed here, because it is only a header and records of one size. laz.ts unpacks LAZ.
 */
import { badFile } from "../../errors.js";
import { roomFor } from "./channels.js";
import { checkPoints } from "./grid.js";
import { checkBytes } from "./limits.js";
import type { Points } from "./picture.js";

/** Bytes of the shortest header, and of the header of LAS 1.4. */
const HEADER = 227;
const HEADER_14 = 375;
/** Smallest number of bytes of a point in each format, and the offset of its GPS time. */
const FORMATS: [bytes: number, time: number | undefined][] = [
  [20, undefined],
  [28, 20],
  [26, undefined],
  [34, 20],
  [57, 20],
  [63, 20],
  [30, 22],
  [36, 22],
  [38, 22],
  [59, 22],
  [67, 22],
];
/** Point formats with wave packets. */
const WAVES = [4, 5, 9, 10];
/** Bit of the format that marks compressed points. */
const COMPRESSED = 0x80;
const INTENSITY = 12;
/**
 * Smallest number of compressed bytes per point. The noise of a real point alone takes several bytes. Without this limit, a small file
 * could declare millions of copies of one point.
 */
const FEWEST_BYTES = 0.25;
/** Share of the points that may lie outside the box that the header declares. */
const OUTSIDE = 0.01;

interface Header {
  isPacked: boolean;
  format: number;
  count: number;
  /** Bytes of a record, and the offset of the first one. */
  size: number;
  from: number;
  /** Offset of the time in a record. */
  time: number | undefined;
  /** A coordinate is an integer times its scale plus its offset; by axis. */
  scale: number[];
  offset: number[];
  /** The largest and the smallest coordinate along each axis. */
  box: [most: number, least: number][];
}

function headerOf(view: DataView): Header {
  const stored = view.getUint8(104);
  const isPacked = stored >= COMPRESSED;
  const format = isPacked ? stored - COMPRESSED : stored;
  const [least, time] = FORMATS[format] ?? [];
  const size = view.getUint16(105, true);
  if (least === undefined || size < least)
    throw badFile(`this LAS has points of the unsupported format ${format}, ${size} bytes each`);
  const isLong = view.getUint8(25) >= 4 && view.getUint16(94, true) >= HEADER_14;
  if (isLong) checkBytes(HEADER_14, view.byteLength, "this LAS");
  const count = Number((isLong && view.getBigUint64(247, true)) || view.getUint32(107, true));
  checkPoints(count);
  const number = (at: number) => view.getFloat64(at, true);
  const [scale, offset] = [131, 155].map((at) => [number(at), number(at + 8), number(at + 16)]) as [number[], number[]];
  const box = [179, 195, 211].map((at) => [number(at), number(at + 8)] as [number, number]);
  return { isPacked, format, count, size, from: view.getUint32(96, true), time, scale, offset, box };
}

type Take = (view: DataView, at: number, point: number) => void;

/** Calls `take` with each record of points that are not compressed. */
function eachPlain(view: DataView, { from, count, size }: Header, take: Take): void {
  checkBytes(from + count * size, view.byteLength, "this LAS");
  for (let point = 0; point < count; point++) take(view, from + point * size, point);
}

async function eachPacked(bytes: Uint8Array, header: Header, take: Take): Promise<void> {
  if (WAVES.includes(header.format))
    throw badFile(
      `its points have wave packets (point format ${header.format}), which are not supported in LAZ; unpack it (pdal translate in.laz out.las)`,
    );
  const { count, from } = header;
  if (bytes.length - from < FEWEST_BYTES * count)
    throw badFile(`this LAZ is cut off: ${bytes.length - from} bytes cannot hold the ${count} points that it declares`);
  const { eachRecord } = await import("./laz.js");
  await eachRecord(bytes, header, take);
}

/** Throws where many points lie outside the header's box, which is the only sign of damage inside compressed points. */
function checkBox(points: Float32Array, { box, scale, count }: Header): void {
  let outside = 0;
  for (let at = 0; at < points.length; at += 3) {
    const isOutside = box.some(([most, least], axis) => {
      const value = points[at + axis] ?? NaN;
      // Tolerance for coordinates that were rounded to an integer and then to 24 bits.
      const slack = Math.abs(scale[axis] ?? 0) + 1e-6 * Math.max(Math.abs(most), Math.abs(least));
      return most > least && !(value >= least - slack && value <= most + slack);
    });
    if (isOutside) outside++;
  }
  if (outside > OUTSIDE * count)
    throw badFile(`this LAZ is damaged: ${outside} of its ${count} points lie outside the bounding box in its header`);
}

export async function readLas(bytes: Uint8Array): Promise<Points> {
  checkBytes(HEADER, bytes.length, "this LAS");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const header = headerOf(view);
  const { isPacked, count, time, scale, offset } = header;
  const scan = {
    points: new Float32Array(3 * count),
    ...roomFor(count, ["intensity", time === undefined ? undefined : "times"]),
  };
  const take: Take = (records, at, point) => {
    for (let axis = 0; axis < 3; axis++)
      scan.points[3 * point + axis] = records.getInt32(at + 4 * axis, true) * (scale[axis] ?? 1) + (offset[axis] ?? 0);
    if (scan.intensity) scan.intensity[point] = records.getUint16(at + INTENSITY, true);
    if (scan.times && time !== undefined) scan.times[point] = records.getFloat64(at + time, true);
  };
  if (isPacked) await eachPacked(bytes, header, take);
  else eachPlain(view, header, take);
  if (isPacked) checkBox(scan.points, header);
  return { format: isPacked ? "LAZ" : "LAS", scan, isMetric: true, notes: [], warnings: [] };
}
