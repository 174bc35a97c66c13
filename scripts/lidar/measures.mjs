// The quality of a range image: which visible points of the scan it holds, and how far each lies from its pixel's ray.
import { project } from "../captures/lens.mjs";

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const key = (point) => point.join(" ");

/** Whether a point of the scan projects into the picture. */
function sees({ rotation, translation, camera, width, height }) {
  return (point) => {
    const [x, y, z] = [0, 1, 2].map((row) => dot(rotation.slice(3 * row, 3 * row + 3), point) + translation[row]);
    if (!(z > 0.05)) return false;
    // A lens with so few coefficients folds points far off the axis back into the picture.
    if (Math.abs(camera.fx * (x / z)) > width || Math.abs(camera.fy * (y / z)) > height) return false;
    const [column, row] = project(camera, [x, y, z]);
    return column > -0.5 && column < width - 0.5 && row > -0.5 && row < height - 0.5;
  };
}

/** The pixel of each point in a range image, by the point's coordinates. */
function held({ points, width, height }) {
  const pixels = new Map();
  for (let pixel = 0; pixel < width * height; pixel++) {
    const point = points.subarray(3 * pixel, 3 * pixel + 3);
    if (!Number.isNaN(point[0])) pixels.set(key(point), pixel);
  }
  return pixels;
}

/** A point in the axes of a range image: right, forward, up. */
const within = ({ right, forward, up }, point) => [dot(point, right), dot(point, forward), dot(point, up)];

/** The distance of a point to its pixel's ray, and the spacing of neighbouring rays at that point, metres. */
function atRay(image, pixel, point) {
  const { frame, rows, first, step, width, height } = image;
  const row = Math.floor(pixel / width);
  const { tangent, origin } = rows[row];
  const azimuth = first + ((pixel % width) + 0.5) * step;
  const length = Math.hypot(1, tangent);
  const along = [Math.sin(azimuth) / length, Math.cos(azimuth) / length, tangent / length];
  const [right, forward, up] = within(frame, point);
  const from = [right, forward, up - origin];
  const reach = dot(from, along);
  const distance = Math.hypot(...from.map((value, axis) => value - reach * along[axis]));
  const [above, below] = [Math.max(0, row - 1), Math.min(height - 1, row + 1)];
  const angle = Math.atan(rows[above].tangent) - Math.atan(rows[below].tangent);
  const across = Math.hypot(right, forward) * step;
  const down = (Math.hypot(...from) * angle) / Math.max(1, below - above);
  // The spacing is the side of a square of the pixel's area.
  return { distance, sampling: Math.sqrt(across * Math.max(0, down)), across };
}

/** For a z-buffer: whether the pixel that a point falls into holds a point of the same surface or one in front of it. */
function stands(image, point) {
  const { frame, rows, first, step, width, height, points } = image;
  const [right, forward, up] = within(frame, point);
  const column = Math.min(width - 1, Math.max(0, Math.floor((Math.atan2(right, forward) - first) / step)));
  const top = Math.atan(rows[0].tangent) + step / 2;
  const row = Math.min(height - 1, Math.max(0, Math.floor((top - Math.atan2(up, Math.hypot(right, forward))) / step)));
  const there = points.subarray(3 * (row * width + column), 3 * (row * width + column) + 3);
  return Math.hypot(...there) - Math.hypot(...point) < Math.max(0.03, 0.02 * Math.hypot(...point));
}

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

/**
 * For the points of a scan that a view's camera sees: their number, the share that is kept, and their distance from their rays. For a
 * z-buffer, `stood` is the share of points whose pixel holds the point, another point of its surface, or a point that hides it.
 */
export function measured(scan, view, image) {
  const isSeen = sees(view);
  const pixels = held(image);
  const rays = [];
  let [count, stood] = [0, 0];
  for (let at = 0; at < scan.points.length; at += 3) {
    const point = [...scan.points.subarray(at, at + 3)];
    const range = Math.hypot(...point);
    if (!(range > 0.1 && range < 1e4) || !isSeen(point)) continue;
    count++;
    if (image.how === "sphere" && stands(image, point)) stood++;
    const pixel = pixels.get(key(point));
    if (pixel !== undefined) rays.push(atRay(image, pixel, point));
  }
  const distance = mean(rays.map((ray) => ray.distance));
  return {
    count,
    kept: rays.length / count,
    ...(image.how === "sphere" && { stood: stood / count }),
    distance,
    ofSampling: distance / mean(rays.map((ray) => ray.sampling)),
    ofColumn: distance / mean(rays.map((ray) => ray.across)),
    filled: pixels.size / (image.width * image.height),
  };
}
