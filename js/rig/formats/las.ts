/**
 * LAS 1.0 to 1.4 of the ASPRS: points as scaled integers, metres, with the intensity and the time of each pulse.
 *
 * It is parsed here, because it is only a header and records of one size. Limit: LAZ, its compressed form, is refused with advice.
 */
import { badFile } from "../../errors.js";
import { roomFor } from "./channels.js";
import { checkPoints } from "./grid.js";
import { checkBytes } from "./limits.js";
import type { Points } from "./picture.js";

/** Bytes of the shortest header, and of the header of LAS 1.4. */
const HEADER = 227;
const HEADER_14 = 375;
/** Bytes of a point of each format, at least, and the offset of its GPS time. */
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
/** Bit of the format that marks compressed points. */
const COMPRESSED = 0x80;
const INTENSITY = 12;

export function readLas(bytes: Uint8Array): Points {
  checkBytes(HEADER, bytes.length, "this LAS");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const format = view.getUint8(104);
  if (format >= COMPRESSED)
    throw badFile(
      "it is LAZ, a compressed LAS of a LiDAR's points; unpack it (pdal translate in.laz out.las, or CloudCompare)",
    );
  const [least, time] = FORMATS[format] ?? [];
  const size = view.getUint16(105, true);
  if (least === undefined || size < least)
    throw badFile(`this LAS has points of the format ${format} and ${size} bytes each`);
  const isLong = view.getUint8(25) >= 4 && view.getUint16(94, true) >= HEADER_14;
  const count = Number((isLong && view.getBigUint64(247, true)) || view.getUint32(107, true));
  checkPoints(count);
  const from = view.getUint32(96, true);
  checkBytes(from + count * size, bytes.length, "this LAS");
  const number = (at: number) => view.getFloat64(at, true);
  const [scale, offset] = [131, 155].map((at) => [number(at), number(at + 8), number(at + 16)]) as [number[], number[]];
  const scan = {
    points: new Float32Array(3 * count),
    ...roomFor(count, ["intensity", time === undefined ? undefined : "times"]),
  };
  for (let point = 0; point < count; point++) {
    const at = from + point * size;
    for (let axis = 0; axis < 3; axis++)
      scan.points[3 * point + axis] = view.getInt32(at + 4 * axis, true) * (scale[axis] ?? 1) + (offset[axis] ?? 0);
    if (scan.intensity) scan.intensity[point] = view.getUint16(at + INTENSITY, true);
    if (scan.times && time !== undefined) scan.times[point] = number(at + time);
  }
  return { format: "LAS", scan, isMetric: true, notes: [], warnings: [] };
}
