/**
 * The visitor's files, recognised by their contents. The package's readers of rig files read each file once, in a separate thread that
 * keeps the pixels. A pair of files becomes the input of a run. Loaded with the first file.
 */

import type { ErrorDetails, PairKind, PairSample } from "../../pkg/index.js";
import { EngineError } from "../engine/engine";
import type { OwnFiles, Pair } from "../engine/protocol";
import type { Calls, Mask, PartName, Summary } from "../rig/protocol";
import { RigError, Session } from "../rig/session";
import { sniffed } from "./kind";
import type { Files, Slot } from "./storage";

/** The kind of file that was recognised, and its properties. */
export interface Look {
  kind: Summary["kind"] | undefined;
  says: string;
  /** Why the readers refused the file; the browser may still decode it. */
  fault?: string;
  warnings: string[];
  /** Whether a picture is stored without colours. */
  isGrey?: boolean;
  /** Whether the numbers of a depth map are stored as integers, and whether they vary from pixel to pixel as those of an image do. */
  isWhole?: boolean;
  isImageLike?: boolean;
  /** Whether it is a depth map whose name says that larger numbers are nearer. */
  isInverse?: boolean;
  width?: number;
  height?: number;
  /** Whether it is an organised cloud. */
  organised?: boolean;
  cameras: Summary["cameras"];
  /** Metres per stored unit that a file of cameras gives for the depth maps beside it. */
  unit?: number;
  picture?: ImageBitmap;
  /** For a depth map, the range of nearly all stored numbers, and the share of pixels with a depth. */
  measured?: { range: [number, number]; valid: number };
}

/** Warnings that the Lab shows beside its fields, and the warning about holes: an object without a background has holes all around. */
const SETTLED: ReadonlySet<string> = new Set(["unit-guessed", "units-differ", "depth-range", "many-holes"]);

/** Width of a preview, pixels. */
const PREVIEW = 192;

const session = new Session();
const looks = new WeakMap<File, Promise<Look>>();
const numbers = new WeakMap<File, number>();
/** Files whose pixels the thread keeps. */
const kept = new Map<number, File>();
let next = 1;

function numberOf(file: File): number {
  const number = numbers.get(file) ?? next++;
  numbers.set(file, number);
  return number;
}

/** Looks at a file once. */
export function lookAt(file: File): Promise<Look> {
  const known = looks.get(file) ?? look(file);
  looks.set(file, known);
  return known;
}

/** A file with what it was recognised as. */
export interface Seen {
  file: File;
  look: Look;
}

export const isDepthName = (name: string): boolean => /depth|dpt|\bir\b|infra|tof/i.test(name.replace(/[_.-]+/g, " "));

/** Of two grey pictures with the bits of a depth map, the one whose values are those of an image, or are integers beside the other's floats. */
export function imageAmong(pair: readonly [Seen, Seen]): Seen | undefined {
  const only = (has: (look: Look) => boolean | undefined): Seen | undefined => {
    const [one, ...others] = pair.filter(({ look }) => has(look));
    return one && others.length === 0 && !isDepthName(one.file.name) ? one : undefined;
  };
  return only(({ isImageLike }) => isImageLike) ?? only(({ isWhole }) => isWhole);
}

/** Forgets the pixels of all files but these. */
export function release(files: Files): void {
  const needed = new Set(Object.values(files));
  for (const [number, file] of kept) {
    if (needed.has(file)) continue;
    kept.delete(number);
    void session.call("forget", { file: number });
  }
}

/** The remedy on this page for a file that looks like another kind. */
const BY_HAND = "To use it anyway, choose it by hand in the settings";

type Reading = Omit<Calls["read"]["ask"], "file" | "name" | "blob">;

async function seen(file: File, number: number, how: Reading): Promise<Look> {
  const read = await session.call("read", { file: number, name: file.name, blob: file, ...how });
  const { kind, width, height, organised = false, isWhole = false, cameras, unit } = read;
  const isPicture = kind === "colour" || kind === "depth" || kind === "mask";
  const picture = isPicture ? await session.call("picture", { file: number, width: PREVIEW }) : undefined;
  const warnings = read.warnings.filter(({ code }) => kind !== "depth" || !SETTLED.has(code));
  return {
    kind,
    says: inWords(read),
    warnings: warnings.map(({ message }) => message),
    isGrey: read.isGrey ?? false,
    isWhole,
    isImageLike: kind === "depth" && read.warnings.some(({ code }) => code === "files-swapped"),
    organised,
    cameras,
    ...(width && height ? { width, height } : {}),
    ...(kind === "cameras" && unit !== undefined ? { unit } : {}),
    ...(picture ? { picture } : {}),
    ...(read.measured ? { measured: storedOf(read.measured, read.unit) } : {}),
  };
}

const storedOf = (
  { range: [near, far], valid }: NonNullable<Summary["measured"]>,
  unit = 1,
): NonNullable<Look["measured"]> => ({
  range: [near / unit, far / unit],
  valid,
});

/** Looks at a file without keeping its pixels. */
async function glance(file: File, how: Reading): Promise<Look> {
  const number = next++;
  try {
    return await seen(file, number, how);
  } finally {
    void session.call("forget", { file: number });
  }
}

