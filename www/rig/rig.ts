/** The visitor's files and choices: files, frames, cameras, candidates, and the result of the check. */

import type { CheckCue, Pinhole } from "../../pkg/index.js";
import { arrange } from "./arrange";
import { Live } from "./live";
import { pairUp } from "./pairing";
import { doubtsOf } from "./doubts";
import type { ReaderWarning } from "./files";
import { identity, inverse, isOfWorld } from "./poses";
import type { Assembly, FramePlan, Kind, NamedCamera, Summary } from "./protocol";
import { Session } from "./session";
import {
  type CameraChoice,
  type Candidate,
  type Frame,
  type Item,
  type RigState,
  type Run,
  type Side,
  messageOf,
} from "./state";
import { Takings } from "./takings";
import { choice, emptyCamera, fromSensor, fromTyped } from "./typed";
import { Undo } from "./undo";
import { isBackwards, isOfScan } from "./words";

export { messageOf } from "./state";
export { typedFrom } from "./typed";
export type { CameraChoice, Candidate, Frame, Item, Run, Side, TypedCamera } from "./state";

export class Rig implements RigState {
  readonly session = new Session();
  readonly undo = new Undo(this);
  readonly takings = new Takings(this);
  readonly live = new Live(this);
  items: Item[] = [];
  frames: Frame[] = [];
  readonly cameras: Record<Side, CameraChoice> = { colour: choice(), depth: choice() };
  candidates: Candidate[] = [];
  cues: CheckCue[] = [];
  /** The warnings of the readers of folders. */
  notes: ReaderWarning[] = [];
  /** The cameras that the readers of folders would choose. */
  arranged: Partial<Record<Side, string>> = {};
  /** A description of the folder that is being read. */
  busy = "";
  run: Run | undefined;
  /** The precision of each run, with its number of frames. */
  history: { frames: number; pixels: number; interval: [number, number] }[] = [];
  #last = 0;
  #listeners: (() => void)[] = [];
  #told = false;

  constructor() {
    // A robot's pictures cannot be read again.
    this.session.onReplaced = () => {
      for (const item of this.items.filter(({ summary }) => summary?.kind === "robot")) this.#drop(item);
      this.changed();
    };
  }

  freshId(): number {
    return ++this.#last;
  }

  listen(listener: () => void): void {
    this.#listeners.push(listener);
  }

