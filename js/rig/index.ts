/**
 * Readers for the files of a rig: frames, cameras and calibrations as tools and cameras write them. A separate module, loaded with the first file.
 */
export { BimodalError } from "../errors.js";
export { cameraFromFieldOfView } from "./camera.js";
export { type FolderOptions, readRigFolder } from "./folder.js";
export { readRigFile } from "./read.js";
export { isRecording } from "./recordings/kinds.js";
export { rangeImage } from "./range.js";
export type { ReaderCode, ReaderWarning } from "./warnings.js";
export type { InverseDepth } from "./inverse.js";
export type { NamedCamera, NamedFile, NamedPose, ReadOptions, Reading, RigFolder, RigReading } from "./types.js";
