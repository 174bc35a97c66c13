/**
 * A robot's own cameras, over a bridge: the topics of the two are found as in a recording, and frames are taken one by one, each of another
 * view than those before.
 *
 * Topics are subscribed to while a frame is looked for and no longer: a browser keeps whatever comes in.
 */
import { breathe } from "../../breathe.js";
import { wrong } from "../../check.js";
import { BimodalError, badFile, badNamed } from "../../errors.js";
import type { NamedPose, RigFolder } from "../types.js";
import type { ReaderWarning } from "../warnings.js";
import { type Bridge, connect, noConnection } from "./bridge.js";
import type { Message } from "./messages.js";
import { type Pair, decoded, frameOf as frameOfMoment, judge, nearest, turnBetween } from "./pairs.js";
import { rolesOf } from "./roles.js";
import { kindOfType, shotOf, unreadEncoding } from "./ros.js";
import { cameraFor } from "./ros-source.js";
import { ALIKE, type Signature, differenceOf, signatureOf } from "./signature.js";
import type { Found, Shot, Source, Track } from "./source.js";
import { type Topic, folderOf, topicsOf } from "./folder.js";
import type { Choice } from "./open.js";
import { Transforms } from "./transforms.js";

/** Milliseconds that each topic has for its first message. */
const FIRST = 4000;
/** Topics of pictures that are looked into. */
const MOST_TOPICS = 40;
/** Shots of each topic that are held against each other. */
const KEPT = 8;
/** Milliseconds between two looks at what comes in. */
const PAUSE = 250;
/** Two views differ by more than this to count as two: more than noise, since a robot's move is asked for. */
const APART = 2.5 * ALIKE;
/** Milliseconds after which a frame is taken though the view moves. */
const RESTLESS = 5000;
/** Stamps this near, in seconds, are of one moment. */
const NEAR = 0.02;

const wait = (milliseconds: number) => new Promise<void>((go) => setTimeout(go, milliseconds));

/** What a view is taken of. */
export interface ViewChoice {
  /** The topic of the colour images. */
  colour: string;
  /** The topic of the depth maps or organised clouds. */
  depth: string;
  /** Ends the looking; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** A connection whose topics have been looked into. */
export interface Robot {
  /** As it was opened. */
  address: string;
  /** What the server calls itself. */
  name: string;
  /** All of its topics. */
  topics: Topic[];
  /** Those that look like the two cameras'. */
  chosen: Choice;
  /** Is fulfilled with the reason once the connection has ended. */
  closed: Promise<string>;
  /** The next frame of another view than those before, with cameras and the transform between them. */
  next(choice: ViewChoice): Promise<RigFolder>;
  /** Forgets which views were taken. */
  restart(): void;
  /** Ends the connection. */
  close(): void;
}

/** What has come in besides pictures; the same answers as a recording's. */
class Heard implements Pick<Source, "camera" | "poses"> {
  readonly infos = new Map<string, Message>();
  readonly fixed = new Transforms();
  readonly all = new Transforms();

  take(topic: string, type: string, message: Message): void {
    if (kindOfType(type) === "camera") this.infos.set(topic, message);
    else {
      this.all.add(message);
      if (/static/i.test(topic)) this.fixed.add(message);
    }
  }

  async camera(shot: Shot) {
    return cameraFor(shot, this.infos);
  }

  async poses(from: Shot, to: Shot): Promise<Found<NamedPose[]>> {
    const found = this.fixed.between(from.frame, to.frame) ?? this.all.between(from.frame, to.frame);
    return found ? { found: [found.pose], warnings: found.warnings } : { found: [], warnings: [] };
  }
}

const tracksOf = (bridge: Bridge): Track[] =>
  bridge.topics.map(({ name, type, count, by }) => ({
    name,
    type,
    count,
    kind: "unread" in by ? "other" : kindOfType(type),
    ...("unread" in by && kindOfType(type) !== "other" && { unread: by.unread }),
  }));

/** The first message of each topic of pictures or clouds; of what comes late nothing. */
async function firstShots(bridge: Bridge, tracks: readonly Track[]): Promise<Map<string, Shot | string>> {
  const found = new Map<string, Shot | string>();
  const wanted = tracks.filter(({ kind }) => kind === "picture" || kind === "cloud").slice(0, MOST_TOPICS);
  const ended = wanted.map(({ name }) => {
    let stop = () => {};
    const first = new Promise<void>((end) => {
      stop = bridge.listen(
        [name],
        (topic, type, time, message) => {
          const shot = shotOf(topic, type, time, message);
          found.set(topic, unreadEncoding(shot.encoding) ?? shot);
          end();
        },
        (error) => {
          found.set(name, `its first message cannot be read (${String(error)})`);
          end();
        },
      );
    });
    return Promise.race([first, wait(FIRST)]).finally(() => stop());
  });
  await Promise.race([Promise.all(ended), bridge.closed]);
  return found;
}

class OpenRobot implements Robot {
  readonly address: string;
  readonly name: string;
  readonly closed: Promise<string>;
  readonly topics: Topic[];
  readonly chosen: Robot["chosen"];
  readonly #bridge: Bridge;
  readonly #heard: Heard;
  #taken: Signature[] = [];

