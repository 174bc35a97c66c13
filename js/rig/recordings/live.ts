/**
 * The cameras of a robot, over a bridge: their topics are chosen as in a recording, and frames are taken one by one, each of a new view.
 *
 * Topics are subscribed to only while a frame is awaited, since a browser keeps all messages that come in.
 */
import { breathe } from "../../breathe.js";
import { wrong } from "../../check.js";
import { BimodalError, badFile, badNamed, reasonOf } from "../../errors.js";
import type { NamedPose, RigFolder } from "../types.js";
import { type Bridge, connect, noConnection } from "./bridge.js";
import type { Message } from "./messages.js";
import { type Pair, decoded, frameOf as frameOfMoment, judged, nearest, turnBetween } from "./pairs.js";
import { type Choice, rolesOf } from "./roles.js";
import { kindOfType, shotOf, unreadEncoding, unreadFirst } from "./ros.js";
import { cameraFor, trackOf } from "./ros-source.js";
import { ALIKE, type Signature, differenceOf, signatureOf } from "./signature.js";
import type { Found, Shot, Source, Track } from "./source.js";
import { type Topic, folderOf, topicsOf } from "./folder.js";
import { Transforms, isStatic } from "./transforms.js";

/** Milliseconds within which the first message of each topic must arrive. */
const FIRST = 4000;
/** Largest number of topics whose first message is awaited. */
const MOST_TOPICS = 40;
/** Shots of each topic among which the nearest pair is chosen. */
const KEPT = 8;
/** Milliseconds between two comparisons of the view. */
const PAUSE = 250;
/** Smallest difference of two different views: well above noise, since the robot is meant to move. */
const APART = 2.5 * ALIKE;
/** Milliseconds after which a frame is taken even if the view moves. */
const RESTLESS = 5000;
/** Largest difference of a pair's stamps, in seconds, at which the pair is taken before `RESTLESS` has passed. */
const NEAR = 0.02;

const wait = (milliseconds: number) => new Promise<void>((go) => setTimeout(go, milliseconds));

/** The topics of a view. */
export interface ViewChoice {
  /** The topic of the colour images. */
  colour: string;
  /** The topic of the depth maps or clouds. */
  depth: string;
  /** Cancels the wait; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** A connection to a robot whose topics are known. */
export interface Robot {
  /** The address of its bridge. */
  address: string;
  /** The name that the bridge gives. */
  name: string;
  /** All topics of the robot. */
  topics: Topic[];
  /** The topics that fit the two cameras best. */
  chosen: Choice;
  /** Fulfilled with the reason once the connection has ended. */
  closed: Promise<string>;
  /** Waits for a new view and takes its frame, with the cameras and the transform between these. */
  next(choice: ViewChoice): Promise<RigFolder>;
  /** Forgets the views that were taken. */
  restart(): void;
  /** Ends the connection. */
  close(): void;
}

/** The intrinsics and transforms that have come in. */
class Heard implements Pick<Source, "camera" | "poses"> {
  readonly infos = new Map<string, Message>();
  readonly fixed = new Transforms();
  readonly all = new Transforms();

  take(topic: string, type: string, message: Message): void {
    if (kindOfType(type) === "camera") this.infos.set(topic, message);
    else {
      this.all.add(message);
      if (isStatic(topic)) this.fixed.add(message);
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

/** The first message of each topic of images or clouds, or why it cannot be read; undefined for a topic that is late. */
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
          found.set(name, unreadFirst(error));
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
  readonly chosen: Choice;
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
        if (failure !== undefined) throw badFile(`a message cannot be read (${reasonOf(failure)})`);
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

  /** Compares incoming frames until the view is new and at rest. */
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
      const frame = { ...frameOfMoment(moment, 0), name: `view ${this.#taken.length}` };
      return folderOf(this.#heard, [moment], [frame], judged([moment]));
    }
  }
}

/** Connects to a foxglove_bridge and reads the first message of each topic of images or clouds. */
export async function connectRobot(address: string): Promise<Robot> {
  if (typeof address !== "string") throw wrong("address", "an address", address);
  const bridge = await connect(address);
  const tracks = bridge.topics.map(trackOf);
  const heard = new Heard();
  const besides = tracks.filter(({ kind }) => kind === "camera" || kind === "transforms").map(({ name }) => name);
  // Intrinsics and transforms are small, may come at any time, and may change.
  bridge.listen(besides, (topic, type, _, message) => heard.take(topic, type, message));
  const shots = await firstShots(bridge, tracks);
  if (!bridge.isOpen) throw noConnection(bridge.address, "the connection was lost");
  return new OpenRobot(bridge, heard, tracks, shots);
}
