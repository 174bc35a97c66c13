/** Opens a recording: lists its topics, chooses those of the two cameras, and takes frames from them. */
import { callback, object, ranged, signal, wrong } from "../../check.js";
import { BimodalError, badFile, badNamed, reasonOf } from "../../errors.js";
import { metresPerUnit } from "../read.js";
import type { RigFolder } from "../types.js";
import { type Topic, folderOf, topicsOf } from "./folder.js";
import { HEAD, containerOf } from "./kinds.js";
import { frameOf, moments } from "./pairs.js";
import { type Choice, rolesOf } from "./roles.js";
import { unreadEncoding, unreadFirst } from "./ros.js";
import { type Bytes, type Shot, type Source, bytesOf } from "./source.js";

export type { Topic } from "./folder.js";

/** The file of a recording. */
export interface RecordingFile {
  /** The name of the file; messages of errors begin with it. */
  name: string;
  /** The contents of the file; a blob is read in parts. */
  content: Blob | Uint8Array;
}

/** Options for taking frames from a recording. If a topic is not given, that of `chosen` is used. */
export interface RecordingOptions extends Choice {
  /** The largest number of frames; default 10. */
  frames?: number;
  /** Metres per stored unit of depth; without it, the unit in the recording, or millimetres for integers and metres for floats (REP 118). */
  unit?: number;
  /** Cancels the reading; the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Called with the progress, 0 to 1. */
  onProgress?: (share: number) => void;
}

/** A recording that has been opened. */
export interface Recording {
  /** The name of its file. */
  name: string;
  /** "MCAP", "MCAP without an index", "ROS 1 bag" or "Matroska". */
  format: string;
  /** A description with format, duration and number of topics. */
  says: string;
  /** Seconds from its first message to its last. */
  seconds: number;
  /** All topics or tracks of the recording. */
  topics: Topic[];
  /** The topics that fit the two cameras best. */
  chosen: Choice;
  /** Takes frames that differ, with their cameras and the transform between these. */
  read(options?: RecordingOptions): Promise<RigFolder>;
}

const FRAMES = 10;
/** Largest number of topics whose first message is read. */
const MOST_TOPICS = 100;

const topicName = (value: unknown, field: string): void => {
  if (typeof value !== "string") throw wrong(field, "a topic's name", value);
};
const checkOptions = object({
  colour: topicName,
  depth: topicName,
  frames: ranged({ kind: "whole", min: 1, max: 100 }),
  unit: metresPerUnit,
  signal,
  onProgress: callback,
});

async function sourceOf(bytes: Bytes): Promise<Source> {
  const container = containerOf(await bytes.read(0, HEAD));
  if (container === "mcap") return (await import("./mcap.js")).openMcap(bytes);
  if (container === "bag") return (await import("./bag.js")).openBag(bytes);
  if (container === "matroska") return (await import("./matroska.js")).openMatroska(bytes);
  throw badFile("it is not a supported recording; MCAP files, ROS 1 bags and the .mkv of an Azure Kinect are");
}

/** The first image or cloud of each topic, or why it cannot be read. */
async function firstShots(source: Source): Promise<Map<string, Shot | string>> {
  const found = new Map<string, Shot | string>();
  const wanted = source.tracks.filter(({ kind, count }) => (kind === "picture" || kind === "cloud") && count > 0);
  for (const { name } of wanted.slice(0, MOST_TOPICS)) {
    try {
      for await (const shot of source.shots([name], ...source.span)) {
        found.set(name, unreadEncoding(shot.encoding) ?? shot);
        break;
      }
    } catch (error) {
      found.set(name, unreadFirst(error));
    }
  }
  return found;
}

/** The topics that have intrinsics. */
async function knownCameras(source: Source, shots: Iterable<Shot | string>): Promise<Set<string>> {
  const known = new Set<string>();
  for (const shot of shots)
    if (typeof shot !== "string" && (await source.camera(shot).catch(() => undefined))?.found) known.add(shot.track);
  return known;
}

