/** The topics of recordings and robots, and frames with their cameras and the transform between these. */
import { addCameras } from "../assign.js";
import type { CheckFrame, NamedCamera, RigFolder } from "../types.js";
import { type ReaderWarning, distinct, grouped, ofFile, warning } from "../warnings.js";
import { ofTurned } from "./axes.js";
import type { Moment } from "./pairs.js";
import { isColour, isDepth } from "./roles.js";
import type { Shot, Source, Track, TrackKind } from "./source.js";

/** A topic or track of a recording. */
export interface Topic {
  /** The name of the topic. */
  name: string;
  /** The type of its messages, or its codec. */
  type: string;
  /** The kind of data that the topic holds. */
  kind: TrackKind;
  /** Number of its messages. */
  messages: number;
  /** Messages per second. */
  rate: number;
  /** How its images or clouds are stored, such as "640x480 rgb8". */
  stored?: string;
  /** Bytes of the pixels or points of its first message. */
  bytes?: number;
  /** The camera that may have taken the images or clouds of the topic. */
  role?: "colour" | "depth";
  /** The reason why the topic is not read. */
  unread?: string;
}

export function topicsOf(
  tracks: readonly Track[],
  [from, until]: readonly [number, number],
  shots: ReadonlyMap<string, Shot | string>,
): Topic[] {
  return tracks.map(({ name, type, kind, count, unread }) => {
    const shot = shots.get(name);
    const why = unread ?? (typeof shot === "string" ? shot : undefined);
    const topic = {
      name,
      type,
      kind,
      messages: count,
      rate: count > 1 && until > from ? (count - 1) / (until - from) : 0,
    };
    if (shot === undefined || typeof shot === "string") return { ...topic, ...(why !== undefined && { unread: why }) };
    const size = shot.width && shot.height ? `${shot.width}x${shot.height} ` : "";
    return {
      ...topic,
      stored: `${size}${shot.encoding}`,
      bytes: shot.bytes,
      ...(isDepth(shot) ? { role: "depth" as const } : isColour(shot) ? { role: "colour" as const } : {}),
    };
  });
}

/** Gives the cameras and the transforms of shots. */
type Answers = Pick<Source, "camera" | "poses">;

/** Frames as those of a folder, with their cameras, the transform and all warnings. */
export async function folderOf(
  source: Answers,
  moments: readonly Moment[],
  frames: CheckFrame[],
  given: readonly ReaderWarning[],
): Promise<RigFolder> {
  const folder: RigFolder = { frames, cameras: [], poses: [], readings: [], warnings: [...given] };
  const [first] = moments;
  if (first === undefined) return folder;
  const { colour, depth } = first.pair;
  folder.readings.push(
    { name: colour.track, says: first.image.says, warnings: [] },
    { name: depth.track, says: first.map.says, warnings: [] },
  );
  moments.forEach(({ image, map }, index) => {
    for (const each of [...image.warnings, ...map.warnings])
      folder.warnings.push(ofFile(frames[index]?.name ?? "", each));
  });
  await addOwnCameras(source, folder, colour, depth);
  const { found, warnings } = await source.poses(depth, colour);
  const { turn } = first;
  folder.poses = turn ? found.map((each) => ofTurned(each, turn)) : found;
  folder.warnings.push(...warnings);
  if (found.length === 0) folder.warnings.push(noTransform(depth, colour));
  folder.warnings = grouped(distinct(folder.warnings));
  return folder;
}

/** Each image has the camera that its source names, without a guess by name or size. */
async function addOwnCameras(source: Answers, folder: RigFolder, colour: Shot, depth: Shot): Promise<void> {
  const cameras: NamedCamera[] = [];
  const named = async (shot: Shot, name: string, size: { width: number; height: number }) => {
    const { found, warnings } = await source.camera({ ...shot, width: size.width, height: size.height });
    folder.warnings.push(...warnings);
    if (found) cameras.push({ ...found, name });
  };
  const [first] = folder.frames;
  if (first === undefined) return;
  await named(colour, "colour", first.image);
  if (first.depth.points === undefined) await named(depth, "depth", first.depth);
  folder.cameras = cameras;
  attach(folder);
}

/** Gives the frames their cameras. A single camera is not used for both sides: the missing one has a warning instead. */
function attach(folder: RigFolder): void {
  const [first] = folder.frames;
  const isAlone = folder.cameras.length === 1 && first?.depth.points === undefined;
  if (!isAlone && folder.cameras.length > 0) return addCameras(folder);
  const names = folder.cameras.map(({ name }) => name);
  const depth = first?.depth.points === undefined && !names.includes("depth");
  if (!names.includes("colour"))
    folder.warnings.push(
      warning(
        "colour-camera-missing",
        "There are no intrinsics for the colour images: no camera_info beside them or with their frame, and no attached calibration. Their focal length has to be estimated.",
      ),
    );
  if (depth)
    folder.warnings.push(
      warning(
        "depth-camera-missing",
        "There are no intrinsics for the depth maps: no camera_info beside them or with their frame, and no attached calibration. Without them depths cannot be turned into points.",
      ),
    );
  for (const { name, camera } of folder.cameras)
    for (const frame of folder.frames) (name === "colour" ? frame.image : frame.depth).camera = camera;
}

const noTransform = (from: Shot, to: Shot): ReaderWarning =>
  warning(
    "transform-missing",
    `There is no transform from ${from.frame || "the depth camera's frame, which has no name,"} to ${to.frame || "the colour camera's frame, which has no name"}, neither in tf_static or tf nor in an attached calibration. Give a calibration; without one there is only an estimate.`,
  );
