/** Where a frame's depths fall in its colour image. A stand-in for `projectFrame` of the package: pinholes without distortion. */

import type { CheckFrame, Pose } from "../../pkg/index.js";
import type { Projection } from "./protocol";
import { metresOf } from "./restrict";

export async function projectFrame({ image, depth }: CheckFrame, { rotation: r, translation: t }: Pose): Promise<Projection> {
  const metres = metresOf(depth);
  const to = image.camera;
  const from = depth.camera;
  const points: number[] = [];
  const edges: number[] = [];
  if (!to || !from) return { points: new Float32Array(), edges: new Float32Array() };
  for (let row = 0; row < depth.height; row++) {
    for (let column = 0; column < depth.width; column++) {
      const i = row * depth.width + column;
      const z = metres[i] ?? 0;
      if (!(z > 0)) continue;
      const p = [((column - from.cx) / from.fx) * z, ((row - from.cy) / from.fy) * z, z];
      const [x = 0, y = 0, far = 0] = [0, 1, 2].map((k) => (r[3 * k] ?? 0) * (p[0] ?? 0) + (r[3 * k + 1] ?? 0) * (p[1] ?? 0) + (r[3 * k + 2] ?? 0) * z + (t[k] ?? 0));
      if (!(far > 0)) continue;
      const [u, v] = [(to.fx * x) / far + to.cx, (to.fy * y) / far + to.cy];
      points.push(u, v, far);
      const beside = [metres[i + 1], metres[i + depth.width], metres[i - 1], metres[i - depth.width]];
      if (beside.some((other = 0) => other > z + 0.03)) edges.push(u, v);
    }
  }
  return { points: new Float32Array(points), edges: new Float32Array(edges) };
}
