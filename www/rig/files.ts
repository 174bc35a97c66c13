/** The package's readers, with the package's declared types. */

import * as rig from "../../pkg/rig.js";
import type * as Rig from "../../pkg/rig/index.js";

export type {
  InverseDepth,
  NamedCamera,
  NamedFile,
  NamedPose,
  ReadOptions,
  ReaderWarning,
  Reading,
  RigReading,
} from "../../pkg/rig/index.js";

export const readRigFile = rig.readRigFile as typeof Rig.readRigFile;
export const isRecording = rig.isRecording as typeof Rig.isRecording;
export const readRigFolder = rig.readRigFolder as typeof Rig.readRigFolder;
