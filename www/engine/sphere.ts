/** A ball under a light: what the 27 coefficients of a light look like. Runs in the worker; the shading is the library's. */

import { shadeNormals } from "../../pkg/index.js";
import type { Picture } from "./protocol";

/** Pixels across the ball's picture. */
const SIDE = 72;
/** Share of the ball's radius in half the picture. */
const RADIUS = 0.97;

/** The visible normals of a ball, seen from the front; NaN beside it. */
const ball: Float32Array = (() => {
  const normals = new Float32Array(3 * SIDE * SIDE).fill(NaN);
  for (let i = 0; i < SIDE * SIDE; i++) {
    const x = (((i % SIDE) + 0.5) / (SIDE / 2) - 1) / RADIUS;
    const y = ((Math.floor(i / SIDE) + 0.5) / (SIDE / 2) - 1) / RADIUS;
    const rest = 1 - x * x - y * y;
    if (rest > 0) normals.set([x, y, -Math.sqrt(rest)], 3 * i);
  }
  return normals;
})();

const shape = { left: 0, top: 0, width: SIDE, height: SIDE, stride: 1, channels: 3, encoded: false } as const;

/** The ball's colours, the brightest of them white. */
export function lit(light: ArrayLike<number>): Picture {
  const data = shadeNormals(light, ball).map(Math.exp);
  return { ...shape, data, white: data.reduce((most, value) => (value > most ? value : most), 0) || 1 };
}

/** White of a picture of ratios: no difference is a middle grey. */
const EVEN = 2.5;

/** By what factor one light's colours differ from another's, exposure aside. */
export function ratio(light: ArrayLike<number>, other: ArrayLike<number>): Picture {
  const [mine, theirs] = [light, other].map((each) => shadeNormals(each, ball));
  const logs = Float32Array.from(mine ?? [], (log, i) => log - (theirs?.[i] ?? NaN));
  const finite = logs.filter(Number.isFinite);
  const exposure = finite.reduce((sum, log) => sum + log, 0) / (finite.length || 1);
  return { ...shape, data: logs.map((log) => Math.exp(log - exposure)), white: EVEN };
}
