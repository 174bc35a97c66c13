/** sensor_msgs/PointCloud2: organised clouds, which have the rows and columns of their camera, and scans of LiDARs, which lack them. */
import { badFile } from "../../errors.js";
import { type Channel, channelOf, roomFor } from "../formats/channels.js";
import { checkBytes, checkSize } from "../formats/limits.js";
import type { Cloud, Points } from "../formats/picture.js";
import type { Scan } from "../lidar/scan.js";
import { type Message, bytesIn, isMessage, numberIn, textIn } from "./messages.js";

/** Bytes and reader of each of PointField's types, by its number. */
const TYPES: Readonly<
  Record<number, readonly [bytes: number, read: (view: DataView, at: number, isLittle: boolean) => number]>
> = {
  1: [1, (view, at) => view.getInt8(at)],
  2: [1, (view, at) => view.getUint8(at)],
  3: [2, (view, at, isLittle) => view.getInt16(at, isLittle)],
  4: [2, (view, at, isLittle) => view.getUint16(at, isLittle)],
  5: [4, (view, at, isLittle) => view.getInt32(at, isLittle)],
  6: [4, (view, at, isLittle) => view.getUint32(at, isLittle)],
  7: [4, (view, at, isLittle) => view.getFloat32(at, isLittle)],
  8: [8, (view, at, isLittle) => view.getFloat64(at, isLittle)],
};
const FLOATS: readonly number[] = [7, 8];
const CHANNELS: readonly Channel[] = ["ring", "intensity", "times"];

/** Reads one number of a point, given the point's index. */
type Column = (point: number) => number;

/** Whether a message holds a scan, whose points form a single row. */
export const isScan = (message: Message): boolean => numberIn(message, "height") === 1;

/** The readers of a message's fields, found by their names; undefined for a field that it lacks. */
function columnsOf(
  message: Message,
): (isNamed: (name: string) => boolean, types?: readonly number[]) => Column | undefined {
  const [width, height] = [numberIn(message, "width"), numberIn(message, "height")];
  const fields = Array.isArray(message.fields) ? message.fields.filter(isMessage) : [];
  const [step, row, data] = [numberIn(message, "point_step"), numberIn(message, "row_step"), bytesIn(message, "data")];
  const isLittle = numberIn(message, "is_bigendian") !== 1;
  const stride = row >= step * width ? row : step * width;
  checkBytes((height - 1) * stride + width * step, data.length, "its cloud");
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  return (isNamed, types) => {
    const field = fields.find((each) => isNamed(textIn(each, "name")));
    const number = field ? numberIn(field, "datatype") : NaN;
    const type = TYPES[number];
    if (!field || !type || types?.includes(number) === false) return undefined;
    const [offset, [bytes, read]] = [numberIn(field, "offset"), type];
    if (!(offset >= 0 && offset + bytes <= step))
      throw badFile("its clouds are damaged: a field lies beyond the bytes of its point");
    return (point) => read(view, Math.floor(point / width) * stride + (point % width) * step + offset, isLittle);
  };
}

/** x, y and z of every point. */
function placesOf(columns: ReturnType<typeof columnsOf>, count: number): Float32Array {
  const axes = ["x", "y", "z"].map((name) => {
    const column = columns((field) => field === name, FLOATS);
    if (!column) throw badFile(`its clouds have no floating-point field ${name}; x, y and z are needed`);
    return column;
  });
  const points = new Float32Array(3 * count);
  for (let point = 0; point < count; point++)
    axes.forEach((column, axis) => (points[3 * point + axis] = column(point)));
  return points;
}

export function cloudOf(message: Message): Cloud {
  const [width, height] = [numberIn(message, "width"), numberIn(message, "height")];
  checkSize(width, height);
  const columns = columnsOf(message);
  const points = placesOf(columns, width * height);
  const strength = columns((field) => channelOf(field) === "intensity");
  const intensity = strength && Float32Array.from({ length: width * height }, (_, point) => strength(point));
  return { format: "PointCloud2", width, height, points, ...(intensity && { intensity }), notes: [], warnings: [] };
}

/** The points of a LiDAR, with their rings, intensities and times where the driver gives them. */
export function scanOf(message: Message): Points {
  const count = numberIn(message, "width");
  const columns = columnsOf(message);
  const found = CHANNELS.flatMap((channel) => {
    const column = columns((field) => channelOf(field) === channel);
    return column ? [{ channel, column }] : [];
  });
  const room = roomFor(
    count,
    found.map(({ channel }) => channel),
  );
  const scan: Scan = { points: placesOf(columns, count), ...room };
  for (const { channel, column } of found) {
    const into = room[channel];
    if (into) for (let point = 0; point < count; point++) into[point] = column(point);
  }
  return { format: "PointCloud2", scan, isMetric: true, notes: [], warnings: [] };
}