async function look(file: File): Promise<Look> {
  const number = numberOf(file);
  try {
    const found = await seen(file, number, {});
    if (found.picture) kept.set(number, file);
    else void session.call("forget", { file: number });
    return found;
  } catch (error) {
    const details = error instanceof RigError ? error.fault.details : undefined;
    if (details?.problem === "disparity")
      return { ...(await glance(file, { as: "depth", inverse: {} })), isInverse: true };
    const reason = details?.reason ?? (error instanceof Error ? error.message : String(error));
    return unread(file, details?.finding === undefined ? reason : `${details.finding}. ${BY_HAND}`, details);
  }
}

/** A picture of at most this width. The browser decodes formats that the readers do not know. */
export async function pictureOf(file: File, width: number): Promise<ImageBitmap> {
  const number = numberOf(file);
  if (kept.has(number)) return session.call("picture", { file: number, width });
  const whole = await createImageBitmap(file);
  if (whole.width <= width) return whole;
  const picture = await createImageBitmap(whole, { resizeWidth: width, resizeQuality: "medium" });
  whole.close();
  return picture;
}

const KINDS = { colour: "colour", depth: "depth", colourMask: "mask", depthMask: "mask" } as const;

/** A file in its slot. If its content or name contradicts the slot, it is read as the kind that the slot requires, with a warning. */
export async function lookIn(slot: Slot, file: File): Promise<Look> {
  const own = await lookAt(file);
  if (own.fault === undefined) return own;
  const asked = await glance(file, { as: KINDS[slot] }).catch(() => undefined);
  return asked
    ? {
        ...asked,
        warnings: [
          ...asked.warnings,
          `Read as this slot requires; without the slot it would have been refused: ${own.says}`,
        ],
      }
    : own;
}

const short = (value: number): string => String(Number(value.toPrecision(3)));

function inWords({ kind, says, measured, width, height, unit = 1 }: Summary): string {
  if (kind !== "depth" || !measured) return says;
  const range = measured.range.map((metres) => short(metres / unit)).join(" to ");
  return `${width}x${height}, ${measured.stored}, ${(100 * measured.valid).toFixed(1)} % valid, stored numbers ${range}`;
}

/** A file that the readers refuse. The Lab still accepts larger pictures, which it scales down, and other formats that the browser decodes. */
async function unread(
  file: File,
  fault: string,
  { problem, width: wide, height: high }: ErrorDetails = {},
): Promise<Look> {
  const none = { warnings: [], cameras: [] };
  if (problem === "too-large") {
    const extent = wide && high ? { width: wide, height: high } : {};
    const says = [wide && high ? `${wide}x${high}` : "", "too large for a preview"].filter(Boolean).join(", ");
    return { ...none, ...extent, kind: await sniffed(file), says };
  }
  const whole = problem === "picture" ? await createImageBitmap(file).catch(() => undefined) : undefined;
  if (!whole) return { ...none, kind: undefined, says: fault, fault };
  const { width, height } = whole;
  const picture = await createImageBitmap(whole, { resizeWidth: Math.min(PREVIEW, width), resizeQuality: "medium" });
  whole.close();
  return { ...none, kind: "colour", says: `${width}x${height}, read by the browser`, width, height, picture };
}

/** The mask of the object that marks on a picture suggest. */
export const suggested = (ask: Calls["suggest"]["ask"]): Promise<Uint8Array> => session.call("suggest", ask);

/** A depth map in which depths outside a range in metres are grey, and the mask of that range and of what was drawn. */
export const depthPicture = (file: File, range: [number, number] | undefined, width: number): Promise<ImageBitmap> =>
  session.call("picture", { file: numberOf(file), width, ...(range ? { range } : {}) });
export const depthWithin = (file: File, ask: Omit<Calls["within"]["ask"], "file">): Promise<Mask> =>
  session.call("within", { file: numberOf(file), ...ask });

/** A pair of the gallery. */
export const renderedPair = (kind: PairKind): Promise<PairSample> => session.call("rendered", { pair: kind });

/** Assigns cameras to pictures. */
export const camerasFor = (ask: Calls["cameras"]["ask"]): Promise<Calls["cameras"]["answer"]> =>
  session.call("cameras", ask);

/** The files as the input of a run. Errors name the slot; `say` reports at once how a large picture is reduced. */
export async function pairFrom(files: OwnFiles, say: (words: string) => void): Promise<Pair> {
  const { colour, depth, colourMask, depthMask, truth, ...given } = files;
  const slots = Object.entries({ colour, depth, colourMask, depthMask }) as [PartName, File | undefined][];
  const parts = slots.flatMap(([slot, file]) =>
    file ? [[slot, { file: numberOf(file), name: file.name, blob: file }] as const] : [],
  );
  try {
    const ask = { ...given, parts: Object.fromEntries(parts) };
    const pair = await session.call("pair", ask, (_, words) => say(words));
    return truth ? { ...pair, truth } : pair;
  } catch (error) {
    if (!(error instanceof RigError)) throw error;
    throw new EngineError({ ...error.fault, fatal: false });
  }
}
