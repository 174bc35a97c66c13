/**
 * Recordings of a rig: their topics, and the frames, cameras and transforms in them. This is a separate entry, to be loaded on demand, since
 * the readers of containers are large.
 */
export { BimodalError } from "../../errors.js";
export {
  type Recording,
  type RecordingFile,
  type RecordingOptions,
  type Topic,
  openRecording,
} from "./open.js";
export type { Choice } from "./roles.js";
export { isRecording } from "./kinds.js";
export { type Robot, type ViewChoice, connectRobot } from "./live.js";
