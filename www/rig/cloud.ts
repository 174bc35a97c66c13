/** A frame's depths as points in the colour camera's frame, with the colours that they fall on. */

import { projectFrame, type CheckFrame, type Pose, type RigCamera } from "../../pkg/index.js";

/** Where a camera sees the point (x, y, 1): OpenCV's models, pixels. */
function seenAt({ fx, fy, cx, cy, model, distortion }: RigCamera, x: number, y: number): [number, number] {
  const [k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0] = Array.from(distortion ?? []);
  const square = x * x + y * y;
  if (model === "fisheye") {
    const radius = Math.sqrt(square);
    const angle = Math.atan(radius);
    const a = angle * angle;
    const factor = radius > 0 ? (angle * (1 + a * (k1 + a * (k2 + a * (p1 + a * p2))))) / radius : 1;
    return [fx * factor * x + cx, fy * factor * y + cy];
  }
  const radial = (1 + square * (k1 + square * (k2 + square * k3))) / (1 + square * (k4 + square * (k5 + square * k6)));
  return [fx * (x * radial + 2 * p1 * x * y + p2 * (square + 2 * x * x)) + cx, fy * (y * radial + p1 * (square + 2 * y * y) + 2 * p2 * x * y) + cy];
}

/**
 * The package lays the points over the image of a camera without a lens, where (column, row, depth) say where a point is; its colour is
 * taken where the real camera sees it.
 */
export async function cloudOf(frame: CheckFrame, pose: Pose): Promise<{ points: Float32Array; colours: Uint8Array }> {
  const { image } = frame;
  const { data, width, height, camera } = image;
  const { fx, fy, cx, cy } = camera ?? { fx: width, fy: width, cx: (width - 1) / 2, cy: (height - 1) / 2 };
  const points = (await projectFrame({ ...frame, image: { ...image, camera: { fx, fy, cx, cy } } }, pose)).points.slice();
  const colours = new Uint8Array(points.length).fill(128);
  const [channels, white] = data instanceof Float32Array ? [3, 1] : [4, data instanceof Uint16Array ? 65535 : 255];
  for (let i = 0; i + 2 < points.length; i += 3) {
    const z = points[i + 2] ?? 0;
    const [x, y] = [((points[i] ?? 0) - cx) / fx, ((points[i + 1] ?? 0) - cy) / fy];
    points.set([x * z, y * z, z], i);
    const [column, row] = seenAt({ ...camera, fx, fy, cx, cy }, x, y).map(Math.round) as [number, number];
    if (!(column >= 0 && row >= 0 && column < width && row < height)) continue;
    for (let c = 0; c < 3; c++) colours[i + c] = Math.min(255, (255 * (data[channels * (row * width + column) + c] ?? 0)) / white);
  }
  return { points, colours };
}