class OpenRecording implements Recording {
  readonly name: string;
  readonly format: string;
  readonly says: string;
  readonly seconds: number;
  readonly topics: Topic[];
  readonly chosen: Choice;
  readonly #source: Source;

  constructor(name: string, source: Source, topics: Topic[], chosen: Choice) {
    this.name = name;
    this.format = source.format;
    this.seconds = source.span[1] - source.span[0];
    this.topics = topics;
    this.chosen = chosen;
    this.#source = source;
    const what = source.format === "Matroska" ? "tracks" : "topics";
    this.says = `${source.format}, ${this.seconds.toFixed(1)} s, ${topics.length} ${what}`;
  }

  async read(options: RecordingOptions = {}): Promise<RigFolder> {
    checkOptions(options, "options");
    options.signal?.throwIfAborted();
    try {
      return await this.#read(options);
    } catch (error) {
      throw named(this.name, error);
    }
  }

  #topic(role: "colour" | "depth", wanted: string | undefined): string {
    const name = wanted ?? this.chosen[role];
    const what = role === "colour" ? "colour images" : "depth maps or organised clouds";
    if (name === undefined)
      throw badFile(`none of its ${this.topics.length} topics has supported ${what}${unreadOf(this.topics)}`);
    const topic = this.topics.find((each) => each.name === name);
    if (topic === undefined) throw badFile(`it has no topic ${name}`);
    if (topic.unread !== undefined) throw badFile(`${name}: ${topic.unread}`);
    return name;
  }

  async #read({
    colour,
    depth,
    frames: most = FRAMES,
    unit,
    signal,
    onProgress,
  }: RecordingOptions): Promise<RigFolder> {
    const wanted = {
      colour: this.#topic("colour", colour),
      depth: this.#topic("depth", depth),
      frames: most,
      ...(unit !== undefined && { unit }),
      ...(signal && { signal }),
      ...(onProgress && { onProgress }),
    };
    const found = await moments(this.#source, wanted);
    const [first] = found.moments;
    if (first === undefined)
      throw badFile(`${wanted.colour} and ${wanted.depth} have no images of the same time; choose other topics`);
    const start = this.#source.span[0];
    const frames = found.moments.map((moment) => frameOf(moment, start));
    return folderOf(this.#source, found.moments, frames, found.warnings);
  }
}

/** Topics that are not read, and why. */
function unreadOf(topics: readonly Topic[]): string {
  const unread = topics.filter((topic) => topic.unread !== undefined);
  const words = unread.slice(0, 4).map(({ name, unread: why }) => `${name}: ${why}`);
  return words.length === 0 ? "" : ` (${words.join("; ")}${unread.length > words.length ? "; .." : ""})`;
}

function named(name: string, error: unknown): unknown {
  if (error instanceof BimodalError)
    return error.code === "file" ? badNamed(name, error.message, error.cause, { ...error.details }) : error;
  if (error instanceof DOMException && error.name === "AbortError") return error;
  return badNamed(name, `it is damaged or cut off (${reasonOf(error)})`, error);
}

/** Opens a recording; its content tells its format. A blob is read in parts, so that it may be larger than memory. */
export async function openRecording(file: RecordingFile): Promise<Recording> {
  if (typeof file?.name !== "string" || !(file.content instanceof Uint8Array || file.content instanceof Blob))
    throw wrong("file", "{ name: string, content: Blob or Uint8Array }", file);
  try {
    const source = await sourceOf(bytesOf(file.content));
    const shots = await firstShots(source);
    const known = await knownCameras(source, shots.values());
    const sound = [...shots.values()].filter((shot) => typeof shot !== "string");
    return new OpenRecording(
      file.name,
      source,
      topicsOf(source.tracks, source.span, shots),
      rolesOf(sound, (track) => known.has(track)),
    );
  } catch (error) {
    throw named(file.name, error);
  }
}
