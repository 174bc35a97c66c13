/** The messages between the page and its worker. The worker keeps all pixels; only summaries, pictures and numbers are exchanged. */

import type { CheckCue, CheckReport, PairKind, PairSample, Pinhole, Pose, Warning } from "../../pkg/index.js";
import type { Fault, Pair } from "../engine/protocol";
import type { InverseDepth, NamedPose, ReaderWarning, Reading, RigReading } from "./files";
import type { ReportInput } from "../../pkg/rig/write/report/index.js";
import type { Topic } from "./recordings";

/** The result of the check, with the page's guesses among its warnings. */
export interface WholeReport extends Omit<CheckReport, "warnings"> {
  warnings: (string | Pick<Warning, "message">)[];
}

export interface Mask {
  width: number;
  height: number;
  data: Uint8Array;
}

export type Kind = RigReading["kind"];
export type NamedCamera = {
  name?: string;
  camera: Pinhole;
  width?: number;
  height?: number;
  takes?: "colour" | "depth" | "both";
};

/** A file as read, without its pixels. */
export interface Summary extends Omit<Reading, "name"> {
  kind: Kind | "recording" | "robot";
  /** For a recording: its topics, and those chosen. */
  topics?: Topic[];
  chosen?: { colour?: string; depth?: string };
  /** The reader's guesses, such as the unit of a depth map. */
  guessed: string[];
  width?: number;
  height?: number;
  /** Metres per stored unit of a depth map, or of the depth maps to which a file of cameras belongs. */
  unit?: number;
  /** Whether the numbers of a depth map are stored as integers. */
  isWhole?: boolean;
  /** Whether it is an organised cloud, which needs no camera. */
  organised?: boolean;
  cameras: NamedCamera[];
  poses: NamedPose[];
  /** Whether a picture came with a camera that other frames do not share. */
  hasOwnCamera?: boolean;
}

/** One pair to check: files by their numbers, and their restrictions. */
export interface FramePlan {
  name: string;
  colour: number;
  depth: number;
  mask?: number;
  /** A mask that was drawn on the colour image and has its size; non-zero pixels are used. */
  paint?: Uint8Array;
  /** Nearest and farthest depth that is used, metres. */
  range?: [number, number];
  colourCamera?: Pinhole;
  depthCamera?: Pinhole;
}

/** Several files that belong together: a folder, or the example. */
export interface Assembly {
  /** The source of the poses, in words. */
  origin: string;
  items: { file: number; name: string; summary: Summary }[];
  frames: { name: string; colour: number; depth: number; mask?: number }[];
  cameras: NamedCamera[];
  poses: NamedPose[];
  warnings: ReaderWarning[];
}

/** The places of the files of a run's pair. */
export type PartName = "colour" | "depth" | "colourMask" | "depthMask";

/** A file of a run's pair, with its number if the worker has read it. */
export interface PartFile {
  file: number;
  name: string;
  blob: Blob;
}

/** Columns and rows of a picture. */
export interface PictureSize {
  width: number;
  height: number;
  organised?: boolean;
}

/** A camera, and the name of the file that gave it. */
export interface GivenCamera extends NamedCamera {
  file: string;
}

/** Columns, rows and depths in metres of the points, columns and rows of the depth edges, in the colour image. */
export interface Projection {
  points: Float32Array;
  edges: Float32Array;
}

export type PoseFormat = "matrix" | "opencv" | "kalibr" | "ros2" | "open3d" | "realsense";

