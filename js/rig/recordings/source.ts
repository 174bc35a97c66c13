/**
 * A recording as its container gives it: tracks, and what was recorded on them within a span of time. Containers are read where something is
 * asked for, so that a recording may be larger than memory.
 */
import type { NamedCamera, NamedPose, ReadOptions, RigReading } from "../types.js";
import type { ReaderWarning } from "../warnings.js";
import type { Turn } from "./axes.js";

/** Bytes of a recording, read in parts. */
export interface Bytes {
  size: number;
  read(from: number, length: number): Promise<Uint8Array>;
}

/** What a track holds, as far as the check of a rig takes it. */
export type TrackKind = "picture" | "cloud" | "camera" | "transforms" | "other";

export interface Track {
  /** A topic, or a track's name. */
  name: string;
  /** The type of its messages, or its codec. */
  type: string;
  kind: TrackKind;
  /** Messages or blocks. */
  count: number;
  /** Why nothing can be read of it. */
  unread?: string;
}

/** How a shot is read; the points of a cloud in other axes. */
export interface ShotOptions extends ReadOptions {
  turn?: Turn;
}

/** One picture or cloud of a recording, decoded when it is asked for. */
export interface Shot {
  track: string;
  /** When it was recorded, seconds. */
  logged: number;
  /** When it was taken, seconds, by the clock of its camera; zero where nobody said. */
  taken: number;
  /** The coordinate frame that it was taken in. */
  frame: string;
  /** How its pixels are stored: "rgb8", "16UC1", "JPEG". */
  encoding: string;
  /** Of pictures whose size is known before they are decoded. */
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
  /** What was recorded on these tracks between two times of recording, both included, in order. */
  shots(tracks: readonly string[], from: number, until: number): AsyncIterable<Shot>;
  /** The intrinsics of the camera that took a shot. */
  camera(shot: Shot): Promise<Found<NamedCamera | undefined>>;
  /** Motions that carry points of one shot's frame into another's. */
  poses(from: Shot, to: Shot): Promise<Found<NamedPose[]>>;
}

/** A blob or bytes, by parts. */
export function bytesOf(content: Blob | Uint8Array): Bytes {
  if (content instanceof Uint8Array)
    return { size: content.length, read: async (from, length) => content.slice(from, from + length) };
  return {
    size: content.size,
    read: async (from, length) => new Uint8Array(await content.slice(from, from + length).arrayBuffer()),
  };
}
