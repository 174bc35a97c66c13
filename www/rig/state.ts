/** The visitor's files and choices, and the interface through which the parts beside `rig.ts` use them. */

import type { CheckCue, CheckReport, Pinhole, Pose } from "../../pkg/index.js";
import type { ReaderWarning } from "./files";
import type { FramePlan, Kind, NamedCamera, Summary } from "./protocol";
import type { Sensor } from "./sensors";
import type { Session } from "./session";

export type Side = "colour" | "depth";

export interface Item {
  id: number;
  name: string;
  /** The contents. They are absent if the file was added with others, for example in a folder; it cannot then be read in another way. */
  blob?: Blob;
  state: "reading" | "read" | "failed";
  summary?: Summary;
  error?: string;
  as?: Kind;
  unit?: number;
  /** The visitor removed the frame of this file, so the file does not form a new frame automatically. */
  aside?: true;
  /** The calibration of this file has been adapted to the frames. */
  arranged?: true;
  /** The recording from which the file was taken; removing the recording also removes the file. */
  recording?: number;
  /** For a recording: the topics from which frames are taken, and the progress. */
  taking?: Taking;
}

export interface Taking {
  colour: string;
  depth: string;
  frames: number;
  state: "reading" | "read" | "failed";
  /** Progress, 0 to 1. */
  share: number;
  error?: string;
  /** The warnings of the reader about these frames; they are also among the notes of the rig. */
  notes: ReaderWarning[];
}

export interface Frame {
  id: number;
  name: string;
  colour?: number;
  depth?: number;
  mask?: number;
  paint?: Uint8Array;
  range?: [number, number];
}

/** A camera that the visitor typed in; empty fields are NaN. */
export interface TypedCamera {
  by: "focal" | "view";
  model: "brown" | "fisheye";
  fx: number;
  fy: number;
  cx: number;
  cy: number;
  /** Horizontal field of view, degrees. */
  view: number;
  distortion: number[];
}

export interface CameraChoice {
  /** "", "typed", "sensor", "same" as the colour camera, or the camera's place among those of the files, "3:0". */
  source: string;
  /** Whether the visitor has chosen the source; otherwise it follows the files. */
  chosen: boolean;
  typed: TypedCamera;
  /** The common sensor whose published figures are used. */
  sensor?: Sensor;
}

export interface Candidate {
  id: number;
  name: string;
  /** The source of the candidate, in words. */
  origin: string;
  pose: Pose;
  /** The file that the candidate came from; removing the file also removes the candidate. */
  file?: number;
  /** The reader's guesses about pasted text. */
  guessed?: ReaderWarning[];
}

/** A warning of a reader or of this page. */
export interface Doubt {
  code: string;
  message: string;
}

export interface Run {
  report: CheckReport;
  plans: FramePlan[];
  candidates: Record<string, Pose>;
  /** The cues that were used; absent for all. */
  cues: CheckCue[];
  /** Whether the identity was checked because no calibration was given. */
  estimateOnly: boolean;
  /** The guesses at the time of the run, in words. */
  guessed: string[];
  /** Further warnings about files and cameras. */
  doubts: Doubt[];
  /** Whether the depths are those of a LiDAR, in its axes. */
  isLidar: boolean;
  /** Width of the colour image, pixels; larger errors are outside the picture. */
  diagonal: number;
}

export const messageOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** The parts of a rig that pairing, warnings and undo use. */
export interface RigState {
  items: Item[];
  frames: Frame[];
  readonly cameras: Record<Side, CameraChoice>;
  candidates: Candidate[];
  /** The warnings of the readers of folders. */
  notes: ReaderWarning[];
  /** The cameras that the readers of folders would choose. */
  arranged: Partial<Record<Side, string>>;
  run: Run | undefined;
  /** The precision of each run, with its number of frames. */
  history: { frames: number; pixels: number; interval: [number, number] }[];
  readonly session: Session;
  /** The cameras of the files, by their places among them. */
  readonly given: { source: string; label: string; camera: NamedCamera }[];
  /** The frames that have both pictures. */
  readonly complete: Frame[];
  freshId(): number;
  /** Notifies the views. */
  changed(): void;
  addPose(pose: Summary["poses"][number], origin: string, file?: number): void;
  item(id: number | undefined): Item | undefined;
  of(kind: Kind): Item[];
  sizeOf(side: Side): { width: number; height: number } | undefined;
  cameraOf(side: Side): Pinhole | undefined;
  readonly needsDepthCamera: boolean;
}
