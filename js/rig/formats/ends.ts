/** The frames of a motion P_to = R P_from + t, from the names in a file. */
import type { NamedPose } from "../types.js";
import { letteredFrames, wordsOf } from "./names.js";

export interface Frames {
  from?: string;
  to?: string;
}
export type PoseNames = Omit<NamedPose, "pose">;

/** Names of poses of a camera in the world: ARKit, Blender, NeRF, trajectories. */
const OF_WORLD =
  /\b(?:(?:camera|cam|c|local|object|view) ?(?:to|2) ?(?:world|w)|poses?|matrix world|location|camera transform)\b/;
/** Names of their inverses. */
const TO_CAMERA = /\b(?:(?:world|w) ?(?:to|2) ?(?:camera|cam|c|view)|view matrix|world view(?: transform)?)\b/;

/** The frames of names such as "camera_to_world", "cameraPose" and "matrix_world". */
export function worldFrames(name: string): Frames | undefined {
  const words = wordsOf(name).join(" ");
  if (TO_CAMERA.test(words)) return { from: "world", to: "camera" };
  if (OF_WORLD.test(words)) return { from: "camera", to: "world" };
  return undefined;
}

/** Frames from a name: "depth_to_color", "color_from_depth", "T_color_depth", "body_T_cam0". */
export function named(name: string, frames: Frames): PoseNames {
  if (frames.from !== undefined || frames.to !== undefined) return { ...(name !== "" && { name }), ...frames };
  if (name === "") return {};
  const bare = name.replace(/^(?:extrinsics?|transform)[ _]+/i, "").replace(/ /g, "_");
  const towards = /^(?:T_)?([a-z0-9]+)_?(?:_to_|2(?=[a-z]))_?([a-z0-9]+)$/i.exec(bare);
  const world = worldFrames(name);
  if (world !== undefined) return { name, ...world };
  if (towards) return { name, from: towards[1] ?? "", to: towards[2] ?? "" };
  const backwards =
    /^(?:T_)?([a-z0-9]+)_from_([a-z0-9]+)$/i.exec(name) ??
    /^T_([a-z0-9]+)_([a-z0-9]+)$/i.exec(name) ??
    /^([a-z][a-z0-9]*)_(?:T|SE3)_([a-z][a-z0-9]*)_?$/.exec(name);
  // Autoware's calibration toolkit writes the pose of the camera in the LiDAR's frame.
  if (name === "CameraExtrinsicMat") return { name, from: "camera", to: "lidar" };
  if (backwards) return { name, from: backwards[2] ?? "", to: backwards[1] ?? "" };
  const letters = letteredFrames(name);
  return letters === undefined ? { name } : { name, ...letters };
}

/** Whether a motion leads into the world or out of it, so that it does not relate two cameras. */
export const isOfWorld = ({ from, to }: Frames): boolean => from === "world" || to === "world";
