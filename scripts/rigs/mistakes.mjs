// Pictures with common mistakes: mirrored, turned, already registered, or with the intrinsics of another size.
import { project, ray } from "../captures/lens.mjs";
import { moved } from "./draws.mjs";

/**
 * A picture turned clockwise by so many quarters, or mirrored, with its intrinsics as they were. `from` numbers its pixels
 * as before, and `place` says where a pixel went.
 */
export function rotated({ width, height, data, mask, ...view }, quarters, mirror) {
  const places = [
    ([x, y]) => [mirror ? width - 1 - x : x, y],
    ([x, y]) => [height - 1 - y, x],
    ([x, y]) => [width - 1 - x, height - 1 - y],
    ([x, y]) => [y, width - 1 - x],
  ];
  const place = places[quarters];
  const size = quarters % 2 === 1 ? { width: height, height: width } : { width, height };
  const channels = data.length / (width * height);
  const [turned, from] = [new data.constructor(data.length), new Int32Array(width * height)];
  for (let index = 0; index < width * height; index++) {
    const [x, y] = place([index % width, Math.floor(index / width)]);
    const to = x + y * size.width;
    from[to] = index;
    for (let channel = 0; channel < channels; channel++)
      turned[channels * to + channel] = data[channels * index + channel];
  }
  return { ...view, ...size, data: turned, from, place };
}

/** The same picture with intrinsics of another size that keeps the width (0) or the height (1) of its view. */
export function resized(view, [width, height], kept) {
  const scale = [width / view.width, height / view.height][kept];
  const margin = [(width - scale * view.width) / 2, (height - scale * view.height) / 2];
  const { fx, fy, cx, cy, ...lens } = view.camera;
  const centre = (value, k) => scale * (value + 0.5) + margin[k] - 0.5;
  return { ...view, camera: { ...lens, fx: scale * fx, fy: scale * fy, cx: centre(cx, 0), cy: centre(cy, 1) } };
}

/** A frame whose depth map is registered to the colour image: each sample covers the pixels up to its neighbours. */
export function registered({ image, depth, ...frame }, pose) {
  const { width, height, camera } = image;
  const unit = depth.unit ?? (depth.data instanceof Uint16Array ? 0.001 : 1);
  const data = new Float32Array(width * height);
  const reach = Math.ceil((camera.fx / depth.camera.fx) * 0.6);
  for (let index = 0; index < depth.data.length; index++) {
    const z = depth.data[index] * unit;
    if (!(z > 0)) continue;
    const [x, y] = ray(depth.camera, [index % depth.width, Math.floor(index / depth.width)]);
    const point = moved(pose, [x * z, y * z, z]);
    const [column, row] = project(camera, point).map(Math.round);
    for (let j = Math.max(0, row - reach); j <= Math.min(height - 1, row + reach); j++)
      for (let i = Math.max(0, column - reach); i <= Math.min(width - 1, column + reach); i++) {
        const at = i + j * width;
        if (data[at] === 0 || point[2] < data[at]) data[at] = point[2];
      }
  }
  return { ...frame, image, depth: { width, height, data, camera, unit: 1 } };
}