  constructor(bridge: Bridge, heard: Heard, tracks: Track[], shots: ReadonlyMap<string, Shot | string>) {
    this.#bridge = bridge;
    this.#heard = heard;
    this.address = bridge.address;
    this.name = bridge.name;
    this.closed = bridge.closed;
    this.topics = topicsOf(tracks, [0, 0], shots);
    const sound = [...shots.values()].filter((shot) => typeof shot !== "string");
    const known = (track: string) =>
      sound.some((shot) => shot.track === track && cameraFor(shot, heard.infos).found !== undefined);
    this.chosen = rolesOf(sound, known);
  }

  close(): void {
    this.#bridge.close();
  }

  restart(): void {
    this.#taken = [];
  }

  async next({ colour, depth, signal }: ViewChoice): Promise<RigFolder> {
    for (const name of [colour, depth])
      if (!this.topics.some((topic) => topic.name === name)) throw badNamed(this.address, `it has no topic ${name}`);
    const shots: Record<string, Shot[]> = { [colour]: [], [depth]: [] };
    let failure: unknown;
    const stop = this.#bridge.listen(
      [colour, depth],
      (topic, type, time, message) => {
        const kept = shots[topic];
        kept?.push(shotOf(topic, type, time, message));
        if (kept && kept.length > KEPT) kept.shift();
      },
      (error) => (failure = error),
    );
    try {
      return await this.#look(() => {
        if (failure !== undefined) throw badFile(`a message cannot be read (${String(failure)})`);
        return nearest(shots[colour] ?? [], shots[depth] ?? []);
      }, signal);
    } catch (error) {
      throw error instanceof BimodalError && error.code === "file"
        ? badNamed(this.address, error.message, error)
        : error;
    } finally {
      stop();
    }
  }

  /** Looks at what comes in until the view rests and is another one. */
  async #look(pairNow: () => Pair | undefined, signal: AbortSignal | undefined): Promise<RigFolder> {
    let before: { signature: Signature; pair: Pair } | undefined;
    const start = performance.now();
    for (;;) {
      await Promise.race([wait(PAUSE), this.closed]);
      await breathe();
      signal?.throwIfAborted();
      if (!this.#bridge.isOpen) throw noConnection(this.address, "the connection was lost");
      const pair = pairNow();
      if (!pair || pair.colour === before?.pair.colour) continue;
      const moment = await decoded(pair, undefined, await turnBetween(this.#heard, pair));
      const signature = signatureOf(moment.image.image, moment.map.depth);
      const isStill = before !== undefined && differenceOf(before.signature, signature) < ALIKE;
      before = { signature, pair };
      const isNew = this.#taken.every((other) => differenceOf(other, signature) > APART);
      const isLate = performance.now() - start > RESTLESS;
      if (!isNew || !(isLate || (isStill && pair.apart < NEAR))) continue;
      this.#taken.push(signature);
      const warnings: ReaderWarning[] = [];
      judge([moment], 1, 1, warnings);
      const frame = { ...frameOfMoment(moment, 0), name: `view ${this.#taken.length}` };
      return folderOf(this.#heard, [moment], [frame], warnings);
    }
  }
}

/** Opens a connection to a foxglove_bridge and looks into its topics. */
export async function connectRobot(address: string): Promise<Robot> {
  if (typeof address !== "string") throw wrong("address", "an address", address);
  const bridge = await connect(address);
  const tracks = tracksOf(bridge);
  const heard = new Heard();
  const besides = tracks.filter(({ kind }) => kind === "camera" || kind === "transforms").map(({ name }) => name);
  // Intrinsics and transforms are small; they may come at any time, and change.
  bridge.listen(besides, (topic, type, _, message) => heard.take(topic, type, message));
  const shots = await firstShots(bridge, tracks);
  if (!bridge.isOpen) throw noConnection(bridge.address, "the connection was lost");
  return new OpenRobot(bridge, heard, tracks, shots);
}
