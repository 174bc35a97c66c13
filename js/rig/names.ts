/** Names of files: their parts, the common part of the files of one frame, and time stamps. */

export const base = (name: string): string => name.slice(name.lastIndexOf("/") + 1);
/** Endings in two parts: COLMAP's depth maps keep the whole name of their image, and nuScenes' points are not PCD. */
const DOUBLE = /(?:\.[a-z0-9]{1,5})?\.(?:geometric|photometric)\.bin$|\.pcd\.bin$/i;
export const stem = (name: string): string =>
  DOUBLE.test(name) ? base(name).replace(DOUBLE, "") : base(name).replace(/\.[a-z0-9]{1,5}$/i, "");
export const folderOf = (name: string): string => name.slice(0, name.length - base(name).length);

/** A name without the part that distinguishes the files of a frame. */
const common = (name: string): string =>
  name
    .normalize("NFC")
    .replace(/(?:depth|dpt|colou?r|rgb|image|img|mask|crop|registered|aligned)(?:(?:_?maps?|s)(?![a-z]))?/gi, " ");
/** A path without the parts that distinguish the files of a frame. */
export const commonPath = (name: string): string => common(folderOf(name) + stem(name));

/** The common part of the names of one frame's files: letters of any script, in either case, and numbers without leading zeros. */
export function key(name: string): string {
  const words = common(stem(name))
    .toLowerCase()
    .split(/[^\p{L}\p{M}\p{N}.]+/u)
    .map((word) => word.replace(/^\.+|\.+$/g, "").replace(/^0+(?=\d)/, ""));
  return words.filter((word) => word !== "" && word !== "mm").join(" ");
}

/**
 * Words that say what a file holds rather than to which frame it belongs. Depths of a stereo camera are in the left camera's view, so
 * "left" names a colour image of the frame and "right" does not.
 */
const LOOSE = new Set(
  "raw frame frames photo picture pic map maps groundtruth gt velodyne lidar cloud points scan sparse dense filtered z16 png distance to plane linear z cam camera ir infra infrared tof undistorted rectified rect vis left meter metre".split(
    " ",
  ),
);
export const looseKey = (name: string): string =>
  key(name)
    .replace(/([a-z])(?=\d)/g, "$1 ")
    .split(" ")
    .map((word) => word.replace(/^0+(?=\d)/, ""))
    .filter((word) => !LOOSE.has(word))
    .join(" ");

/** Seconds since 1970 of the years 2001 and 2100, and the ticks per second of common clocks. */
const [FROM, UNTIL] = [1e9, 4.2e9];
const TICKS = [1, 1e3, 1e6, 1e9];

/** The time in a file's name, seconds: ticks of any common clock since 1970, or seconds with at least three decimals. */
export function timeOf(name: string): number | undefined {
  const numbers = key(name)
    .split(" ")
    .filter((word) => /\d/.test(word));
  // nuScenes' names have the log, the sensor and the time.
  const last = name.includes("__") && /^\d{13,19}$/.test(numbers.at(-1) ?? "") ? numbers.slice(-1) : numbers;
  const [only = "", ...others] = last;
  if (others.length > 0 || !/^\d+(?:\.\d+)?$/.test(only)) return undefined;
  const ticks = TICKS.find((each) => Number(only) >= FROM * each && Number(only) < UNTIL * each);
  if (ticks !== undefined) return Number(only) / ticks;
  return /\.\d{3,}$/.test(only) ? Number(only) : undefined;
}

/** Names of files that hold only the coefficients of a lens. */
const LENS_FILE = /(?:^|[_.-])(?:d|(?:camera[_-]?)?dist(?:ortion)?(?:[_-]?coeff?\w*)?|coeffs?)(?=[_.-])/i;
export const isLensFile = (path: string): boolean => LENS_FILE.test(path.replace(/^.*[/\\]/, ""));