  /** Notifies the views, once for any number of changes. */
  changed(): void {
    if (this.#told) return;
    this.#told = true;
    queueMicrotask(() => {
      this.#told = false;
      for (const listener of this.#listeners) listener();
    });
  }

  item(id: number | undefined): Item | undefined {
    return this.items.find((item) => item.id === id);
  }

  of(kind: Kind): Item[] {
    return this.items.filter(({ state, summary }) => state === "read" && summary?.kind === kind);
  }

  async add(files: readonly { name: string; blob: Blob }[]): Promise<void> {
    const items = files.map(({ name, blob }): Item => ({ id: this.freshId(), name, blob, state: "reading" }));
    this.items.push(...items);
    this.changed();
    await Promise.all(items.map((item) => this.#read(item)));
    this.frames = pairUp(this);
    await arrange(this).catch(() => {});
    this.#chooseCameras();
    this.changed();
  }

  /** Reads a file again, as another kind or in another unit. */
  async reread(item: Item): Promise<void> {
    await this.#read(item);
    if (!this.items.includes(item)) return;
    delete item.aside;
    this.#unlink(item);
    this.frames = pairUp(this);
    this.changed();
  }

  /** Depth maps whose unit is a guess. */
  get unitsGuessed(): Item[] {
    return this.of("depth").filter(({ summary }) => summary?.guessed.includes("unit"));
  }

  /** A rig has one depth camera, so other depth maps whose unit is a guess also get this unit. */
  async setUnit(item: Item, unit: number): Promise<void> {
    const together = item.blob ? [] : this.of("depth").filter(({ blob }) => !blob);
    await this.#giveUnits(new Map([item, ...together, ...this.unitsGuessed].map((each) => [each, unit])));
  }

  /** Confirms all guesses. */
  async confirmUnits(): Promise<void> {
    await this.#giveUnits(new Map(this.unitsGuessed.map((item) => [item, item.summary?.unit ?? 1])));
  }

  async #giveUnits(units: ReadonlyMap<Item, number>): Promise<void> {
    for (const [item, unit] of units) {
      item.unit = unit;
      if (item.blob) await this.reread(item);
      else item.summary = await this.session.call("unit", { file: item.id, unit });
    }
    if (this.unitsGuessed.length === 0) this.notes = this.notes.filter(({ code }) => code !== "unit-guessed");
    this.changed();
  }

  async #read(item: Item): Promise<void> {
    const { id, name, blob, as, unit } = item;
    if (!blob) return;
    item.state = "reading";
    this.changed();
    try {
      const summary = await this.session.call("read", {
        file: id,
        name,
        blob,
        ...(as ? { as } : {}),
        ...(unit === undefined ? {} : { unit }),
      });
      if (!this.items.includes(item)) return;
      Object.assign(item, { state: "read", summary });
      delete item.error;
      this.#take(item, summary);
      if (summary.kind === "recording") await this.takings.take(item);
    } catch (error) {
      item.state = "failed";
      delete item.summary;
      item.error = messageOf(error);
    }
    this.changed();
  }

  /** Assigns cameras and poses of a file to their uses. */
  #take(item: Item, summary: Summary): void {
    this.candidates = this.candidates.filter(({ file }) => file !== item.id);
    for (const each of summary.poses) if (!isOfWorld(each)) this.addPose(each, item.name, item.id);
    this.#chooseCameras();
  }

  /** Inverts a pose whose frame names say that it leads from the colour camera, or to the depth camera or a LiDAR. */
  addPose({ name, pose, from, to }: Summary["poses"][number], origin: string, file?: number): Candidate {
    const isBackward = isBackwards({ from, to });
    const direction = isBackward
      ? `, given from ${from ?? "colour"} to ${to ?? "depth"} and inverted`
      : from && to
        ? `, from ${from} to ${to}`
        : "";
    const candidate: Candidate = {
      id: this.freshId(),
      name: this.#freshName(name || origin.replace(/\.\w+$/, "").replace(/^.*\//, "")),
      origin: `${origin}${direction}`,
      pose: isBackward ? inverse(pose) : pose,
      ...(file === undefined ? {} : { file }),
    };
    this.candidates.push(candidate);
    this.changed();
    return candidate;
  }

  #freshName(wanted: string): string {
    const names = new Set(this.candidates.map(({ name }) => name));
    for (let i = 1; ; i++) {
      const name = i === 1 ? wanted : `${wanted} ${i}`;
      if (!names.has(name)) return name;
    }
  }

  removeFrame(frame: Frame): void {
    this.undo.keep(`removing ${frame.name}`);
    this.frames = this.frames.filter((each) => each !== frame);
    for (const role of ["colour", "depth"] as const) {
      const item = this.item(frame[role]);
      if (item && !this.frames.some((each) => each[role] === item.id)) item.aside = true;
    }
    this.changed();
  }

  remove(item: Item): void {
    this.undo.keep(`removing ${item.name}`, {
      isMoot: () => this.items.some(({ id, name }) => name === item.name && id > item.id),
    });
    this.#drop(item);
    this.frames = pairUp(this);
    this.changed();
  }

