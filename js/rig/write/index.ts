/** Writes the results of a check of a rig to files. A separate module, loaded when something is saved. */
export { BimodalError } from "../../errors.js";
export { type Cloud, writeClouds } from "./clouds.js";
export { type PoseFormat, type RigContext, type Size, type WrittenPose, poseFormats, writePose } from "./pose.js";
export {
  type Checked,
  type Overlay,
  type Picture,
  type ReportEntry,
  type ReportInput,
  type ReportOptions,
  reportHtml,
} from "./report/index.js";