/** Each kind of request, its content and its reply. */
export interface Calls {
  read: {
    ask: { file: number; name: string; blob: Blob; as?: Kind; unit?: number; inverse?: InverseDepth };
    answer: Summary;
  };
  /** The files of the Lab as the pair of a run; reports how a large one is reduced. */
  pair: {
    ask: {
      parts: Partial<Record<PartName, PartFile>>;
      colourCamera?: Pinhole;
      depthCamera?: Pinhole;
      unit?: number;
      inverse?: InverseDepth;
      transfer?: "srgb" | "linear";
    };
    answer: Pair;
  };
  /** The camera of each of two pictures, scaled to the size of the picture. */
  cameras: {
    ask: { cameras: GivenCamera[]; colour: PictureSize; depth: PictureSize };
    answer: { colour?: GivenCamera; depth?: GivenCamera; warnings: ReaderWarning[] };
  };
  /** The calibrations of single files, arranged like those of a folder: the cameras of its frames, and the poses that matter. */
  arrange: {
    ask: { frames: { colour: number; depth: number }[]; texts: number[] };
    answer: {
      cameras: { colour?: string; depth?: string };
      poses: (NamedPose & { file?: number })[];
      warnings: ReaderWarning[];
    };
  };
  /** Metres per stored unit of a depth map that was read with others. */
  unit: { ask: { file: number; unit: number }; answer: Summary };
  folder: { ask: { first: number; files: { name: string; blob: Blob }[] }; answer: Assembly };
  example: { ask: { first: number }; answer: Assembly };
  /** Takes frames from a recording that has been read. */
  take: { ask: { file: number; first: number; colour?: string; depth?: string; frames: number }; answer: Assembly };
  /** Opens a connection to a robot's bridge, which replaces an open one. */
  connect: {
    ask: { address: string };
    answer: { name: string; topics: Topic[]; chosen: { colour?: string; depth?: string } };
  };
  /** The next view of the robot that differs from those before; `fresh` forgets these. */
  observe: { ask: { first: number; colour: string; depth: string; fresh: boolean }; answer: Assembly };
  /** Ends the observation. */
  rest: { ask: object; answer: null };
  /** Answered with the reason once the connection has ended. */
  closed: { ask: object; answer: string };
  disconnect: { ask: object; answer: null };
  forget: { ask: { file: number }; answer: null };
  /** The picture at full size, or scaled to a maximum width; depths outside the range are grey. */
  picture: { ask: { file: number; range?: [number, number]; width?: number }; answer: ImageBitmap };
  /** The mask of an object in an RGBA picture, from marks in the order of the library. */
  suggest: { ask: { width: number; height: number; data: Uint8ClampedArray; marks: Uint8Array }; answer: Uint8Array };
  /** The part of a depth map within a range in metres where `paint`, which may have any size, is not zero. */
  within: { ask: { file: number; range?: [number, number]; paint?: Mask }; answer: Mask };
  /** A pair of the gallery. */
  rendered: { ask: { pair: PairKind }; answer: PairSample };
  /** The frames to which the following requests refer. */
  frames: { ask: { frames: FramePlan[] }; answer: null };
  check: { ask: { candidates: Record<string, Pose>; cues: CheckCue[] }; answer: CheckReport };
  overlay: { ask: { frame: number; pose: Pose }; answer: Projection };
  pose: {
    ask: { pose: Pose; format: PoseFormat; isEstimate: boolean };
    answer: { name: string; text: string; notes: string[] };
  };
  /** One cloud of the frame for each pose, in the colour camera's frame. */
  clouds: { ask: { frame: number; poses: { name: string; pose: Pose }[] }; answer: Uint8Array };
  /**
   * The files that were read, with sizes and hashes, and the hash of the numerics. A folder is listed by its files, not by the items made
   * from them.
   */
  inputs: {
    ask: { items: { file: number; name: string; says: string; notes: string[]; blob?: Blob }[] };
    answer: { inputs: ReportInput[]; module: string | undefined };
  };
}

export type CallKind = keyof Calls;
export type Request = { [K in CallKind]: { id: number; kind: K } & Calls[K]["ask"] }[CallKind] | { kind: "cancel" };
export type Answer =
  | { id: number; answer: Calls[CallKind]["answer"] }
  | { id: number; fault: Fault }
  | { id: number; share: number; message: string };
