/** sensor_msgs/PointCloud2: organised clouds, whose rows and columns are those of their camera, and the scans of LiDARs, which have none. */
import { badFile } from "../../errors.js";
import { checkBytes, checkSize } from "../formats/limits.js";
import type { Cloud, Points } from "../formats/picture.js";
import type { Scan } from "../lidar/scan.js";
import { type Message, bytesIn, isMessage, numberIn, textIn } from "./messages.js";

/** How each of PointField's types is read, and its bytes, by its number. */
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
/** Names of what a scan's points have besides their places. */
const RING = /^(?:ring|channel|laser_id|line)$/;
const INTENSITY = /^(?:intensity|i|reflectivity)$/;
const TIME = /^(?:t|time|timestamp|offset_time|time_stamp)$/;

/** A number of each point, in their order. */
type Column = (point: number) => number;

/** Whether a message holds the points of a scan, in one row. */
export const isScan = (message: Message): boolean => numberIn(message, "height") === 1;

/** Reads members of the points of a message; nothing for one that it lacks. */
function columnsOf(message: Message): (name: RegExp, types?: readonly number[]) => Column | undefined {
  const [width, height] = [numberIn(message, "width"), numberIn(message, "height")];
  const fields = Array.isArray(message.fields) ? message.fields.filter(isMessage) : [];
  const [step, row, data] = [numberIn(message, "point_step"), numberIn(message, "row_step"), bytesIn(message, "data")];
  const isLittle = numberIn(message, "is_bigendian") !== 1;
  const stride = row >= step * width ? row : step * width;
  checkBytes((height - 1) * stride + width * step, data.length, "its cloud");
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  return (name, types) => {
    const field = fields.find((each) => name.test(textIn(each, "name")));
    const number = field ? numberIn(field, "datatype") : NaN;
    const type = TYPES[number];
    if (!field || !type || types?.includes(number) === false) return undefined;
    const [offset, [bytes, read]] = [numberIn(field, "offset"), type];
    if (!(offset >= 0 && offset + bytes <= step))
      throw badFile("its clouds are damaged: their members lie beyond a point's bytes");
    return (point) => read(view, Math.floor(point / width) * stride + (point % width) * step + offset, isLittle);
  };
}

/** x, y and z of every point. */
function placesOf(columns: ReturnType<typeof columnsOf>, count: number): Float32Array {
  const axes = ["x", "y", "z"].map((name) => {
    const column = columns(new RegExp(`^${name}$`), FLOATS);
    if (!column) throw badFile(`its clouds have no member ${name} of floats; x, y and z are needed`);
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
  const points = placesOf(columnsOf(message), width * height);
  return { format: "PointCloud2", width, height, points, notes: [], warnings: [] };
}

/** The points of a LiDAR, with their rings, intensities and times where the driver gives them. */
export function scanOf(message: Message): Points {
  const count = numberIn(message, "width");
  const columns = columnsOf(message);
  const points = placesOf(columns, count);
  const listed = (name: RegExp) => {
    const column = columns(name);
    return column && Array.from({ length: count }, (_, point) => column(point));
  };
  const [ring, intensity, times] = [RING, INTENSITY, TIME].map(listed);
  const scan: Scan = {
    points,
    ...(ring && { ring: Float32Array.from(ring) }),
    ...(intensity && { intensity: Float32Array.from(intensity) }),
    ...(times && { times: Float64Array.from(times) }),
  };
  return { format: "PointCloud2", scan, isMetric: true, notes: [], warnings: [] };
}
