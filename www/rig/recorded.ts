/** Recordings and robots in the worker. Loaded with the first recording or connection. */

import type { CheckFrame } from "../../pkg/index.js";
import type { RigFolder } from "../../pkg/rig/index.js";
import type { Assembly, Calls, Summary } from "./protocol";
import { type Recording, type Robot, connectRobot, openRecording } from "./recordings";

/** Frames with their cameras and warnings, before the worker keeps their pixels. */
export interface Taken extends Pick<Assembly, "origin" | "cameras" | "poses" | "warnings"> {
  frames: CheckFrame[];
}

/** The cameras are listed once, under the recording's own name. */
const withoutCameras = ({ image: { camera: _, ...image }, depth: { camera: __, ...depth }, ...frame }: CheckFrame) => ({
  ...frame,
  image,
  depth,
});

const takenOf = (origin: string, { frames, cameras, poses, warnings }: RigFolder): Taken => ({
  origin,
  frames: frames.map(withoutCameras),
  cameras,
  // The reader determines the direction, because frames are named by the robot here and do not state colour and depth.
  poses: poses.map(({ name = "tf", pose }) => ({ name, pose })),
  warnings,
});

type Ask<K extends keyof Calls> = Omit<Calls[K]["ask"], "first">;

export class Recorded {
  readonly #recordings = new Map<number, Recording>();
  #robot: Robot | undefined;
  /** The observer of the connection. */
  #looking: AbortController | undefined;

  async open(file: number, name: string, blob: Blob): Promise<Summary> {
    const recording = await openRecording({ name, content: blob });
    this.#recordings.set(file, recording);
    const { says, topics, chosen } = recording;
    return { kind: "recording", says, warnings: [], guessed: [], cameras: [], poses: [], topics, chosen };
  }

  async take({ file, colour, depth, frames }: Ask<"take">, onProgress: (share: number) => void): Promise<Taken> {
    const recording = this.#recordings.get(file);
    if (!recording) throw new Error(`Recording ${file} has not been read.`);
    const topics = { ...(colour && { colour }), ...(depth && { depth }) };
    return takenOf(recording.name, await recording.read({ ...topics, frames, onProgress }));
  }

  forget(file: number): void {
    this.#recordings.delete(file);
  }

  async connect(address: string): Promise<Calls["connect"]["answer"]> {
    this.disconnect();
    this.#robot = await connectRobot(address);
    const { name, topics, chosen } = this.#robot;
    return { name, topics, chosen };
  }

  /** The connected robot; a request after the connection has ended throws. */
  #connected(): Robot {
    if (!this.#robot) throw new Error("There is no connection to a robot.");
    return this.#robot;
  }

  async observe({ colour, depth, fresh }: Ask<"observe">): Promise<Taken> {
    const robot = this.#connected();
    if (fresh) robot.restart();
    this.#looking = new AbortController();
    return takenOf(robot.address, await robot.next({ colour, depth, signal: this.#looking.signal }));
  }

  rest(): void {
    this.#looking?.abort();
  }

  closed(): Promise<string> {
    return this.#connected().closed;
  }

  disconnect(): void {
    this.#robot?.close();
    this.#robot = undefined;
  }
}
