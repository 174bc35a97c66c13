/** A frame's depths as points in the colour camera's frame, with the colours of the image at their projections. */

import { projectFrame, type CheckFrame, type Pose } from "../../pkg/index.js";

export async function cloudOf(frame: CheckFrame, pose: Pose): Promise<{ points: Float32Array; colours: Uint8Array }> {
  const { data, width, height } = frame.image;
  const { points: seen, positions } = await projectFrame(frame, pose);
  const colours = new Uint8Array(positions.length);
  const [channels, white] = data instanceof Float32Array ? [3, 1] : [4, data instanceof Uint16Array ? 65535 : 255];
  for (let i = 0; i < colours.length; i += 3) {
    const nearest = (at: number, length: number) => Math.min(Math.max(Math.round(seen[at] ?? 0), 0), length - 1);
    const pixel = nearest(i + 1, height) * width + nearest(i, width);
    for (let c = 0; c < 3; c++) colours[i + c] = Math.min(255, (255 * (data[channels * pixel + c] ?? 0)) / white);
  }
  return { points: positions, colours };
}
