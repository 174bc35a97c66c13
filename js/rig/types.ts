/** What is read from the files of a rig. */
import type { CheckFrame, Mask, Pose, RigCamera } from "../types.js";

export type { CheckFrame, Mask, Pose, RigCamera };

/** A file as it was dropped or read; the name may hold a path, "depth/0001.png". */
export interface NamedFile {
  name: string;
  bytes: Uint8Array;
}

/** P_to = R P_from + t, metres. */
export interface NamedPose {
  name?: string;
  pose: Pose;
  from?: string;
  to?: string;
}

export interface NamedCamera {
  name?: string;
  camera: RigCamera;
  width?: number;
  height?: number;
}

export interface Reading {
  name: string;
  /** What was read, in plain words: "640x480, 16-bit, read as millimetres, 92.8 % valid, 1.39 to 6.69 m". */
  says: string;
  /** What was guessed or looks wrong, a sentence each. */
  warnings: string[];
}

/** What a file may hold. `guessed` names what of a depth map is not in its file and was told from its values. */
export type RigReading = Reading &
  (
    | { kind: "colour"; image: CheckFrame["image"] }
    | { kind: "depth"; depth: CheckFrame["depth"]; guessed: "unit"[] }
    | { kind: "mask"; mask: Mask }
    | { kind: "cameras"; cameras: NamedCamera[]; poses: NamedPose[] }
    | { kind: "poses"; poses: NamedPose[] }
  );

export interface ReadOptions {
  /** What the file is wanted for; without it the content decides. */
  as?: RigReading["kind"];
  /** Metres per stored unit of a depth map or cloud; without it the values decide. */
  unit?: number;
  /** Breaks the reading off; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** A folder of frames. The cameras are those of the files, shared by all frames. */
export interface RigFolder {
  frames: CheckFrame[];
  cameras: NamedCamera[];
  poses: NamedPose[];
  /** What was read of each file, in the folder's order. */
  readings: Reading[];
  warnings: string[];
}
