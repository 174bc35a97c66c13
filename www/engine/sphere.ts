/** A ball under a light: what the 27 coefficients of a light look like. Runs in the worker. */

import { shadeNormals } from "../../pkg/index.js";
import { paintPicture } from "../draw/colours";
import { ballNormals, predicted } from "./ball";
import { contextOf } from "./easel";

/** Pixels across the ball's picture. */
const SIDE = 72;
/** Share of the ball's radius in half the picture. */
const RADIUS = 0.97;
const ball = ballNormals(SIDE, RADIUS);

function painted(data: Float32Array, white: number): ImageBitmap {
  const context = contextOf(SIDE, SIDE);
  context.putImageData(paintPicture({ left: 0, top: 0, width: SIDE, height: SIDE, stride: 1, channels: 3, encoded: false, data, white }), 0, 0);
  return context.canvas.transferToImageBitmap();
}

/** The ball's colours, the brightest of them white. */
export function lit(light: ArrayLike<number>): ImageBitmap {
  const data = predicted(light, ball);
  return painted(data, data.reduce((most, value) => (value > most ? value : most), 0) || 1);
}

/** White of a picture of ratios: no difference is a middle grey. */
const EVEN = 2.5;

/** By what factor one light's colours differ from another's, exposure aside. */
export function ratio(light: ArrayLike<number>, other: ArrayLike<number>): ImageBitmap {
  const [mine, theirs] = [light, other].map((each) => shadeNormals(each, ball));
  const logs = Float32Array.from(mine ?? [], (log, i) => log - (theirs?.[i] ?? NaN));
  const finite = logs.filter(Number.isFinite);
  const exposure = finite.reduce((sum, log) => sum + log, 0) / (finite.length || 1);
  return painted(logs.map((log) => Math.exp(log - exposure)), EVEN);
}
