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
/** Names of the inverses of such poses. */
const TO_CAMERA =
  /\b(?:(?:world|w) ?(?:to|2) ?(?:camera|cam|c|view)|view matrix|(?:world|camera) view(?: transform)?)\b/;

/** The frames of names such as "camera_to_world", "cameraPose" and "matrix_world". */
export function worldFrames(name: string): Frames | undefined {
  const words = wordsOf(name).join(" ");
  // "depth_pose_in_color" names both frames.
  if (placedIn(plainName(name)) !== undefined) return undefined;
  if (TO_CAMERA.test(words)) return { from: "world", to: "camera" };
  if (OF_WORLD.test(words)) return { from: "camera", to: "world" };
  return undefined;
}

/** Words in names that describe the quality and the origin of an estimate, not its frames. */
const NO_FRAME = [
  "init|initial|guess|prior|coarse|rough|nominal|cad|default|factory|manual|auto|est|estimated?|estimation|opt",
  "optimi[sz]ed|optimi[sz]ation|refined?|refinement|final|best|result|results|solution|solved|corrected|adjusted",
  "updated|calib|calibrated|calibration|new|old|true|gt|groundtruth|fixed|mat|matrix|4x4|extrinsics?|transform",
  "transformation|tf",
].join("|");
const AROUND = new RegExp(`^(?:(?:${NO_FRAME})[ _-]+)+|(?:[ _-]+(?:${NO_FRAME}))+$`, "gi");
/** Names of frames. */
const FRAME =
  /^(?:cam|camera|colou?r|rgb|depth|ir|infra|infrared|tof|lidar|velo|velodyne|laser|livox|ouster|hesai|scanner|radar|imu|ins|gps|gnss|body|base|vehicle|ego|car|robot|hand|gripper|flange|ee|tool|world|map|odom|left|right|board|target|tag|marker|object|table|sensor)$/;
const isFrame = (word: string): boolean => FRAME.test(word.toLowerCase().replace(/\d+$/, ""));

/** A name without the words around its frames. */
function plainName(name: string): string {
  const bare = name.replace(AROUND, "");
  return (bare === "" ? name : bare).replace(/[ -]/g, "_");
}

/** Whether a name is that of a first estimate, which another pose between the same frames supersedes. */
export const isFirstEstimate = (name: string): boolean =>
  /(?<![a-z])(?:init|initial|guess|prior|coarse|rough|nominal|cad|default|factory|old)(?![a-z])/i.test(name);

/**
 * "camera_in_lidar", "camera_pose_wrt_lidar": the pose of the first frame in the second, which carries points of the first into the second.
 */
function placedIn(bare: string): Frames | undefined {
  const [, of = "", within = ""] =
    /^(?:T_)?([a-z0-9]+)_(?:(?:pose|position|place|orientation|rotation|frame)_)?(?:in|wrt|relative_to|with_respect_to)_(?:the_)?([a-z0-9]+)(?:_frame)?$/i.exec(
      bare,
    ) ?? [];
  return isFrame(of) && isFrame(within) ? { from: of, to: within } : undefined;
}

/** Whether a name mentions two frames, so that it states a direction that may not be the usual one. */
export function mentionsTwo(name: string): boolean {
  const frames = new Set(wordsOf(name.replace(/2(?=[a-z])/gi, " ")).filter(isFrame));
  return frames.size > 1;
}

/** Frames of names that one program uses: Autoware's calibration toolkit; RTAB-Map, which has the camera in the robot's base; DSEC; RealityCapture. */
function ofProduct(name: string): Frames | undefined {
  if (name === "CameraExtrinsicMat") return { from: "camera", to: "lidar" };
  if (name === "xcr") return { from: "camera", to: "world" };
  // DSEC's T_10 carries points of camera 0 to camera 1.
  const [, to, from] = /^T_(\d)(\d)$/.exec(name) ?? [];
  if (to !== from) return { from: `cam${from}`, to: `cam${to}` };
  return name === "local_transform" ? { from: "camera", to: "base" } : undefined;
}

/** Frames from a name: "depth_to_color", "color_from_depth", "T_color_depth", "body_T_cam0". */
export function named(written: string, frames: Frames): PoseNames {
  // ORB-SLAM's "IMU.T_b_c1" has the group of its member before its name.
  const name = written.replace(/^\w{1,40}\.(?=\w+$)/, "");
  if (frames.from !== undefined || frames.to !== undefined) return { ...(name !== "" && { name }), ...frames };
  if (name === "") return {};
  // Matterport's "scan a_d0_0.png a_i0_0.jpg": a pose named after a picture is the pose from which the picture was taken.
  if (/\.(?:png|jpe?g|tiff?|exr)\b/i.test(name)) return { name, from: "camera", to: "world" };
  const own = ofProduct(name);
  if (own !== undefined) return { name, ...own };
  const bare = plainName(name);
  const placed = placedIn(bare);
  if (placed !== undefined) return { name, ...placed };
  const towards = /^(?:T_)?([a-z0-9]+)_?(?:_to_|2(?=[a-z]))_?([a-z0-9]+)$/i.exec(bare);
  const world = worldFrames(name);
  if (world !== undefined) return { name, ...world };
  if (towards) return { name, from: towards[1] ?? "", to: towards[2] ?? "" };
  const letters = letteredFrames(bare);
  if (letters !== undefined) return { name, ...letters };
  const backwards =
    /^(?:T_)?([a-z0-9]+)_from_([a-z0-9]+)$/i.exec(bare) ??
    /^T_([a-z0-9]+)_([a-z0-9]+)$/i.exec(bare) ??
    /^([a-z][a-z0-9]*)_(?:T|SE3)_([a-z][a-z0-9]*)_?$/.exec(bare);
  return backwards ? { name, from: backwards[2] ?? "", to: backwards[1] ?? "" } : { name };
}

/** Whether one of a motion's frames is the world, so that the motion does not relate two cameras. */
export const isOfWorld = ({ from, to }: Frames): boolean => from === "world" || to === "world";
