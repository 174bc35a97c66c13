/**
 * Recognises files without a full header: raw pixels, COLMAP's depth maps (raw-pixels.ts reads both), and the points of LiDARs in KITTI's
 * and nuScenes' .bin (bin.ts reads them).
 */

export type Size = readonly [width: number, height: number];

export const COLMAP = /^(\d{1,5})&(\d{1,5})&(\d{1,2})&/;
export const headOf = (bytes: Uint8Array): string => String.fromCharCode(...bytes.subarray(0, 24));

export const isColmapMap = (bytes: Uint8Array): boolean => COLMAP.test(headOf(bytes));

/** Largest number of points that are examined. */
const LOOKED_AT = 256;
/** The range of a LiDAR, metres. */
const REACH = 400;
const [MOST_INTENSITY, MOST_RINGS] = [255, 256];

/** Whether the values at this number of floats per point look like a LiDAR's x, y, z, intensity, and ring or time. */
function isCloudOf(view: DataView, floats: number): boolean {
  const size = 4 * floats;
  if (view.byteLength < 20 * size || view.byteLength % size !== 0) return false;
  const count = view.byteLength / size;
  const step = Math.max(1, Math.floor(count / LOOKED_AT));
  let [seen, negative, there] = [0, 0, 0];
  for (let point = 0; point < count; point += step) {
    const at = (index: number) => view.getFloat32(point * size + 4 * index, true);
    const [x, y, z, intensity] = [at(0), at(1), at(2), at(3)];
    if (![x, y, z].every((value) => Math.abs(value) < REACH)) return false;
    if (!(intensity >= 0 && intensity <= MOST_INTENSITY)) return false;
    if (floats > 4 && !(at(4) >= -1 && at(4) < MOST_RINGS)) return false;
    seen++;
    if (x < 0 || y < 0) negative++;
    // Integers that are read as floats are next to zero.
    if (Math.hypot(x, y, z) > 0.1) there++;
  }
  return there > 0.5 * seen && negative > 0.1 * seen;
}

/** Whether a file without a header looks like a LiDAR's points of 4 floats (KITTI) or 5 floats (nuScenes). */
export function arePoints(bytes: Uint8Array): boolean {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return isCloudOf(view, 4) || isCloudOf(view, 5);
}

const EXTENSION = /\.(?:raw|bin|dat|depth|z16|data|yuv)$/i;
export const isRawName = (name: string): boolean => EXTENSION.test(name);

/** The size in a name such as "depth_640x480.raw", if the file has as many pixels of two or four bytes. */
export function sizeInName(name: string, { length }: Uint8Array): Size | undefined {
  const [, width, height] = /(?<!\d)(\d{2,5})x(\d{2,5})(?!\d)[^/]*$/.exec(name) ?? [];
  const size: Size = [Number(width), Number(height)];
  return [2, 4].includes(length / (size[0] * size[1])) ? size : undefined;
}
