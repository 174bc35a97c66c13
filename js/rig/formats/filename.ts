/**
 * The frames of a file's only pose from the file's name: "depth_to_color.txt", "calib_cam_to_velo.txt", "T_cam_lidar.json".
 *
 * Limit: only names of sensors are recognised as frames.
 */
import type { NamedPose } from "../types.js";

const SENSOR =
  /cam|rgb|colou?r|depth|dpt|infra|(?:^|[_-])ir(?:[_-]|$)|tof|lidar|velo|laser|ouster|livox|radar|imu|base|hand|gripper|left|right/i;
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

/** Whether a pose leads from the depth camera to the colour camera, as one without named frames is taken to. */
const isUsual = ({ from, to }: { from: string; to: string }): boolean =>
  /depth|dpt|infra|tof/i.test(from) && /colou?r|rgb/i.test(to) && !/colou?r|rgb/i.test(from);

/** The poses of a file. A single pose without frames takes those of the file's name, except the default from depth to colour. */
export function withEnds(poses: readonly NamedPose[], path: string): NamedPose[] {
  const [only, ...others] = poses;
  const ends = endsOf(path);
  if (only === undefined || others.length > 0 || ends === undefined || isUsual(ends)) return poses.slice();
  return only.from === undefined && only.to === undefined ? [{ ...only, ...ends }] : [only];
}
