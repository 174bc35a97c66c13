/**
 * Recordings of a rig: what was recorded, and frames, cameras and transforms out of them. A module of its own, to be loaded when a recording
 * comes in: it holds the readers of its containers.
 */
export { BimodalError } from "../../errors.js";
export {
  type Choice,
  type Recording,
  type RecordingFile,
  type RecordingOptions,
  type Topic,
  openRecording,
} from "./open.js";
export { isRecording } from "./kinds.js";
export { type Robot, type ViewChoice, connectRobot } from "./live.js";
