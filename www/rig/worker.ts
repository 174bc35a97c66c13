/** The thread that reads files and runs the check. It keeps all pixels; the page gets summaries, pictures and numbers. */

import "../engine/hold";
import { checkCalibration, projectFrame, samplePair, suggestMask, type CheckFrame } from "../../pkg/index.js";
import { faultOf } from "../engine/fault";
import { maskWithin, restrictDepth, restrictImage } from "./restrict";
import { isRecording, readRigFile, readRigFolder, type RigReading } from "./files";
import { picture } from "./pictures";
import type { Answer, Assembly, CallKind, Calls, FramePlan, Request, Summary } from "./protocol";
import type { ReadFolder } from "./inputs";
import type { Recorded, Taken } from "./recorded";

const MOST_WORKERS = 4;

const readings = new Map<number, RigReading>();
let recorded: Promise<Recorded> | undefined;
/** The readers of recordings and robots are loaded on demand, because they are large and rarely needed. */
const recordedOf = () => (recorded ??= import("./recorded").then(({ Recorded }) => new Recorded()));
let paired: ReturnType<typeof loadPairs> | undefined;
const loadPairs = () => import("./pairs");
/** The code that makes pairs for the Lab. */
const pairs = () => (paired ??= loadPairs());
/** Bytes of a file that identify recordings. */
const HEAD = 16;
/** The frames that were checked last; the overlay and the exported files refer to these. */
let frames: CheckFrame[] = [];
let running: AbortController | undefined;
let suggesting: AbortController | undefined;
/** The items that came from folders, and their files, for the report. */
const folders: ReadFolder[] = [];

function post(answer: Answer, transfer: Transferable[] = []): void {
  self.postMessage(answer, { transfer });
}

function summaryOf(reading: RigReading): Summary {
  const { says, warnings, kind, isGrey, measured } = reading;
  const figures = { ...(isGrey !== undefined && { isGrey }), ...(measured && { measured }) };
  const plain = { says, warnings, kind, ...figures, guessed: [], cameras: [], poses: [] };
  switch (reading.kind) {
    case "colour":
      return {
        ...plain,
        width: reading.image.width,
        height: reading.image.height,
        cameras: reading.image.camera ? [{ camera: reading.image.camera }] : [],
      };
    case "depth": {
      const { width, height, unit, data, points, camera } = reading.depth;
      const stored = { isWhole: data instanceof Uint16Array, organised: points !== undefined };
      const rest = { width, height, ...stored, cameras: camera ? [{ camera }] : [] };
      return { ...plain, ...rest, guessed: reading.guessed, ...(unit === undefined ? {} : { unit }) };
    }
    case "mask":
      return { ...plain, width: reading.mask.width, height: reading.mask.height };
    case "cameras":
      return {
        ...plain,
        cameras: reading.cameras,
        poses: reading.poses,
        ...(reading.depthUnit === undefined ? {} : { unit: reading.depthUnit }),
      };
    case "poses":
      return { ...plain, poses: reading.poses };
  }
}

function read(file: number): RigReading {
  const reading = readings.get(file);
  if (!reading) throw new Error(`File ${file} has not been read.`);
  return reading;
}

function readingOf<K extends RigReading["kind"]>(file: number, kind: K): Extract<RigReading, { kind: K }> {
  const reading = readings.get(file);
  if (reading?.kind !== kind) throw new Error(`File ${file} is not a ${kind}.`);
  return reading as Extract<RigReading, { kind: K }>;
}

