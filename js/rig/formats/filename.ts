/**
 * The frames of a file's only pose from the file's name: "depth_to_color.txt", "calib_cam_to_velo.txt", "T_cam_lidar.json".
 *
 * Limit: only names of sensors are recognised as frames.
 */
import type { NamedPose } from "../types.js";
import { type Frames, isOfWorld, named, worldFrames } from "./ends.js";
import { inverseOf } from "./poses.js";

const SENSOR =
  /cam|rgb|colou?r|depth|dpt|infra|(?:^|[_-])ir(?:[_-]|$)|tof|lidar|velo|laser|ouster|livox|radar|imu|base|hand|gripper|left|right|tag|marker|board|target|pattern|object|table/i;
/** Words before and after the frames. */
const AROUND =
  /^(?:calib(?:ration)?|extrinsics?|transform|tf|pose|rt)[_-]+|[_-]+(?:calib(?:ration)?|extrinsics?|transform|tf|pose|rt)$/gi;
const LONGEST = 100;

/** The frames in the name of a file; undefined if it names none. */
export function endsOf(path: string): { from: string; to: string } | undefined {
  const name = path.replace(/^.*[/\\]/, "").replace(/\.[a-z]{1,5}$/i, "");
  if (name.length > LONGEST) return undefined;
  const words = name.replace(AROUND, "").replace(AROUND, "");
  const towards = /^([a-z][\w-]*?)[_-]*(?:(?:(?<=[_-])to(?=[_-]))|2)[_-]*([a-z][\w-]*)$/i.exec(words);
  const [a, b] = towards ? [towards[1], towards[2]] : [];
  const backwards =
    /^([a-z][\w-]*?)[_-]from[_-]([a-z][\w-]*)$/i.exec(words) ?? /^T_([a-z][a-z0-9]*)_([a-z][a-z0-9]*)$/i.exec(words);
  const [from, to] = towards ? [a, b] : [backwards?.[2], backwards?.[1]];
  if (from === undefined || to === undefined || !SENSOR.test(from) || !SENSOR.test(to)) return undefined;
  return from === to ? undefined : { from, to };
}

/** Names of files that are those of poses of the camera in the world: "pose.txt", "frame-000000.pose.txt", "camera_pose.npy", "tag_pose.txt". */
const PLACE =
  /^(?:(?:frame|image|img|rgb|colou?r|depth|camera|cam|gt|abs(?:olute)?|obj(?:ect)?|tag|marker|board|target)?[_.-]*\d*[_.-]*){0,3}poses?[_.-]*\d*$/i;

/** The frames of a file called as a pose of the camera in the world, or whose folder is: "c2w/0.txt", "T_world_camera.txt". */
function ofWorldName(path: string): Frames | undefined {
  const [stem = "", folder = ""] = path.split(/[/\\]/).reverse();
  const name = stem.replace(/\.(?:txt|npy|csv|dat|mat|tfm)$/i, "").slice(0, LONGEST);
  if (PLACE.test(name) || (/^\d+$/.test(name) && /^poses?$/i.test(folder))) return { from: "camera", to: "world" };
  for (const each of /^\D*\d*$/.test(name) ? [name, folder] : [name]) {
    // "stereo_pose" is no place of a camera.
    const bare = each.slice(0, LONGEST).replace(/[ _-]?poses?[ _-]?/gi, "");
    const { from, to } = named(bare, {});
    const ends = { ...(from !== undefined && { from }), ...(to !== undefined && { to }) };
    const world = isOfWorld(ends) ? ends : worldFrames(bare);
    if (world !== undefined) return world;
  }
  return undefined;
}

/** Whether a pose leads from the depth camera to the colour camera, as one without named frames is taken to. */
const isUsual = ({ from, to }: { from: string; to: string }): boolean =>
  /depth|dpt|infra|tof/i.test(from) && /colou?r|rgb/i.test(to) && !/colou?r|rgb/i.test(from);

/**
 * The poses of a file. A single pose without frames takes those of the file's name, except the default from depth to colour. With `isBare`
 * the file has nothing but its numbers, so that its name may say that it is a camera's place in the world.
 */
export function withEnds(
  poses: readonly NamedPose[],
  path: string,
  isBare: boolean,
): { poses: NamedPose[]; isPlace: boolean } {
  const [only, ...others] = poses;
  const isOpen = only !== undefined && others.length === 0 && only.from === undefined && only.to === undefined;
  if (!isOpen) return { poses: poses.slice(), isPlace: false };
  const world = isBare ? ofWorldName(path) : undefined;
  if (world !== undefined) {
    const place = world.to === "world" ? only.pose : inverseOf(only.pose);
    const from = world.to === "world" ? world.from : world.to;
    return { poses: [{ ...only, ...(from !== undefined && { from }), to: "world", pose: place }], isPlace: true };
  }
  const ends = endsOf(path);
  return { poses: ends === undefined || isUsual(ends) ? [only] : [{ ...only, ...ends }], isPlace: false };
}
