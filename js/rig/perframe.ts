/**
 * Calibrations of single frames: KITTI's calib/000000.txt, calib/000001.txt, .. hold the cameras and poses of the frames with these names.
 *
 * Each frame has the cameras of its file. Poses apply to all frames of a check, so a warning names calibrations that differ.
 */
import { chained, degreesOf, inverseOf } from "./formats/poses.js";
import { key, stem } from "./names.js";
import type { CheckFrame, NamedCamera, NamedPose, RigFolder } from "./types.js";
import { type ReaderWarning, distinct, warning } from "./warnings.js";

/** What one text of a folder holds. */
export interface TextOfFrame {
  file: string;
  cameras: NamedCamera[];
  poses: NamedPose[];
}

/** Poses with smaller differences count as equal: the digits of a file differ by less, and no rig is calibrated better. */
const SAME = { degrees: 0.01, metres: 1e-4 };

/** The frame after which a file is named: the 3D Scanner App has "frame_00000.json" beside "depth_00000.png". */
export const frameOf = (name: string): string => key(name.replace(/frames?(?=[ _-]?\d)/gi, " "));

/** Separates texts that belong to single frames from the others; a single text may share a name with the only frame by chance. */
export function split(texts: TextOfFrame[], frames: ReadonlySet<string>): [own: TextOfFrame[], common: TextOfFrame[]] {
  const called = new Set([...frames].map(frameOf).filter((name) => name !== ""));
  const isOwn = ({ file }: TextOfFrame) => called.has(frameOf(file));
  const own = texts.filter(isOwn);
  // A camera without a name is named after its file, and thereby belongs to the frame of that name (assign.ts).
  const isByName = own.every(
    ({ file, cameras, poses: { length } }) => length === 0 && cameras.every(({ name }) => name === stem(file)),
  );
  const isSeveral = new Set(own.map(({ file }) => key(file))).size > 1;
  return isSeveral && !isByName ? [own, texts.filter((each) => !isOwn(each))] : [[], texts];
}

/** Angle in degrees and distance in metres between two poses. */
function apart(a: NamedPose, b: NamedPose): { degrees: number; metres: number } {
  const { rotation } = chained(b.pose, inverseOf(a.pose));
  const metres = Math.hypot(...a.pose.translation.map((value, at) => value - (b.pose.translation[at] ?? 0)));
  return { degrees: degreesOf(rotation), metres };
}
const isSame = (a: NamedPose, b: NamedPose): boolean => {
  const { degrees, metres } = apart(a, b);
  return a.from === b.from && a.to === b.to && degrees < SAME.degrees && metres < SAME.metres;
};
const isSameCamera = (a: NamedCamera, b: NamedCamera): boolean => JSON.stringify(a) === JSON.stringify(b);

/** All poses once; if a later frame has a pose with the name of an earlier one, its pose is named after its frame. */
function united<T extends { name?: string }>(
  all: [frame: string, items: T[]][],
  isAlike: (a: T, b: T) => boolean,
): T[] {
  const found: T[] = [];
  for (const [frame, items] of all)
    for (const item of items) {
      if (found.some((other) => isAlike(other, item))) continue;
      const isTaken = found.some(({ name }) => name === item.name);
      found.push(isTaken ? { ...item, name: `${item.name ?? "without a name"} (${frame})` } : item);
    }
  return found;
}

/** Reports how far the first poses of the frames differ. */
function checkPoses(heads: [frame: string, pose: NamedPose][], warnings: ReaderWarning[]): void {
  const [first, ...others] = heads;
  if (first === undefined) return;
  const gaps = others.map(([frame, pose]) => ({ frame, ...apart(first[1], pose) }));
  const far = gaps.filter(({ degrees, metres }) => degrees >= SAME.degrees || metres >= SAME.metres);
  const most = far.sort((a, b) => b.degrees - a.degrees)[0];
  if (most === undefined) return;
  const { frame, degrees, metres } = most;
  warnings.push(
    warning(
      "calibrations-differ",
      `The frames have separate calibrations, which differ by up to ${degrees.toFixed(2)} degrees and ${(1000 * metres).toFixed(1)} mm (frames ${first[0]} and ${frame}). Each frame has a separate camera, but a pose is checked with all frames: check frames of one calibration at a time.`,
      { degrees, metres },
    ),
  );
}

/** Assigns to each frame the cameras of its texts, besides the common ones; `assign` does this for a folder of one frame. */
export function assignOwn(folder: RigFolder, own: TextOfFrame[], assign: (one: RigFolder) => RigFolder): void {
  const said: ReaderWarning[] = [];
  const each = folder.frames.map((frame: CheckFrame): [string, RigFolder] => {
    const mine = own.filter(({ file }) => frameOf(file) === frameOf(frame.name ?? ""));
    const cameras = [...mine.flatMap((text) => text.cameras), ...folder.cameras];
    const poses = [...mine.flatMap((text) => text.poses), ...folder.poses];
    const one = assign({ frames: [frame], cameras, poses, readings: [], warnings: said });
    const [file = ""] = mine.map((text) => text.file);
    return [file === "" ? (frame.name ?? "") : stem(file), one];
  });
  folder.cameras = united(
    each.map(([name, { cameras }]) => [name, cameras]),
    isSameCamera,
  );
  folder.poses = united(
    each.map(([name, { poses }]) => [name, poses]),
    isSame,
  );
  folder.warnings.push(...distinct(said));
  checkPoses(
    each.flatMap(
      ([
        name,
        {
          poses: [head],
        },
      ]) => (head ? [[name, head]] : []),
    ),
    folder.warnings,
  );
}
