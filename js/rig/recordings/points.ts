/** sensor_msgs/PointCloud2: organised clouds, whose rows and columns are those of their camera. */
import { badFile } from "../../errors.js";
import { checkBytes, checkSize } from "../formats/limits.js";
import type { Cloud } from "../formats/picture.js";
import { type Message, bytesIn, isMessage, numberIn, textIn } from "./messages.js";

/** PointField's numbers of its types: float32 and float64. */
const [FLOAT32, FLOAT64] = [7, 8];

interface Axis {
  offset: number;
  isDouble: boolean;
}

function axisOf(fields: readonly Message[], name: string): Axis {
  const field = fields.find((each) => textIn(each, "name") === name);
  const type = field ? numberIn(field, "datatype") : NaN;
  if (!field || (type !== FLOAT32 && type !== FLOAT64))
    throw badFile(`its clouds have no member ${name} of floats; x, y and z are needed`);
  return { offset: numberIn(field, "offset"), isDouble: type === FLOAT64 };
}

export function cloudOf(message: Message): Cloud {
  const [width, height] = [numberIn(message, "width"), numberIn(message, "height")];
  if (height === 1)
    throw badFile(
      `its clouds have ${width} points without rows and columns (unorganised), so that no neighbours are known; record the depth image or an organised cloud`,
    );
  checkSize(width, height);
  const fields = Array.isArray(message.fields) ? message.fields.filter(isMessage) : [];
  const axes = ["x", "y", "z"].map((name) => axisOf(fields, name));
  const [step, row, data] = [numberIn(message, "point_step"), numberIn(message, "row_step"), bytesIn(message, "data")];
  const isLittle = numberIn(message, "is_bigendian") !== 1;
  const stride = row >= step * width ? row : step * width;
  checkBytes((height - 1) * stride + width * step, data.length, "its cloud");
  if (axes.some(({ offset, isDouble }) => !(offset >= 0 && offset + (isDouble ? 8 : 4) <= step)))
    throw badFile("its clouds are damaged: their members lie beyond a point's bytes");
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const points = new Float32Array(3 * width * height);
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const at = y * stride + x * step;
      const to = 3 * (y * width + x);
      axes.forEach(({ offset, isDouble }, axis) => {
        points[to + axis] = isDouble ? view.getFloat64(at + offset, isLittle) : view.getFloat32(at + offset, isLittle);
      });
    }
  return { format: "PointCloud2", width, height, points, notes: [], warnings: [] };
}