/** Stores pairs that were added together as separate files; their shared cameras are reported once. */
function assemble(
  origin: string,
  first: number,
  pairs: CheckFrame[],
  { cameras, poses, warnings }: Pick<Assembly, "cameras" | "poses" | "warnings">,
): Assembly {
  const items: Assembly["items"] = [];
  const guessed: "unit"[] = warnings.some(({ code }) => code === "unit-guessed") ? ["unit"] : [];
  /** Frames of phones and of KITTI have separate cameras. */
  const isShared = (side: "image" | "depth") =>
    new Set(pairs.map((each) => JSON.stringify(each[side].camera))).size < 2;
  const hasOwn = { colour: !isShared("image"), depth: !isShared("depth") };
  const keep = (reading: RigReading): number => {
    const file = first + items.length;
    const isOwn = (reading.kind === "colour" || reading.kind === "depth") && hasOwn[reading.kind];
    const summary = { ...summaryOf(reading), ...(isOwn && { hasOwnCamera: true }) };
    readings.set(file, reading);
    items.push({ file, name: reading.name, summary: items.length < 2 ? summary : { ...summary, cameras: [] } });
    return file;
  };
  const frames = pairs.map(({ image: { mask, ...image }, depth, name = "frame" }) => {
    const { width, height } = image;
    return {
      name,
      colour: keep({ kind: "colour", name: `${name}, colour`, says: `${width}x${height}`, warnings: [], image }),
      depth: keep({
        kind: "depth",
        name: `${name}, depth`,
        says: `${depth.width}x${depth.height}`,
        warnings: [],
        guessed,
        depth,
      }),
      // The mask becomes a separate file, so that the visitor sees it and can remove it: the background is informative, too.
      ...(mask
        ? {
            mask: keep({
              kind: "mask",
              name: `${name}, mask`,
              says: `${width}x${height}`,
              warnings: [],
              mask: { width, height, data: mask },
            }),
          }
        : {}),
    };
  });
  return { origin, items, frames, cameras, poses, warnings };
}

const assembled = (first: number, { origin, frames, ...rest }: Taken): Assembly =>
  assemble(origin, first, frames, rest);

const bytesOf = async (blob: Blob): Promise<Uint8Array> => new Uint8Array(await blob.arrayBuffer());

function frameOf({ name, colour, depth, mask, paint, range, colourCamera, depthCamera }: FramePlan): CheckFrame {
  const image = restrictImage(readingOf(colour, "colour").image, [
    mask === undefined ? undefined : readingOf(mask, "mask").mask.data,
    paint,
  ]);
  const map = restrictDepth(readingOf(depth, "depth").depth, range);
  return {
    name,
    image: { ...image, ...(colourCamera ? { camera: colourCamera } : {}) },
    depth: { ...map, ...(depthCamera ? { camera: depthCamera } : {}) },
  };
}

const frameAt = (index: number): CheckFrame => {
  const frame = frames[index];
  if (!frame) throw new Error(`There is no frame ${index}.`);
  return frame;
};

type Handlers = { [K in CallKind]: (ask: Calls[K]["ask"], id: number) => Promise<Calls[K]["answer"]> };

