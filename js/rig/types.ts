/** What is read from the files of a rig. */
import type { CheckFrame, Mask, Pinhole, Pose } from "../types/index.js";
import type { Scan } from "./lidar/scan.js";
import type { ReaderWarning } from "./warnings.js";

export type { CheckFrame, Mask, Pinhole, Pose, ReaderWarning, Scan };

/** A file as it was dropped or read; the name may hold a path, "depth/0001.png". */
export interface NamedFile {
  /** Name or path; readers tell depth from colour by it where the content does not. */
  name: string;
  /** The whole content. */
  bytes: Uint8Array;
}

/** P_to = R P_from + t, metres. */
export interface NamedPose {
  /** The pose's name in its file. */
  name?: string;
  /** Scale 1, metres. */
  pose: Pose;
  /** Name of the frame that points come from. */
  from?: string;
  /** Name of the frame that points go to. */
  to?: string;
}

/** A camera as a file names it. */
export interface NamedCamera {
  /** The camera's name in its file, or the file's. */
  name?: string;
  /** Its intrinsics, pixels. */
  camera: Pinhole;
  /** Columns of its pictures, where the file says so. */
  width?: number;
  /** Rows of its pictures, where the file says so. */
  height?: number;
  /** Which pictures it took, where the file says so; "both" where depth maps are registered to its colour images. */
  takes?: "colour" | "depth" | "both";
}

/** What was read of a file, in words. */
export interface Reading {
  /** Of the file. */
  name: string;
  /** What was read, in plain words: "640x480, 16-bit, read as millimetres, 92.8 % valid, 1.39 to 6.69 m". */
  says: string;
  /** What was guessed or looks wrong. */
  warnings: ReaderWarning[];
  /** Whether a picture is stored without colours. */
  isGrey?: boolean;
  /** Of a depth map or cloud. */
  measured?: {
    /** How its numbers are stored: "16-bit". */
    stored: string;
    /** Share of valid pixels, 0 to 1. */
    valid: number;
    /** The nearest and the farthest depth, metres. */
    range: [number, number];
  };
}

/** What a file may hold. `guessed` names what of a depth map is not in its file and was inferred from its values. */
export type RigReading = Reading &
  (
    | {
        /** What the file holds. */
        kind: "colour";
        /** Without a camera. */
        image: CheckFrame["image"];
      }
    | {
        /** What the file holds. */
        kind: "depth";
        /** With its unit. */
        depth: CheckFrame["depth"];
        /** Members that are not in the file and were guessed from its values. */
        guessed: "unit"[];
        /** The points as the file has them, metres, where they are in no rows and columns and `depth` is made of them. */
        scan?: Scan;
      }
    | {
        /** What the file holds. */
        kind: "mask";
        /** 255 where the object is, else 0. */
        mask: Mask;
      }
    | {
        /** What the file holds. */
        kind: "cameras";
        /** In the order of the file. */
        cameras: NamedCamera[];
        /** In the order of the file; those between a depth and a colour camera first. */
        poses: NamedPose[];
        /** Metres per stored unit of the depth maps beside it, where the file says it. */
        depthUnit?: number;
      }
    | {
        /** What the file holds. */
        kind: "poses";
        /** In the order of the file. */
        poses: NamedPose[];
      }
  );

/** How `readRigFile` reads. */
export interface ReadOptions {
  /** What the file is wanted for; without it the content decides. */
  as?: RigReading["kind"];
  /** Metres per stored unit of a depth map or cloud; without it the values decide. */
  unit?: number;
  /** Width and height of raw pixels, of which no header says them (.raw, .bin). */
  size?: readonly [width: number, height: number];
  /** Breaks the reading off; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** A folder of frames. The cameras are those of the files, shared by all frames. */
export interface RigFolder {
  /** Pairs with the cameras that were found for them. */
  frames: CheckFrame[];
  /** All cameras of the folder's files. */
  cameras: NamedCamera[];
  /** Poses that relate two cameras. */
  poses: NamedPose[];
  /** What was read of each file, in the folder's order. */
  readings: Reading[];
  /** What was guessed, looks wrong or was left out. */
  warnings: ReaderWarning[];
}
