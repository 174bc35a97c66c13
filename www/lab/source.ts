/** The input that the settings describe, and whether it was the visitor's own before a reload. */

import type { Input, OwnFiles, SampleSource, Source } from "../engine/protocol";
import { sizeInWords } from "./intake";
import { truthOf } from "./truths";
import type { Slot } from "./storage";
import { camera, isGuessed, sampleRequest, turnOf, type Origin, type Settings } from "./settings";

const OWN = "own-files";

/** Stores the origin only for this tab, so that a link in a new tab shows its own settings. */
export function rememberOrigin(origin: Origin): void {
  try {
    if (origin === "files") sessionStorage.setItem(OWN, "1");
    else sessionStorage.removeItem(OWN);
  } catch {
    // If the browser stores nothing, the files have to be chosen again.
  }
}

export function wasOwn(): boolean {
  try {
    return sessionStorage.getItem(OWN) !== null;
  } catch {
    return false;
  }
}

/** The fields that belong to a source. */
export const originOf = (source: Source): Origin => (source.kind === "sample" ? "sample" : "files");

/** The object of a sample, regardless of its light and noise; undefined for other sources. */
export const objectOf = (source: Source | string, { surface, size, protocol }: Settings): string =>
  typeof source === "string" || source.kind !== "sample" ? "" : [surface, size, protocol].join(" ");

/** The files of a source, in words; empty for a sample. */
export function namesIn(source: Source): string {
  if (source.kind === "sample") return "";
  const files = source.kind === "saved" ? [source.file] : [source.files.colour, source.files.depth];
  return files.map(({ name, size }) => `${name}, ${sizeInWords(size)}`).join("; ");
}

/** The source with the visitor's files read. The readers are loaded with the first file, and report how a large one is reduced. */
export async function readable(source: Source, say: (words: string) => void): Promise<Input> {
  if (source.kind !== "files") return source;
  const { pairFrom } = await import("./look");
  return { kind: "pair", pair: await pairFrom(source.files, say) };
}

/** The memory of an input's pictures, which is transferred to the worker. */
export function belongings(input: Input): ArrayBuffer[] {
  if (input.kind !== "pair") return [];
  const { image, depth } = input.pair;
  const arrays = [image.data, image.mask, depth.data, depth.points, depth.mask];
  return [...new Set(arrays.flatMap((array) => (array?.buffer instanceof ArrayBuffer ? [array.buffer] : [])))];
}

/** What to do about missing input. */
export function wayOut(lacking: string): string {
  if (lacking.includes(FACTOR))
    return "Inverse depths are known up to a factor. Enter it in the settings (Depth camera), or leave all fields of that camera empty.";
  return lacking.includes("camera:")
    ? "Enter them in the settings, or leave all fields of that camera empty."
    : "Drop files anywhere on this page, or choose them in the settings.";
}
const FACTOR = "focal length × baseline";

export const sampleOf = (settings: Settings): SampleSource => ({
  kind: "sample",
  request: sampleRequest(settings),
  turn: turnOf(settings),
});

/** The source, or what it still lacks, in words. */
export function sourceOf(
  origin: Origin,
  settings: Settings,
  { colour, depth, ...masks }: Partial<Record<Slot, File>>,
): Source | string {
  if (origin === "sample") return sampleOf(settings);
  if (!colour || !depth)
    return colour ? "waiting for a depth map" : depth ? "waiting for a colour image" : "waiting for both files";
  const files: OwnFiles = { colour, depth, ...masks };
  for (const side of ["colour", "depth"] as const) {
    const given = camera(settings, side);
    if (typeof given === "string") return `${side} camera: waiting for ${given}`;
    if (given) files[`${side}Camera`] = given;
  }
  if (typeof settings.unit === "number" && !isGuessed(settings, "unit")) files.unit = settings.unit;
  if (settings.meaning === "inverse") {
    const { numerator } = settings;
    if (files.depthCamera && typeof numerator !== "number") return `depth camera: waiting for ${FACTOR}`;
    files.inverse = files.depthCamera && typeof numerator === "number" ? { numerator } : {};
  }
  if (settings.transfer === "srgb" || settings.transfer === "linear") files.transfer = settings.transfer;
  const truth = truthOf(colour, depth);
  return { kind: "files", files: truth ? { ...files, truth } : files };
}
