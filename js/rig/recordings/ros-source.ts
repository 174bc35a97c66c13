/** A recording of ROS, whatever its container: which topics hold what, and what goes with a picture. */
import type { NamedCamera, NamedPose, Pose } from "../types.js";
import { belongs, cameraOfInfo } from "./infos.js";
import { type Decoder, type Message, frameOf, numberIn } from "./messages.js";
import { betweenStreams, isDepthUnit, isStreamMotion, unitOf } from "./realsense.js";
import { kindOfType, shotOf } from "./ros.js";
import type { Found, Shot, Source, Track } from "./source.js";
import { Transforms, poseOfTransform } from "./transforms.js";

export interface RosTopic {
  name: string;
  type: string;
  count: number;
  /** The reader of its messages, or why there is none. */
  by: { decoder: Decoder } | { unread: string };
}

/** A container's messages as bytes. */
export interface RosFile {
  format: string;
  topics: RosTopic[];
  span: [number, number];
  messages(
    topics: readonly string[],
    from: number,
    until: number,
  ): AsyncIterable<{ topic: string; time: number; bytes: Uint8Array }>;
}

/** Messages of /tf that are looked at: a minute of a robot's joints. */
const MOST_TRANSFORMS = 6000;

const isMotion = (name: string, { type }: { type: string }): boolean =>
  isStreamMotion(name) && /^geometry_msgs\/(?:msg\/)?Transform$/.test(type);

/** How well the intrinsics of a topic go with a shot: by the names of the topics and of the frames. */
export function fitOf(info: string, frame: string, shot: Shot): number {
  const isSame = frame !== "" && frame === shot.frame;
  return 2 * belongs(info, shot.track) + (isSame ? 1 : 0);
}

/** At least the same frame, or a name beside it. */
export const isFit = (fit: number, hasFrames: boolean): boolean => fit >= 4 || (hasFrames ? fit % 2 === 1 : fit >= 2);

export class RosSource implements Source {
  readonly format: string;
  readonly tracks: Track[];
  readonly span: [number, number];
  readonly #file: RosFile;
  readonly #topics: Map<string, RosTopic>;
  #infos: Promise<Map<string, Message>> | undefined;
  #units: Promise<Map<string, number>> | undefined;
  #fixed: Promise<Transforms> | undefined;
  #all: Promise<Transforms> | undefined;

  constructor(file: RosFile) {
    this.#file = file;
    this.format = file.format;
    this.span = file.span;
    this.#topics = new Map(file.topics.map((topic) => [topic.name, topic]));
    this.tracks = file.topics.map(({ name, type, count, by }) => ({
      name,
      type,
      count,
      kind: "unread" in by ? "other" : isMotion(name, { type }) ? "transforms" : kindOfType(type),
      ...("unread" in by && kindOfType(type) !== "other" && { unread: by.unread }),
    }));
  }

  async *#decoded(topics: readonly string[], from: number, until: number) {
    for await (const { topic, time, bytes } of this.#file.messages(topics, from, until)) {
      const known = this.#topics.get(topic);
      if (known && "decoder" in known.by) yield { topic, type: known.type, time, message: known.by.decoder(bytes) };
    }
  }

  async *shots(tracks: readonly string[], from: number, until: number): AsyncIterable<Shot> {
    this.#units ??= this.#firsts(isDepthUnit, (message) => numberIn(message, "data"));
    const units = await this.#units;
    for await (const { topic, type, time, message } of this.#decoded(tracks, from, until))
      yield shotOf(topic, type, time, message, unitOf(topic, units));
  }

  /** What the first message of each of some topics says. */
  async #firsts<T>(
    isWanted: (name: string, track: Track) => boolean,
    of: (message: Message) => T,
  ): Promise<Map<string, T>> {
    const found = new Map<string, T>();
    for (const track of this.tracks) {
      if (track.count === 0 || !isWanted(track.name, track)) continue;
      for await (const { message } of this.#decoded([track.name], ...this.span)) {
        found.set(track.name, of(message));
        break;
      }
    }
    return found;
  }

  async camera(shot: Shot): Promise<Found<NamedCamera | undefined>> {
    this.#infos ??= this.#firsts(
      (_, { kind }) => kind === "camera",
      (message) => message,
    );
    return cameraFor(shot, await this.#infos);
  }

  async #transforms(topics: readonly string[], into: Transforms): Promise<Transforms> {
    let count = 0;
    if (topics.length > 0)
      for await (const { message } of this.#decoded(topics, ...this.span)) {
        into.add(message);
        if (++count >= MOST_TRANSFORMS) break;
      }
    return into;
  }

  async poses(from: Shot, to: Shot): Promise<Found<NamedPose[]>> {
    const warnings: Found<unknown>["warnings"] = [];
    const motions = await this.#firsts<Pose>(isMotion, (message) => poseOfTransform(message, warnings));
    const streams = betweenStreams(from, to, motions);
    if (streams) return { found: [streams], warnings };
    const trees = this.tracks
      .filter(({ type, kind, count }) => kind === "transforms" && kindOfType(type) === kind && count > 0)
      .map(({ name }) => name);
    const isFixed = (name: string) => /static/i.test(name);
    this.#fixed ??= this.#transforms(trees.filter(isFixed), new Transforms());
    const fixed = (await this.#fixed).between(from.frame, to.frame);
    if (fixed) return { found: [fixed.pose], warnings: fixed.warnings };
    this.#all ??= this.#transforms(trees, new Transforms());
    const any = (await this.#all).between(from.frame, to.frame);
    return any ? { found: [any.pose], warnings: any.warnings } : { found: [], warnings: [] };
  }
}

/** The camera of a shot among those that topics of intrinsics describe. */
export function cameraFor(shot: Shot, infos: ReadonlyMap<string, Message>): Found<NamedCamera | undefined> {
  const hasFrames = shot.frame !== "";
  const [best] = [...infos]
    .map(([name, message]) => ({ message, fit: fitOf(name, frameOf(message), shot) }))
    .filter(({ fit }) => isFit(fit, hasFrames))
    .sort((a, b) => b.fit - a.fit);
  if (best === undefined) return { found: undefined, warnings: [] };
  const warnings: Found<unknown>["warnings"] = [];
  const size = shot.width && shot.height ? { width: shot.width, height: shot.height } : undefined;
  return { found: cameraOfInfo(best.message, shot.track, size, warnings), warnings };
}
