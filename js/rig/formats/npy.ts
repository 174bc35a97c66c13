/** NumPy's arrays as pictures and clouds: .npy, and .npz, which is a ZIP archive of them. */
import { badFile } from "../../errors.js";
import { isNpy, readNpy } from "../../npy.js";
import type { Pixels } from "../../raster.js";
import { FEWEST_POINTS } from "./channels.js";
import { isImage, sizeOfCount } from "./grid.js";
import { checkSize } from "./limits.js";
import type { Picture } from "./picture.js";
import type { ReaderWarning } from "../warnings.js";
import { entriesOf, unpacked } from "./zip.js";

/** Columns of a list of points: x y z, with intensity, colours and the like; images are wider. */
const [FEWEST_COLUMNS, MOST_COLUMNS] = [3, 8];
/** Rows of a list of points for each of its columns, at least; images are not so tall. */
const TALL = 10;
const MOST_LEVEL = 0xffff;

/** Whole numbers of any type as the 16 bits that depth cameras write, where they fit; negative ones are holes. */
function asLevels(data: Pixels): Pixels {
  if (!(data instanceof Float32Array) || data.some((value) => value > MOST_LEVEL)) return data;
  return Uint16Array.from(data, (value) => Math.max(0, value));
}

/** A list of points, with their intensities as KITTI and nuScenes have them; as a cloud, if its number is that of a camera's pixels. */
function ofList(data: Pixels, count: number, columns: number, warnings: ReaderWarning[]): Picture {
  const points = new Float32Array(3 * count);
  for (let at = 0; at < points.length; at++) points[at] = data[Math.floor(at / 3) * columns + (at % 3)] ?? NaN;
  if (count >= FEWEST_POINTS && !isImage(count)) {
    const intensity = columns === 4 || columns === 5 ? points.filter((_, at) => at % 3 === 0) : undefined;
    intensity?.forEach((_, point) => {
      intensity[point] = data[point * columns + 3] ?? NaN;
    });
    const scan = { points, ...(intensity && { intensity }) };
    return { width: count, height: 1, channels: 3, data: points, format: "npy", bits: 32, notes: [], warnings, scan };
  }
  const { width, height } = sizeOfCount(count, warnings);
  return { width, height, channels: 3, data: points, format: "npy", bits: 32, notes: [], warnings };
}

export function npyPicture(bytes: Uint8Array): Picture {
  const { type, ...raster } = readNpy(bytes);
  const { width, height, channels } = raster;
  const isList = channels === 1 && width >= FEWEST_COLUMNS && width <= MOST_COLUMNS && height >= TALL * width;
  if (isList) return ofList(raster.data, height, width, []);
  checkSize(width, height);
  const data = /^[iu]/.test(type) && channels === 1 ? asLevels(raster.data) : raster.data;
  const bits = 8 * (type === "f2" ? 2 : data.BYTES_PER_ELEMENT);
  return { ...raster, data, format: "npy", bits, notes: [], warnings: [] };
}

/** Names of arrays that hold depths, the clearest first. */
const DEPTHS = [/^(?:depth|depths|depth_?map|depth_?image)$/i, /depth|dpt/i, /^(?:z|range|xyz|points?|cloud)$/i];

/** The array of an archive that holds the depth map, by its name; of a single one the name does not matter. */
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
      `it is an .npz archive of ${arrays.length} arrays (${arrays.slice(0, 6).map(called).join(", ")}), of which none alone is called depth; save the depth map as .npy`,
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
