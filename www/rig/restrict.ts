/** The part of a frame that is used: the combined masks of the colour image, and a range of depths. */

import type { CheckFrame } from "../../pkg/index.js";
import type { Mask } from "./protocol";

export function restrictImage(
  image: CheckFrame["image"],
  masks: readonly (Uint8Array | undefined)[],
): CheckFrame["image"] {
  const count = image.width * image.height;
  const given = [image.mask, ...masks].filter(
    (mask): mask is Uint8Array => mask !== undefined && mask.length === count,
  );
  if (given.length === 0) return image;
  return {
    ...image,
    mask: Uint8Array.from({ length: count }, (_, i) => (given.every((mask) => mask[i] !== 0) ? 255 : 0)),
  };
}

/** Metres at each pixel; a hole is zero or no number. */
export function metresOf({ width, height, data, points, unit, camera }: CheckFrame["depth"]): Float32Array {
  const count = width * height;
  if (points) return Float32Array.from({ length: count }, (_, i) => points[3 * i + 2] ?? NaN);
  const factor = unit ?? (data instanceof Uint16Array && camera ? 0.001 : 1);
  return Float32Array.from({ length: count }, (_, i) => (data?.[i] ?? 0) * factor);
}

export function restrictDepth(
  depth: CheckFrame["depth"],
  range: readonly [number, number] | undefined,
): CheckFrame["depth"] {
  if (!range) return depth;
  const [near, far] = range;
  const { mask } = depth;
  const metres = metresOf(depth);
  return { ...depth, mask: Uint8Array.from(metres, (z, i) => (z >= near && z <= far && mask?.[i] !== 0 ? 255 : 0)) };
}

/** The pixels of a depth map within a range of depths where a mask, which may have another size, is not zero. */
export function maskWithin(
  depth: CheckFrame["depth"],
  range: readonly [number, number] | undefined,
  paint: Mask | undefined,
): Mask {
  const { width, height } = depth;
  const inside = restrictDepth(depth, range).mask ?? new Uint8Array(width * height).fill(255);
  if (!paint) return { width, height, data: inside.slice() };
  const at = (place: number, side: number, painted: number) => Math.floor((place * painted) / side);
  const data = inside.map((value, i) => {
    const row = at(Math.floor(i / width), height, paint.height);
    return paint.data[row * paint.width + at(i % width, width, paint.width)] ? value : 0;
  });
  return { width, height, data };
}
