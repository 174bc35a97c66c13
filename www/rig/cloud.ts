/** A frame's depths as points in the colour camera's frame, with the colours they fall on. */

import type { CheckFrame, Pose } from "../../pkg/index.js";
import { projectFrame } from "./project";

/**
 * Seen by a camera of focal length 1 without distortion, a point at (column, row) and depth z lies at (column z, row z, z). The same points
 * seen by the real camera have their colours there; both lists are in the order of the depth map.
 */
export async function cloudOf(frame: CheckFrame, pose: Pose): Promise<{ points: Float32Array; colours: Uint8Array }> {
  const { image } = frame;
  const seen = (await projectFrame(frame, pose)).points;
  const { fx, fy, cx, cy } = image.camera ?? { fx: 1, fy: 1, cx: 0, cy: 0 };
  const points = new Float32Array(seen.length);
  const colours = new Uint8Array(seen.length).fill(128);
  const { data, width, height } = image;
  const [channels, white] = data instanceof Float32Array ? [3, 1] : [4, data instanceof Uint16Array ? 65535 : 255];
  for (let i = 0; i + 2 < seen.length; i += 3) {
    const [u = 0, v = 0, z = 0] = seen.subarray(i, i + 3);
    points.set([((u - cx) / fx) * z, ((v - cy) / fy) * z, z], i);
    const [column, row] = [Math.round(u), Math.round(v)];
    if (column < 0 || row < 0 || column >= width || row >= height) continue;
    for (let c = 0; c < 3; c++) colours[i + c] = Math.min(255, (255 * (data[channels * (row * width + column) + c] ?? 0)) / white);
  }
  return { points, colours };
}
