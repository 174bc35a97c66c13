/** Warnings of the readers of a rig's files: a stable code for programs, a sentence for people, and the numbers in it. */

/** The codes of a reader's warnings. `docs/codes.md` has the cause and the remedy of each. */
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
  | "calibrations-differ"
  | "distortion-unused"
  | "distortion-guessed"
  | "size-unused"
  | "camera-computed"
  | "camera-left-out"
  | "read-by-lines"
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

/** Something that a reader guessed, changed, left out or found wrong. Further members are the numbers of its code. */
export interface ReaderWarning {
  /** Stable, for programs. */
  code: ReaderCode;
  /** A sentence; for a file of a folder it begins with the file's name. */
  message: string;
  /** Whether the values that were read may be wrong, which caps the verdict of a check. Other warnings name what was left out. */
  isDoubt: boolean;
  /** The file of a folder that it is about. */
  file?: string;
  /** Files of a folder with the same warning, this one included; absent for one. */
  files?: number;
  /** The numbers in the sentence. */
  [detail: string]: unknown;
}

/** Codes of what was left out or left as it is, which does not put the values in question. */
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

/** The warning of a file, with the file's name, for those of its folder. `reason` stays without the name. */
export const ofFile = (file: string, found: ReaderWarning): ReaderWarning => ({
  reason: found.message,
  ...found,
  message: `${file}: ${found.message}`,
  file,
});

/** The key by which warnings are grouped: the code, and for files that were left out the reason as well. */
const likeness = ({ code, reason }: ReaderWarning): string =>
  code === "file-left-out" ? `${code}: ${String(reason)}` : code;

/** One warning for all files of a folder that have it, so that a calibration of a hundred frames warns once. */
export function grouped(warnings: readonly ReaderWarning[]): ReaderWarning[] {
  const alike = new Map<string, ReaderWarning[]>();
  for (const each of warnings) alike.set(likeness(each), [...(alike.get(likeness(each)) ?? []), each]);
  return [...alike.values()].flatMap((all) => {
    const [first, ...others] = all.filter(({ file }) => file !== undefined);
    const single = all.filter(({ file }) => file === undefined);
    if (first === undefined || others.length === 0) return distinct(all);
    const files = new Set([first, ...others].map(({ file }) => file)).size;
    const more = files > 1 ? ` (and ${files - 1} more like it)` : "";
    return [{ ...first, message: `${first.message}${more}`, ...(files > 1 && { files }) }, ...distinct(single)];
  });
}

/** The first warnings with different messages, at most so many. */
export const distinct = (warnings: readonly ReaderWarning[], most = Infinity): ReaderWarning[] =>
  [...new Map(warnings.map((each) => [each.message, each])).values()].slice(0, most);
