/** What the readers of a rig's files warn of: a stable code for programs, a sentence for people, and the numbers in it. */

/** What a reader can warn of. `docs/codes.md` has the cause and the remedy of each. */
export type ReaderCode =
  // Depth maps
  | "unit-guessed"
  | "units-differ"
  | "depth-range"
  | "many-holes"
  | "eight-bits"
  | "raw-disparity"
  | "bytes-swapped"
  | "grid-guessed"
  | "mesh-faces-ignored"
  // LiDARs
  | "points-sorted"
  | "point-times"
  | "lidar-axes"
  | "pose-turned"
  // Colour images and masks
  | "files-swapped"
  | "image-turned"
  | "colour-profile-ignored"
  | "gamma-ignored"
  | "mask-empty"
  | "mask-full"
  | "mask-size"
  // Cameras
  | "camera-size"
  | "camera-shared"
  | "cameras-by-order"
  | "colour-camera-missing"
  | "depth-camera-missing"
  | "principal-point"
  | "focal-length-normalised"
  | "pixels-not-square"
  | "skew-ignored"
  | "lens-approximated"
  | "intrinsics-vary"
  | "distortion-unused"
  | "distortion-guessed"
  | "size-unused"
  | "camera-computed"
  | "camera-left-out"
  // Poses
  | "rotation-adjusted"
  | "quaternion-normalised"
  | "translation-unit-guessed"
  | "pose-assumed"
  | "quaternion-order"
  | "rotation-order"
  | "rotation-guessed"
  | "camera-to-world"
  | "pose-left-out"
  // Folders
  | "inverse-checked"
  | "file-left-out"
  | "file-alone"
  | "names-ambiguous"
  | "pairs-missing"
  | "pairs-by-order"
  | "pairs-by-content"
  | "pairs-sampled"
  // Recordings
  | "times-apart"
  | "clocks-differ"
  | "frames-alike"
  | "transform-missing"
  | "transform-moves";

/** What a reader guessed, changed or found wrong; beside these members the numbers of the code. */
export interface ReaderWarning {
  /** Stable, for programs. */
  code: ReaderCode;
  /** A sentence; of a folder's file it begins with the file's name. */
  message: string;
  /** Whether it makes what was read doubtful, so that it caps the verdict of a check; others name what was left out. */
  isDoubt: boolean;
  /** The file of a folder that it is about. */
  file?: string;
  /** Files of a folder with the same warning, this one included; absent for one. */
  files?: number;
  /** The numbers in the sentence. */
  [detail: string]: unknown;
}

/** These name what was not read; they do not make what was read doubtful. */
const HARMLESS: ReadonlySet<ReaderCode> = new Set([
  "file-left-out",
  "file-alone",
  "names-ambiguous",
  "mask-size",
  "pairs-sampled",
  "frames-alike",
  "transform-missing",
  "points-sorted",
  "lidar-axes",
  "pose-left-out",
  "camera-to-world",
]);

export const warning = (
  code: ReaderCode,
  message: string,
  details: Readonly<Record<string, unknown>> = {},
): ReaderWarning => ({ code, message, isDoubt: !HARMLESS.has(code), ...details });

/** A file's warning among those of its folder. */
export const ofFile = (file: string, found: ReaderWarning): ReaderWarning => ({
  ...found,
  message: `${file}: ${found.message}`,
  file,
});

/** Files that were left out are alike where they were for the same reason, other numbers aside. */
const likeness = ({ code, message, file = "" }: ReaderWarning): string =>
  code === "file-left-out" ? message.slice(file.length).replace(/\d+/g, "#") : code;

/** One warning for all files of a folder that have it: a calibration of a hundred frames warns once, not a hundred times. */
export function grouped(warnings: readonly ReaderWarning[]): ReaderWarning[] {
  const alike = new Map<string, ReaderWarning[]>();
  for (const each of warnings) alike.set(likeness(each), [...(alike.get(likeness(each)) ?? []), each]);
  return [...alike.values()].flatMap((all) => {
    const [first, ...others] = all.filter(({ file }) => file !== undefined);
    const single = all.filter(({ file }) => file === undefined);
    if (first === undefined || others.length === 0) return all;
    const files = new Set([first, ...others].map(({ file }) => file)).size;
    const more = files > 1 ? ` (and ${files - 1} more like it)` : "";
    return [{ ...first, message: `${first.message}${more}`, ...(files > 1 && { files }) }, ...single];
  });
}

/** Without repetitions, at most so many. */
export const distinct = (warnings: readonly ReaderWarning[], most = Infinity): ReaderWarning[] =>
  [...new Map(warnings.map((each) => [each.message, each])).values()].slice(0, most);
