/**
 * The frames of the only pose in a file, from the file's name: "depth_to_color.txt", "calib_cam_to_velo.txt", "T_cam_lidar.json".
 *
 * Limit: only names of sensors are recognised as frames.
 */
import type { NamedPose } from "../types.js";
import { type Frames, isOfWorld, named, worldFrames } from "./ends.js";
import { inverseOf, isMoved } from "./poses.js";

const SENSOR =
  /cam|rgb|colou?r|depth|dpt|infra|(?:^|[_-])ir(?:[_-]|$)|tof|lidar|velo|laser|ouster|livox|radar|imu|base|hand|gripper|left|right|tag|marker|board|target|pattern|object|table/i;
/** Words before and after the frames. */
const AROUND =
  /^(?:calib(?:ration)?|extrinsics?|transform|tf|pose|rt)[_-]+|[_-]+(?:calib(?:ration)?|extrinsics?|transform|tf|pose|rt)$/gi;
/** Names of hand-eye calibrations, in which a robot holds the camera or the camera looks at a robot. */
const HAND_EYE = /(?:^|[_-])(?:hand[_-]?eye|eye[_-]?(?:in|on|to)[_-]?(?:hand|base))(?![a-z])/i;
const FIXED_EYE = /eye[_-]?(?:to|on[_-]?base)/i;
const LONGEST = 100;

/** The frames in the name of a file; undefined if it names none. */
export function endsOf(path: string): { from: string; to: string } | undefined {
  const name = path.replace(/^.*[/\\]/, "").replace(/\.[a-z]{1,5}$/i, "");
  if (name.length > LONGEST) return undefined;
  // KITTI-360's camera 0, before rectification as in its perspective.txt.
  if (name === "calib_cam_to_velo") return { from: "cam00", to: "velodyne" };
  if (HAND_EYE.test(name)) return { from: "camera", to: FIXED_EYE.test(name) ? "base" : "gripper" };
  const words = name.replace(AROUND, "").replace(AROUND, "");
  const towards = /^([a-z][\w-]*?)[_-]*(?:(?:(?<=[_-])to(?=[_-]))|2)[_-]*([a-z][\w-]*)$/i.exec(words);
  const [a, b] = towards ? [towards[1], towards[2]] : [];
  const backwards =
    /^([a-z][\w-]*?)[_-]from[_-]([a-z][\w-]*)$/i.exec(words) ?? /^T_([a-z][a-z0-9]*)_([a-z][a-z0-9]*)$/i.exec(words);
  // "cam0_wrt_table".
  const placed = named(words, {});
  const [from, to] = towards ? [a, b] : [backwards?.[2] ?? placed.from, backwards?.[1] ?? placed.to];
  if (from === undefined || to === undefined || !SENSOR.test(from) || !SENSOR.test(to)) return undefined;
  return from === to ? undefined : { from, to };
}

/** File names of poses of the camera in the world: "pose.txt", "frame-000000.pose.txt", "camera_pose.npy", "tag_pose.txt". */
const PLACE =
  /^(?:(?:frame|image|img|rgb|colou?r|depth|camera|cam|gt|abs(?:olute)?|obj(?:ect)?|tag|marker|board|target)?[_.-]*\d*[_.-]*){0,3}poses?[_.-]*\d*$/i;

/** Names of rotations that turn a scene upright or rectify images, such as ScanNet's "axis_alignment.txt". */
const ALIGNMENT = /(?:^|[_-])(?:axis[_-]?align\w*|gravity\w*|rectif\w*)/i;

/** The frames of a file whose name or folder is that of a pose of the camera in the world: "c2w/0.txt", "T_world_camera.txt". */
function ofWorldName(path: string): Frames | undefined {
  const [stem = "", folder = ""] = path.split(/[/\\]/).reverse();
  const name = stem.replace(/\.(?:txt|npy|csv|dat|mat|tfm)$/i, "").slice(0, LONGEST);
  if (PLACE.test(name) || ALIGNMENT.test(name) || (/^\d+$/.test(name) && /^poses?$/i.test(folder)))
    return { from: "camera", to: "world" };
  for (const each of /^\D*\d*$/.test(name) ? [name, folder] : [name]) {
    // "stereo_pose" is not the pose of a camera in the world.
    const bare = each.slice(0, LONGEST).replace(/[ _-]?poses?[ _-]?/gi, "");
    const { from, to } = named(bare, {});
    const ends = { ...(from !== undefined && { from }), ...(to !== undefined && { to }) };
    const world = isOfWorld(ends) ? ends : worldFrames(bare);
    if (world !== undefined) return world;
  }
  return undefined;
}

/** Names of extrinsics of a single camera, such as ScanNet's "extrinsic_color": they name one end and no direction. */
const ONE_END =
  /^(?:extrinsics?[_-](?:colou?r|rgb|depth|ir|cam(?:era)?)\d*|(?:colou?r|rgb|depth|ir|cam(?:era)?)\d*[_-]extrinsics?)$/i;
/** Whether a pose without frames has such a name and is not the identity. */
const namesOneEnd = (path: string, { pose }: NamedPose): boolean =>
  ONE_END.test(path.replace(/^.*[/\\]/, "").replace(/\.[a-z]{1,5}$/i, "")) && isMoved(pose);

/** Whether a pose leads from the depth camera to the colour camera, which is also assumed for a pose without named frames. */
const isUsual = ({ from, to }: { from: string; to: string }): boolean =>
  /depth|dpt|infra|tof/i.test(from) && /colou?r|rgb/i.test(to) && !/colou?r|rgb/i.test(from);

/**
 * The poses of a file. A single pose without frames takes the frames in the file's name, except the default from depth to colour. With
 * `isBare` the file holds only numbers, so its name may mean a camera's pose in the world, or name only one of the two frames.
 */
export function withEnds(
  poses: readonly NamedPose[],
  path: string,
  isBare: boolean,
): { poses: NamedPose[]; isPlace?: boolean; isOneEnd?: boolean } {
  const [only, ...others] = poses;
  const isOpen = only !== undefined && others.length === 0 && only.from === undefined && only.to === undefined;
  if (!isOpen) return { poses: poses.slice() };
  const world = isBare ? ofWorldName(path) : undefined;
  if (world !== undefined) {
    const place = world.to === "world" ? only.pose : inverseOf(only.pose);
    const from = world.to === "world" ? world.from : world.to;
    return { poses: [{ ...only, ...(from !== undefined && { from }), to: "world", pose: place }], isPlace: true };
  }
  const ends = endsOf(path);
  const isOneEnd = isBare && ends === undefined && namesOneEnd(path, only);
  return { poses: ends === undefined || isUsual(ends) ? [only] : [{ ...only, ...ends }], isOneEnd };
}
