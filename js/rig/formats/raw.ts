/**
 * Files without a full header: raw pixels of a given size, COLMAP's depth maps, and how to recognise the points of LiDARs in KITTI's and
 * nuScenes' .bin (bin.ts reads them).
 */
import { badFile } from "../../errors.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { SIZES } from "./grid.js";
import { checkBytes, checkSize } from "./limits.js";
import type { Picture } from "./picture.js";

export type Size = readonly [width: number, height: number];

const COLMAP = /^(\d{1,5})&(\d{1,5})&(\d{1,2})&/;
const headOf = (bytes: Uint8Array): string => String.fromCharCode(...bytes.subarray(0, 24));

export const isColmapMap = (bytes: Uint8Array): boolean => COLMAP.test(headOf(bytes));

/** "width&height&channels&", then floats row by row. */
export function readColmapMap(bytes: Uint8Array): Picture {
  const [head = "", width, height, channels] = COLMAP.exec(headOf(bytes)) ?? [];
  const size = { width: Number(width), height: Number(height) };
  checkSize(size.width, size.height);
  if (channels !== "1")
    throw badFile(`it is COLMAP's map of ${channels} channels (normals); the depth map is in stereo/depth_maps`);
  const body = bytes.subarray(head.length);
  checkBytes(4 * size.width * size.height, body.length, "this depth map of COLMAP");
  const warnings: ReaderWarning[] = [
    warning(
      "unit-guessed",
      "COLMAP's depths have the scale of its reconstruction, which was guessed to be metres; give the unit if that is wrong.",
      { unit: 1 },
    ),
  ];
  const data = new Float32Array(body.slice(0, 4 * size.width * size.height).buffer);
  return { ...size, channels: 1, data, format: "COLMAP", bits: 32, unit: 1, notes: ["COLMAP's depth map"], warnings };
}

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

/** The error about such points if they are not a scan. */
export const pointsRefused = () =>
  badFile(
    "it looks like a LiDAR's points without rows and columns (unorganised, such as a velodyne .bin of KITTI or nuScenes). They are too few or too scattered for a range image; save them as an organised cloud or as a depth map",
  );

const EXTENSION = /\.(?:raw|bin|dat|depth|z16|data|yuv)$/i;
export const isRawName = (name: string): boolean => EXTENSION.test(name);

/** Whether values of four bytes are floats rather than integers, which are next to zero when they are read as floats. */
function areFloats(values: Float32Array): boolean {
  let [plausible, tiny] = [0, 0];
  for (const value of values) {
    if (value === 0 || (Math.abs(value) >= 1e-3 && Math.abs(value) < 1e7) || !Number.isFinite(value)) plausible++;
    else tiny++;
  }
  return tiny < 0.01 * (plausible + tiny);
}

/** Pixels without a header, of a given size. */
export function readRaw(bytes: Uint8Array, [width, height]: Size): Picture {
  checkSize(width, height);
  const each = bytes.length / (width * height);
  const own = () => bytes.slice().buffer;
  const size = { width, height, channels: 1, format: "raw", notes: ["raw pixels"], warnings: [] };
  if (each === 1) return { ...size, data: new Uint8Array(own()), bits: 8 };
  if (each === 2) return { ...size, data: new Uint16Array(own()), bits: 16 };
  if (each === 8) return { ...size, data: new Float32Array(new Float64Array(own())), bits: 64 };
  if (each === 4) {
    const floats = new Float32Array(own());
    return { ...size, data: areFloats(floats) ? floats : new Float32Array(new Uint32Array(own())), bits: 32 };
  }
  throw badFile(
    `its ${bytes.length} bytes are not ${width}x${height} pixels of 1, 2, 4 or 8 bytes: is the size wrong, or does it have a header?`,
  );
}

/** The size in a name such as "depth_640x480.raw", if the file has as many pixels of two or four bytes. */
export function sizeInName(name: string, { length }: Uint8Array): Size | undefined {
  const [, width, height] = /(?<!\d)(\d{2,5})x(\d{2,5})(?!\d)[^/]*$/.exec(name) ?? [];
  const size: Size = [Number(width), Number(height)];
  return [2, 4].includes(length / (size[0] * size[1])) ? size : undefined;
}

/** The error about a file of an unknown format, with the sizes that would fit if it holds raw pixels. */
export function rawRefused(bytes: Uint8Array) {
  const fitting = ([2, 4] as const).flatMap((each) =>
    SIZES.filter(([width, height]) => width * height * each === bytes.length).map(
      ([width, height]) => `${width}x${height} of ${8 * each} bits`,
    ),
  );
  return badFile(
    `its format is not supported; if it is raw data without a header, give its size in pixels (width and height)${fitting.length > 0 ? `: ${fitting.join(" or ")} would have its ${bytes.length} bytes` : ""}, or save it as 16-bit PNG or .npy`,
  );
}