const handlers: Handlers = {
  async read({ file, name, blob, as, unit, inverse }) {
    if (isRecording(await bytesOf(blob.slice(0, HEAD)))) return (await recordedOf()).open(file, name, blob);
    const reading = await readRigFile(
      { name, bytes: await bytesOf(blob) },
      { ...(as ? { as } : {}), ...(unit === undefined ? {} : { unit }), ...(inverse ? { inverse } : {}) },
    );
    readings.set(file, reading);
    return summaryOf(reading);
  },
  async arrange({ frames, texts }) {
    const { arranged } = await pairs();
    const readTexts = texts.flatMap((file) => {
      const reading = readings.get(file);
      return reading?.kind === "cameras" || reading?.kind === "poses" ? [{ file, reading }] : [];
    });
    const pictures = frames.map((each) => ({
      colour: readingOf(each.colour, "colour"),
      depth: readingOf(each.depth, "depth"),
    }));
    return arranged(pictures, readTexts);
  },
  async unit({ file, unit }) {
    const reading = readingOf(file, "depth");
    const { width, height } = reading.depth;
    const kept: RigReading = { ...reading, says: `${width}x${height}`, guessed: [], depth: { ...reading.depth, unit } };
    readings.set(file, kept);
    return summaryOf(kept);
  },
  async folder({ first, files }) {
    const named = await Promise.all(files.map(async ({ name, blob }) => ({ name, bytes: await bytesOf(blob) })));
    const folder = await readRigFolder(named);
    const assembly = assemble("the folder", first, folder.frames, folder);
    folders.push({ items: assembly.items.map(({ file }) => file), files, readings: folder.readings });
    return assembly;
  },
  async example({ first }) {
    const { frames, poses } = await (await import("./example")).loadExample();
    return assemble("the example", first, frames, { cameras: [], poses, warnings: [] });
  },
  async take({ first, ...ask }, id) {
    const onProgress = (share: number) => post({ id, share, message: "" });
    return assembled(first, await (await recordedOf()).take(ask, onProgress));
  },
  async connect({ address }) {
    return (await recordedOf()).connect(address);
  },
  async observe({ first, ...ask }) {
    return assembled(first, await (await recordedOf()).observe(ask));
  },
  async rest() {
    (await recorded)?.rest();
    return null;
  },
  async closed() {
    return (await recordedOf()).closed();
  },
  async disconnect() {
    (await recorded)?.disconnect();
    return null;
  },
  async forget({ file }) {
    readings.delete(file);
    if (paired) (await paired).forgetOthers(file);
    (await recorded)?.forget(file);
    return null;
  },
  async pair(ask, id) {
    const { pairFrom } = await pairs();
    return pairFrom(ask, readings, (message) => post({ id, share: 0, message }));
  },
  async cameras({ cameras, colour, depth }) {
    return (await pairs()).camerasFor(cameras, colour, depth);
  },
  async picture({ file, range, width }) {
    return picture(read(file), range, width);
  },
  async suggest({ marks, ...image }) {
    suggesting = new AbortController();
    return (await suggestMask(image, marks, { signal: suggesting.signal })).mask;
  },
  async within({ file, range, paint }) {
    return maskWithin(readingOf(file, "depth").depth, range, paint);
  },
  async rendered({ pair }) {
    return samplePair(pair);
  },
  async frames({ frames: plans }) {
    frames = plans.map(frameOf);
    return null;
  },
  async check({ candidates, cues }, id) {
    running = new AbortController();
    const { signal } = running;
    try {
      const workers = Math.max(1, Math.min(navigator.hardwareConcurrency || 1, MOST_WORKERS));
      const onProgress = (share: number, message: string) => post({ id, share, message });
      return await checkCalibration(frames, candidates, {
        signal,
        onProgress,
        workers,
        ...(cues.length > 0 ? { cues } : {}),
      });
    } finally {
      running = undefined;
    }
  },
  async overlay({ frame, pose }) {
    const { points, edges } = await projectFrame(frameAt(frame), pose);
    return { points, edges };
  },
  async pose({ pose, format, isEstimate }) {
    const { writePose } = await import("./write");
    const [frame] = frames;
    const { image, depth } = frame ?? {};
    const cameras = {
      ...(image?.camera ? { colour: image.camera } : {}),
      ...(depth?.camera ? { depth: depth.camera } : {}),
    };
    const size = (of: { width: number; height: number }): [number, number] => [of.width, of.height];
    return writePose(pose, format, {
      ...cameras,
      isEstimate,
      ...(image && depth ? { sizes: { colour: size(image), depth: size(depth) } } : {}),
    });
  },
  async clouds({ frame, poses }) {
    const [{ writeClouds }, { cloudOf }] = await Promise.all([import("./write"), import("./cloud")]);
    const clouds = [];
    for (const { name, pose } of poses) clouds.push({ name, ...(await cloudOf(frameAt(frame), pose)) });
    return writeClouds(clouds);
  },
  async inputs({ items }) {
    const { inputsOf, moduleHash } = await import("./inputs");
    return { inputs: await inputsOf(items, folders), module: await moduleHash() };
  },
};

/** Data that may be transferred without a copy; everything else stays with the worker. */
function transferable(answer: unknown): Transferable[] {
  if (answer instanceof ImageBitmap) return [answer];
  if (answer instanceof Uint8Array) return [answer.buffer as ArrayBuffer];
  if (typeof answer === "object" && answer !== null && "edges" in answer && "points" in answer) {
    const { points, edges } = answer as Calls["overlay"]["answer"];
    return [...new Set([points.buffer as ArrayBuffer, edges.buffer as ArrayBuffer])];
  }
  return [];
}

/** The present reading: later requests may refer to it. */
let reads: Promise<unknown> = Promise.resolve();

self.onmessage = async ({ data }: MessageEvent<Request>) => {
  if (data.kind === "cancel") {
    suggesting?.abort();
    return running?.abort();
  }
  const { id, kind } = data;
  const isRead = kind === "read" || kind === "folder" || kind === "example" || kind === "take";
  const handle = () => (handlers[kind] as (ask: unknown, id: number) => Promise<Calls[CallKind]["answer"]>)(data, id);
  try {
    // Frames can be taken from a recording once it has been opened.
    const result = isRead && kind !== "take" ? handle() : reads.then(handle);
    if (isRead) reads = Promise.allSettled([reads, result]);
    const answer = await result;
    post({ id, answer }, transferable(answer));
  } catch (error) {
    post({ id, fault: faultOf(error, true) });
  }
};