  #drop(item: Item): void {
    this.candidates = this.candidates.filter(({ file }) => file !== item.id);
    this.notes = this.notes.filter((note) => !item.taking?.notes.includes(note));
    this.leave([item, ...this.items.filter(({ recording }) => recording === item.id)]);
    this.#chooseCameras();
  }

  /** Removes files, and everything derived from them. */
  leave(items: readonly Item[]): void {
    this.items = this.items.filter((each) => !items.includes(each));
    for (const item of items) this.#unlink(item);
  }

  /** Removes from the frames a file that was removed or has changed its kind. */
  #unlink({ id }: Item): void {
    for (const frame of this.frames) {
      for (const role of ["colour", "depth", "mask"] as const) {
        if (frame[role] === id && !this.of(role).some((item) => item.id === id)) {
          delete frame[role];
          if (role === "colour") delete frame.paint;
        }
      }
    }
    this.frames = this.frames.filter(({ colour, depth }) => colour !== undefined || depth !== undefined);
  }

  /** Removes everything, and ends a running check, which refers to the removed files. */
  clear(): void {
    this.live.stop();
    this.session.cancel();
    if (this.items.length + this.frames.length + this.candidates.length > 0)
      this.undo.keep("starting over", { isWhole: true });
    Object.assign(this, { items: [], frames: [], candidates: [], notes: [], arranged: {}, history: [] });
    this.run = undefined;
    // The forms of the page refer to these objects.
    for (const side of ["colour", "depth"] as const) {
      Object.assign(this.cameras[side], { source: "", chosen: false });
      Object.assign(this.cameras[side].typed, emptyCamera());
    }
    this.changed();
  }

  async addFolder(files: { name: string; blob: Blob }[]): Promise<void> {
    const first = this.reserve(3 * files.length);
    this.busy = `Reading a folder of ${files.length} files`;
    this.changed();
    try {
      this.join(await this.session.call("folder", { first, files }));
    } finally {
      this.busy = "";
      this.changed();
    }
  }

  async loadExample(): Promise<void> {
    const first = this.reserve(64);
    const assembly = await this.session.call("example", { first });
    this.clear();
    this.join(assembly);
  }

  reserve(count: number): number {
    const first = this.#last + 1;
    this.#last += count;
    return first;
  }

  /** Removes items that were added together; those of a recording are removed with it. */
  join({ origin, items, frames, cameras, poses, warnings }: Assembly, recording?: Item): void {
    const of = recording ? { recording: recording.id } : {};
    for (const { file, name, summary } of items) this.items.push({ id: file, name, state: "read", summary, ...of });
    for (const frame of frames) this.frames.push({ id: this.freshId(), ...frame });
    // Cameras in a folder's own files, besides those assigned to its frames.
    if (cameras.length > 0) {
      const summary: Summary = {
        kind: "cameras",
        says: `${cameras.length} cameras`,
        warnings: [],
        guessed: [],
        cameras,
        poses: [],
      };
      this.items.push({ id: this.freshId(), name: origin, state: "read", summary, ...of });
    }
    for (const pose of poses) this.addPose(pose, origin, recording?.id);
    this.notes.push(...warnings);
    this.#chooseCameras();
    this.changed();
  }

  /** All cameras that files gave, each with its place. */
  get given(): { source: string; label: string; camera: NamedCamera }[] {
    return this.items.flatMap((item) =>
      (item.summary?.cameras ?? []).map((camera, i) => {
        const size = camera.width && camera.height ? `, ${camera.width}×${camera.height}` : "";
        return {
          source: `${item.id}:${i}`,
          label: `${item.name}${camera.name ? `: ${camera.name}` : ""}${size}`,
          camera,
        };
      }),
    );
  }

  /** If names or sizes show which camera is which, the visitor need not choose. */
  #chooseCameras(): void {
    const all = this.given;
    for (const side of ["colour", "depth"] as const) {
      // A file may list a camera at every size that it supports.
      const size = this.sizeOf(side);
      const rank = ({ camera: { name, width, height } }: (typeof all)[number]) =>
        name === undefined && width === undefined ? 0 : width === size?.width && height === size?.height ? 1 : 2;
      const given = [...all].sort((a, b) => rank(a) - rank(b));
      const mine = this.cameras[side];
      const isThere =
        ["", "typed", "same", "sensor"].includes(mine.source) || given.some(({ source }) => source === mine.source);
      if (mine.chosen && isThere) continue;
      const arranged = all.find(({ source }) => source === this.arranged[side]);
      if (arranged) {
        Object.assign(mine, { source: arranged.source, chosen: false });
        continue;
      }
      const [own, other] = side === "colour" ? [COLOUR, DEPTH] : [DEPTH, COLOUR];
      const named =
        given.find(({ label }) => own.test(label) && !other.test(label)) ??
        given.find(({ camera }) => own.test(camera.name ?? "")) ??
        given.find(({ camera: { takes } }) => takes === side || takes === "both");
      const left = given.filter(
        ({ label, camera }) => !other.test(camera.name ?? "") && (own.test(label) || !other.test(label)),
      );
      const byOrder = all.length === 2 ? all[side === "colour" ? 0 : 1] : left.length === 1 ? left[0] : undefined;
      mine.source = (named ?? byOrder)?.source ?? "";
      mine.chosen = false;
    }
  }

  sizeOf(side: Side): { width: number; height: number } | undefined {
    const frame = this.frames.find((each) => each[side] !== undefined);
    const summary = this.item(frame?.[side])?.summary ?? this.of(side)[0]?.summary;
    return summary?.width && summary.height ? { width: summary.width, height: summary.height } : undefined;
  }

  cameraOf(side: Side): Pinhole | undefined {
    const { source, typed, sensor } = this.cameras[side];
    if (source === "same") return this.cameraOf("colour");
    if (source === "sensor") return fromSensor(sensor, this.sizeOf(side));
    if (source === "typed") return fromTyped(typed, this.sizeOf(side));
    return this.given.find((each) => each.source === source)?.camera.camera;
  }

  get complete(): Frame[] {
    return this.frames.filter(({ colour, depth }) => colour !== undefined && depth !== undefined);
  }

  /** Clouds hold the positions of their points, so that only depth maps need a camera. */
  get needsDepthCamera(): boolean {
    const isMap = ({ depth }: Frame) => this.item(depth)?.summary?.organised === false;
    return this.complete.length === 0 || this.complete.some(isMap);
  }

  /** Whether any depth map is a cloud; a LiDAR's scan is one. */
  get hasScans(): boolean {
    return this.complete.some(({ depth }) => this.item(depth)?.summary?.organised === true);
  }

  /** What is missing for a check, in words; empty if it can run. */
  get missing(): string[] {
    const missing: string[] = [];
    if (this.complete.length === 0) missing.push("a colour image and a depth map taken at the same moment");
    if (this.complete.length > 0 && this.needsDepthCamera && !this.cameraOf("depth"))
      missing.push(
        this.cameras.depth.source === "same"
          ? "the colour camera's parameters, which the depth camera shares"
          : "the depth camera's parameters (or its field of view)",
      );
    if (["typed", "sensor"].includes(this.cameras.colour.source) && !this.cameraOf("colour"))
      missing.push("all parameters of the colour camera, or “Unknown”");
    return missing;
  }

  get guessed(): string[] {
    const files = new Set(this.complete.map(({ depth }) => depth));
    // The check itself warns about an unknown colour camera.
    const units = this.items
      .filter(({ id, summary }) => files.has(id) && summary?.guessed.includes("unit"))
      .map(({ name }) => name);
    return units.length > 2 ? [`the unit of ${units.length} depth maps`] : units.map((name) => `the unit of ${name}`);
  }

  /** Whether a picture of a folder has a camera that belongs to its frame, and the visitor has chosen no other. */
  #hasOwn(side: Side, file: number): boolean {
    return this.item(file)?.summary?.hasOwnCamera === true && !this.cameras[side].chosen;
  }

  plans(): FramePlan[] {
    const colourCamera = this.cameraOf("colour");
    const depthCamera = this.cameraOf("depth");
    return this.complete.flatMap(({ name, colour, depth, mask, paint, range }) => {
      if (colour === undefined || depth === undefined) return [];
      const organised = this.item(depth)?.summary?.organised;
      return {
        name,
        colour,
        depth,
        ...(mask === undefined ? {} : { mask }),
        ...(paint ? { paint } : {}),
        ...(range ? { range } : {}),
        ...(colourCamera && !this.#hasOwn("colour", colour) ? { colourCamera } : {}),
        ...(depthCamera && !organised && !this.#hasOwn("depth", depth) ? { depthCamera } : {}),
      };
    });
  }

  async check(onProgress: (share: number, message: string) => void): Promise<void> {
    const plans = this.plans();
    const { guessed, cues } = this;
    const doubts = doubtsOf(this);
    const estimateOnly = this.candidates.length === 0;
    const candidates = estimateOnly
      ? { "no calibration": identity }
      : Object.fromEntries(this.candidates.map(({ name, pose }) => [name, pose]));
    await this.session.call("frames", { frames: plans });
    const report = await this.session.call("check", { candidates, cues }, onProgress);
    const { width = Infinity, height = Infinity } = this.sizeOf("colour") ?? {};
    const isLidar = this.hasScans && isOfScan(report.estimate);
    const diagonal = Math.hypot(width, height);
    this.run = { report, plans, candidates, cues, estimateOnly, guessed, doubts, isLidar, diagonal };
    this.history.push({ frames: plans.length, ...report.health });
    this.changed();
  }
}

export const COLOUR = /colou?r|rgb|image|left|cam0/i;
export const DEPTH = /depth|\bir\b|infra|tof|disp|cloud/i;
