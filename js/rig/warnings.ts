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
  // Codes about colour images and masks.
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
  | "pairs-shifted"
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
  /** A sentence; for a file in a folder it begins with the file's name. */
  message: string;
  /** Whether the values that were read may be wrong, which caps the verdict of a check. Other warnings only name what was left out. */
  isDoubt: boolean;
  /** The file in a folder that the warning is about. */
  file?: string;
  /** Number of files in a folder with the same warning, including this one; absent for a single file. */
  files?: number;
  /** The numbers in the sentence. */
  [detail: string]: unknown;
}

/** Codes about parts that were left out or left unchanged, which is no evidence against the values. */
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

/** A number in a message, with five significant digits: a file's own digits, of which there may be sixteen, hide the value. */
export const digits = (value: number): string => Number(value.toPrecision(5)).toString();

export const warning = (
  code: ReaderCode,
  message: string,
  details: Readonly<Record<string, unknown>> = {},
): ReaderWarning => ({ code, message, isDoubt: !HARMLESS.has(code), ...details });

/** A file's warning for the list of its folder: the message begins with the file's name. `reason` stays without the name. */
export const ofFile = (file: string, found: ReaderWarning): ReaderWarning => ({
  reason: found.message,
  ...found,
  message: `${file}: ${found.message}`,
  file,
});

/** The key by which warnings are grouped: the code and, for files that were left out, the reason. */
const likeness = ({ code, reason }: ReaderWarning): string =>
  code === "file-left-out" ? `${code}: ${String(reason)}` : code;

/** Merges equal warnings of all files into one, so that a hundred frames with the same calibration cause a single warning. */
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

/** The first warnings with different messages, at most this many. */
export const distinct = (warnings: readonly ReaderWarning[], most = Infinity): ReaderWarning[] =>
  [...new Map(warnings.map((each) => [each.message, each])).values()].slice(0, most);
