/** A recording of ROS in any container: the kinds of its topics, and the cameras and transforms that belong to a picture. */
import type { NamedCamera, NamedPose, Pose } from "../types.js";
import { badFile } from "../../errors.js";
import { belongs, cameraOfInfo } from "./infos.js";
import { type Decoder, type Message, frameOf, numberIn } from "./messages.js";
import { betweenStreams, isDepthUnit, isStreamMotion, unitOf } from "./realsense.js";
import { kindOfType, shotOf } from "./ros.js";
import type { Found, Shot, Source, Track } from "./source.js";
import { Transforms, isStatic, poseOfTransform } from "./transforms.js";

export interface RosTopic {
  name: string;
  type: string;
  count: number;
  /** The decoder of its messages, or the reason why they are not supported. */
  by: { decoder: Decoder } | { unread: string };
}

/** The topics of several channels; channels with the same name, for example of a publisher that was restarted, are one topic. */
export function byName(channels: Iterable<Omit<RosTopic, "by"> & { by: () => RosTopic["by"] }>): RosTopic[] {
  const found = new Map<string, RosTopic>();
  for (const { by, ...channel } of channels) {
    const known = found.get(channel.name);
    if (known) known.count += channel.count;
    else found.set(channel.name, { ...channel, by: by() });
  }
  return [...found.values()];
}

/** Largest size of an uncompressed chunk, bytes. Writers use about a megabyte, or one message. */
const MOST_CHUNK = 2 ** 30;

/** The declared size of an uncompressed chunk, checked before memory is allocated for it. */
export function chunkSize(size: number | bigint): number {
  if (size > MOST_CHUNK) throw badFile(`one of its chunks declares ${size} bytes`);
  return Number(size);
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

/** Largest number of /tf messages that are read: a minute of a robot's joints. */
const MOST_TRANSFORMS = 6000;

const isMotion = (name: string, { type }: { type: string }): boolean =>
  isStreamMotion(name) && /^geometry_msgs\/(?:msg\/)?Transform$/.test(type);

/** A topic as a track. */
export const trackOf = ({ name, type, count, by }: RosTopic): Track => ({
  name,
  type,
  count,
  kind: "unread" in by ? "other" : kindOfType(type),
  ...("unread" in by && kindOfType(type) !== "other" && { unread: by.unread }),
});

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
    this.tracks = file.topics.map((topic) => {
      const isRead = "decoder" in topic.by && isMotion(topic.name, topic);
      return { ...trackOf(topic), ...(isRead && { kind: "transforms" as const }) };
    });
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

  /** A value from the first message of each topic that is wanted. */
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
    this.#fixed ??= this.#transforms(trees.filter(isStatic), new Transforms());
    const fixed = (await this.#fixed).between(from.frame, to.frame);
    if (fixed) return { found: [fixed.pose], warnings: fixed.warnings };
    this.#all ??= this.#transforms(trees, new Transforms());
    const any = (await this.#all).between(from.frame, to.frame);
    return any ? { found: [any.pose], warnings: any.warnings } : { found: [], warnings: [] };
  }
}

/** The camera of a shot, from the topics of intrinsics: the one beside the shot's topic, or else one of the same frame. */
export function cameraFor(shot: Shot, infos: ReadonlyMap<string, Message>): Found<NamedCamera | undefined> {
  const hasFrame = shot.frame !== "";
  const [best] = [...infos]
    .map(([name, message]) => ({
      message,
      nearness: belongs(name, shot.track),
      isOfFrame: hasFrame && frameOf(message) === shot.frame,
    }))
    .filter(({ nearness, isOfFrame }) => nearness === 2 || (hasFrame ? isOfFrame : nearness === 1))
    .sort((a, b) => b.nearness - a.nearness || Number(b.isOfFrame) - Number(a.isOfFrame));
  if (best === undefined) return { found: undefined, warnings: [] };
  const warnings: Found<unknown>["warnings"] = [];
  const size = shot.width && shot.height ? { width: shot.width, height: shot.height } : undefined;
  return { found: cameraOfInfo(best.message, shot.track, size, warnings), warnings };
}
