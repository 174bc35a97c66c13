/** The types of the readers' results. */
import type { CheckFrame, Mask, Pinhole, Pose } from "../types/index.js";
import type { InverseDepth } from "./inverse.js";
import type { Scan } from "./lidar/scan.js";
import type { ReaderWarning } from "./warnings.js";

export type { CheckFrame, InverseDepth, Mask, Pinhole, Pose, ReaderWarning, Scan };

/** A file as it was dropped or read. The name may contain a path, such as "depth/0001.png". */
export interface NamedFile {
  /** Name or path; it distinguishes depth from colour if the content does not. */
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
  /** The camera's name in its file, or the name of the file. */
  name?: string;
  /** The intrinsics, pixels. */
  camera: Pinhole;
  /** Columns of its pictures, if the file gives them. */
  width?: number;
  /** Rows of its pictures, if the file gives them. */
  height?: number;
  /** The kind of pictures that it took, if the file states it; "both" if depth maps are registered to its colour images. */
  takes?: "colour" | "depth" | "both";
}

/** A description of what was read from a file. */
export interface Reading {
  /** The name of the file. */
  name: string;
  /** What was read, in plain words: "640x480, 16-bit, read as millimetres, 92.8 % valid, 1.39 to 6.69 m". */
  says: string;
  /** What was guessed or looks wrong. */
  warnings: ReaderWarning[];
  /** Whether a picture is stored without colour channels. */
  isGrey?: boolean;
  /** Figures of a depth map or cloud. */
  measured?: {
    /** The storage of its numbers: "16-bit". */
    stored: string;
    /** Share of valid pixels, 0 to 1. */
    valid: number;
    /** The nearest and the farthest depth, metres. */
    range: [number, number];
  };
}

/** What a file holds. */
export type RigReading = Reading &
  (
    | {
        /** What the file holds. */
        kind: "colour";
        /** The image, without a camera. */
        image: CheckFrame["image"];
      }
    | {
        /** What the file holds. */
        kind: "depth";
        /** The depth map, with its unit. */
        depth: CheckFrame["depth"];
        /** Members of the depth map that the file does not give and that were guessed from its values. */
        guessed: "unit"[];
        /** The unorganised points of the file in metres, if `depth` was made from them. */
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
        /** Metres per stored unit of the depth maps beside the file, if the file gives it. */
        depthUnit?: number;
      }
    | {
        /** What the file holds. */
        kind: "poses";
        /** In the order of the file. */
        poses: NamedPose[];
      }
  );

export type DepthReading = Extract<RigReading, { kind: "depth" }>;

/** A reading before the name of its file is added. */
export type Unnamed<T> = T extends unknown ? Omit<T, "name"> : never;

/** How `readRigFile` reads. */
export interface ReadOptions {
  /** The kind of reading that the caller wants; by default the content decides. */
  as?: RigReading["kind"];
  /** Metres per stored unit of a depth map or cloud; by default the values decide. */
  unit?: number;
  /** How the stored numbers become depths if they are disparities or inverse depths, which are larger for nearer surfaces. */
  inverse?: InverseDepth;
  /** Width and height of raw pixels (.raw, .bin), which have no header. */
  size?: readonly [width: number, height: number];
  /** Stops the reading; the promise is rejected with the signal's reason. */
  signal?: AbortSignal;
}

/** What was read from a folder of frames. */
export interface RigFolder {
  /** Pairs of an image and a depth map, with the cameras that were found for them. */
  frames: CheckFrame[];
  /** All cameras of the folder's files. */
  cameras: NamedCamera[];
  /** Poses that relate two cameras. */
  poses: NamedPose[];
  /** What was read from each file, pictures first. */
  readings: Reading[];
  /** What was guessed, looks wrong or was left out. */
  warnings: ReaderWarning[];
}
