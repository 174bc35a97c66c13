/**
 * Extrinsics in the formats of other programs. All hold P_colour = R P_depth + t in metres in the convention of the format, and every
 * number reads back exactly.
 */
import type { PoseInput } from "../../types/index.js";
import { oneOf } from "./built.js";
import { open3dJson, realsenseJson } from "./json.js";
import { matrixText, ros2Line } from "./plain.js";
import { type Rig, type RigContext, rigOf } from "./rig.js";
import { kalibrYaml, opencvYaml } from "./yaml.js";

export type { RigContext, Size } from "./rig.js";

/** A text matrix, or the file of OpenCV, Kalibr, ROS 2, Open3D or RealSense. */
export type PoseFormat = "matrix" | "opencv" | "kalibr" | "ros2" | "open3d" | "realsense";

/** A file to be saved. */
export interface WrittenPose {
  /** A file name that states the direction. */
  name: string;
  /** The content of the file. */
  text: string;
  /** Notes on camera parameters that the format cannot hold, or that it requires and that are unknown. */
  notes: string[];
}

interface Format {
  name: string;
  write: (rig: Rig, notes: string[], context: RigContext) => string;
}

const FORMATS: Readonly<Record<PoseFormat, Format>> = {
  matrix: { name: "depth_to_colour.txt", write: matrixText },
  opencv: { name: "depth_to_colour.opencv.yaml", write: opencvYaml },
  kalibr: { name: "camchain.yaml", write: kalibrYaml },
  ros2: { name: "depth_to_colour.ros2.sh", write: (rig, _, context) => ros2Line(rig, context) },
  open3d: { name: "depth_to_colour.open3d.json", write: open3dJson },
  realsense: { name: "depth_to_colour.realsense.json", write: realsenseJson },
};

/** All formats that `writePose` knows. */
export const poseFormats: readonly PoseFormat[] = Object.freeze(Object.keys(FORMATS) as PoseFormat[]);

const ESTIMATE = "An estimate that no check has confirmed: check it with other frames before use.";

/** The text with a comment, if the format permits one. */
function commented(text: string, format: PoseFormat): string {
  if (format === "open3d" || format === "realsense") return text.replace("{\n", `{\n  "comment": "${ESTIMATE}",\n`);
  if (format === "opencv") return text.replace("---\n", `---\n# ${ESTIMATE}\n`);
  return `# ${ESTIMATE}\n${text}`;
}

/** Writes one pose of a rig as a file; `context` supplies what else the format can hold. */
export function writePose(pose: PoseInput, format: PoseFormat, context: RigContext = {}): WrittenPose {
  oneOf(poseFormats, format, "format");
  const { name, write } = FORMATS[format];
  const notes: string[] = [];
  const text = write(rigOf(pose, context), notes, context);
  if (context.isEstimate !== true) return { name, text, notes };
  return { name: name.replace(".", ".estimate."), text: commented(text, format), notes };
}
