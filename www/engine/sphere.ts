/** A ball under a light, which shows the 27 coefficients of a light as a picture. Runs in the worker. */

import { shadeNormals } from "../../pkg/index.js";
import { paintLog } from "../draw/colours";
import { ballNormals } from "./ball";
import { contextOf } from "./canvas";

/** Pixels across the ball's picture. */
const SIDE = 72;
/** The ball's radius as a share of half the picture. */
const RADIUS = 0.97;
const ball = ballNormals(SIDE, RADIUS);
let context: OffscreenCanvasRenderingContext2D | undefined;

/** A picture of the logarithms of the ball's colours; `white` is the logarithm of the white level. */
function painted(data: Float32Array, white: number): ImageBitmap {
  context ??= contextOf(SIDE, SIDE);
  context.putImageData(
    paintLog({ left: 0, top: 0, width: SIDE, height: SIDE, stride: 1, channels: 3, data }, white),
    0,
    0,
  );
  return context.canvas.transferToImageBitmap();
}

/** The ball's colours, the brightest of them white. */
export function lit(light: ArrayLike<number>): ImageBitmap {
  const logs = shadeNormals(light, ball);
  return painted(
    logs,
    logs.reduce((most, value) => (value > most ? value : most), -Infinity),
  );
}

/** White level of a picture of ratios, in which no difference is drawn as middle grey. */
const EVEN = Math.log(2.5);

/** The factor by which one light's colours differ from another's, except for exposure. */
export function ratio(light: ArrayLike<number>, other: ArrayLike<number>): ImageBitmap {
  const [logs, theirs] = [shadeNormals(light, ball), shadeNormals(other, ball)];
  let [sum, count] = [0, 0];
  for (let i = 0; i < logs.length; i++) {
    const apart = (logs[i] ?? NaN) - (theirs[i] ?? NaN);
    logs[i] = apart;
    if (Number.isNaN(apart)) continue;
    sum += apart;
    count++;
  }
  return painted(logs, EVEN + sum / (count || 1));
}
