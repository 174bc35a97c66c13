/**
 * The interface of containers: tracks, and the data that was recorded on them within a span of time. Only the parts that are needed are
 * read, since a recording may be larger than memory.
 */
import type { NamedCamera, NamedPose, ReadOptions, RigReading } from "../types.js";
import type { ReaderWarning } from "../warnings.js";
import type { Turn } from "./axes.js";

/** The bytes of a recording, read in parts. */
export interface Bytes {
  size: number;
  read(from: number, length: number): Promise<Uint8Array>;
}

/** The kind of data on a track, as the check of a rig uses it. */
export type TrackKind = "picture" | "cloud" | "camera" | "transforms" | "other";

export interface Track {
  /** A topic, or a track's name. */
  name: string;
  /** The type of its messages, or its codec. */
  type: string;
  kind: TrackKind;
  /** Messages or blocks. */
  count: number;
  /** The reason why the track cannot be read. */
  unread?: string;
}

/** Decodes the shot; `turn` turns the axes of a cloud. */
export interface ShotOptions extends ReadOptions {
  turn?: Turn;
}

/** One image or cloud of a recording, decoded on demand. */
export interface Shot {
  track: string;
  /** Time of the recording, seconds. */
  logged: number;
  /** Time of the exposure, seconds on the camera's clock; undefined if the recording does not state it. */
  taken: number | undefined;
  /** The coordinate frame of its camera. */
  frame: string;
  /** How its pixels are stored: "rgb8", "16UC1", "JPEG". */
  encoding: string;
  /** Columns, if they are known before decoding. */
  width?: number;
  height?: number;
  bytes: number;
  read(options: ShotOptions): Promise<Content>;
}

type Unnamed<T> = T extends unknown ? Omit<T, "name"> : never;
export type Content = Unnamed<Extract<RigReading, { kind: "colour" | "depth" }>>;

export interface Found<T> {
  found: T;
  warnings: ReaderWarning[];
}

export interface Source {
  /** "MCAP", "ROS 1 bag" and so on. */
  format: string;
  tracks: Track[];
  /** Seconds of the first and the last message. */
  span: [number, number];
  /** The data of these tracks between two times of recording (both inclusive), in order of time. */
  shots(tracks: readonly string[], from: number, until: number): AsyncIterable<Shot>;
  /** The intrinsics of the camera that took a shot. */
  camera(shot: Shot): Promise<Found<NamedCamera | undefined>>;
  /** Motions that carry points from the frame of one shot into that of another. */
  poses(from: Shot, to: Shot): Promise<Found<NamedPose[]>>;
}

/** A blob or bytes as parts. */
export function bytesOf(content: Blob | Uint8Array): Bytes {
  if (content instanceof Uint8Array)
    return { size: content.length, read: async (from, length) => content.slice(from, from + length) };
  return {
    size: content.size,
    read: async (from, length) => new Uint8Array(await content.slice(from, from + length).arrayBuffer()),
  };
}
