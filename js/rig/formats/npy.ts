/** NumPy's arrays as pictures and clouds: .npy, and .npz, which is a ZIP archive of them. */
import { badFile } from "../../errors.js";
import { isNpy, readNpy } from "../../npy.js";
import type { Pixels } from "../../raster.js";
import { FEWEST_POINTS, columnOf, pointsOf } from "./channels.js";
import { isImage, sizeOfCount } from "./grid.js";
import { checkSize } from "./limits.js";
import { DEPTH } from "./npy-matrix.js";
import type { Picture } from "./picture.js";
import type { ReaderWarning } from "../warnings.js";
import { entriesOf, unpacked } from "./zip.js";

/** Smallest and largest number of columns in a list of points: x, y, z and, for instance, intensity or colours. Images are wider. */
const [FEWEST_COLUMNS, MOST_COLUMNS] = [3, 8];
/** Smallest ratio of rows to columns of a list of points; images are not so tall. */
const TALL = 10;
const MOST_LEVEL = 0xffff;

/** Integers of any type as 16 bits, which depth cameras write, if all of them fit; negative ones are holes. */
function asLevels(data: Pixels): Pixels {
  if (!(data instanceof Float32Array) || data.some((value) => value > MOST_LEVEL)) return data;
  return Uint16Array.from(data, (value) => Math.max(0, value));
}

/**
 * Reads a list of points. With the columns of KITTI or nuScenes it is a scan with intensities. With as many points as a depth camera has
 * pixels, it is an organised cloud.
 */
function ofList(data: Pixels, count: number, columns: number): Picture {
  const points = pointsOf(data, columns);
  const warnings: ReaderWarning[] = [];
  const list = { channels: 3, data: points, format: "npy", bits: 32, notes: [], warnings };
  if (count < FEWEST_POINTS || isImage(count)) return { ...list, ...sizeOfCount(count, warnings) };
  const hasIntensity = columns === 4 || columns === 5;
  const scan = { points, ...(hasIntensity && { intensity: columnOf(data, columns, 3) }) };
  return { ...list, width: count, height: 1, scan };
}

/** White and full opacity, for numbers from 0 to 1 and of 8 and 16 bits. */
const WHITES = [1, 0xff, MOST_LEVEL];

/** Whether the fourth of four channels holds, for instance, depths of an RGB-D image. An alpha channel is opaque somewhere. */
function hasDepths(data: Pixels): boolean {
  let most = 0;
  for (let at = 3; at < data.length; at += 4) most = Math.max(most, data[at] ?? 0);
  return most > 0 && !WHITES.includes(most);
}

/** Converts rows of coordinates, which the devkit of nuScenes uses, to rows of points. */
const transposed = (data: Pixels, rows: number, columns: number): Pixels =>
  data.map((_, at) => data[(at % rows) * columns + Math.floor(at / rows)] ?? NaN);

/** `check` refuses a size. */
export function npyPicture(bytes: Uint8Array, check = checkSize): Picture {
  const { type, ...raster } = readNpy(bytes);
  const { width, height, channels } = raster;
  const isList = channels === 1 && width >= FEWEST_COLUMNS && width <= MOST_COLUMNS && height >= TALL * width;
  if (isList) return ofList(raster.data, height, width);
  const isTurned = channels === 1 && height >= FEWEST_COLUMNS && height <= MOST_COLUMNS && width >= TALL * height;
  if (isTurned) return ofList(transposed(raster.data, height, width), width, height);
  check(width, height);
  if (channels === 4 && !(raster.data instanceof Uint8Array) && hasDepths(raster.data))
    throw badFile(
      "its pixels have four channels, the last of which is opaque nowhere, so it is not alpha but perhaps depth; save colours and depths as two files",
    );
  const data = /^[iu]/.test(type) && channels === 1 ? asLevels(raster.data) : raster.data;
  const bits = 8 * (type === "f2" ? 2 : data.BYTES_PER_ELEMENT);
  return { ...raster, data, format: "npy", bits, notes: [], warnings: [] };
}

/** Names of arrays that hold depths, the most specific first. */
const DEPTHS = [DEPTH, /depth|dpt/i, /^(?:z|range|xyz|points?|cloud)$/i];

/** The array of an archive that holds the depth map, by its name; the only array of an archive may have any name. */
export function npzPicture(bytes: Uint8Array): Picture {
  const arrays = entriesOf(bytes).filter(({ name }) => /\.npy$/i.test(name));
  const called = ({ name }: { name: string }) => name.replace(/\.npy$/i, "");
  const [only] = arrays;
  if (only === undefined) throw badFile("it is a ZIP archive without a .npy array in it; unpack it first");
  const chosen =
    arrays.length === 1
      ? only
      : DEPTHS.map((pattern) => arrays.filter((each) => pattern.test(called(each)))).find(
          (all) => all.length === 1,
        )?.[0];
  if (chosen === undefined)
    throw badFile(
      `it is an .npz archive of ${arrays.length} arrays (${arrays.slice(0, 6).map(called).join(", ")}), of which exactly one must be called depth; save the depth map as .npy`,
    );
  const array = unpacked(bytes, chosen);
  if (!isNpy(array)) throw badFile(`the array ${called(chosen)} of this .npz is damaged`);
  const picture = npyPicture(array);
  return {
    ...picture,
    name: called(chosen),
    format: "npz",
    notes: [`its array "${called(chosen)}"`, ...picture.notes],
  };
}
