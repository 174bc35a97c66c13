/** A ball's visible normals, and the colours that a light gives to normals. Runs in workers; the shading is the library's. */

import { shadeNormals } from "../../pkg/index.js";

/** Unit normals of a ball seen from the front, NaN outside; its radius is this share of half the square's side. */
export function ballNormals(side: number, radius = 1): Float32Array {
  const normals = new Float32Array(3 * side * side).fill(NaN);
  for (let index = 0; index < side * side; index++) {
    const [x, y] = [index % side, Math.floor(index / side)].map((place) => ((2 * place + 1) / side - 1) / radius) as [
      number,
      number,
    ];
    const rest = 1 - x * x - y * y;
    // At the very edge the centre of a pixel does not represent its normal.
    if (rest > 0.002) normals.set([x, y, -Math.sqrt(rest)], 3 * index);
  }
  return normals;
}

/** Linear colours that the image model predicts for these normals, all darker or brighter by e^albedo. */
export const predicted = (light: ArrayLike<number>, normals: Float32Array, albedo = 0): Float32Array =>
  shadeNormals(light, normals).map((value) => Math.exp(value + albedo));
