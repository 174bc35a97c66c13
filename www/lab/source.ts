/** The input that the settings describe, and whether it was the visitor's own before a reload. */

import type { OwnFiles, SampleSource, Source } from "../engine/protocol";
import { sizeInWords } from "./intake";
import type { Slot } from "./storage";
import { isFurther } from "./kind";
import { camera, sampleRequest, turnOf, type Origin, type Settings } from "./settings";

const OWN = "own-files";

/** For this tab alone: a link that is opened anew shows what it says. */
export function rememberOrigin(origin: Origin): void {
  try {
    if (origin === "files") sessionStorage.setItem(OWN, "1");
    else sessionStorage.removeItem(OWN);
  } catch {
    // A browser that stores nothing needs the files again.
  }
}

export function wasOwn(): boolean {
  try {
    return sessionStorage.getItem(OWN) !== null;
  } catch {
    return false;
  }
}

/** Which fields a source has to do with. */
export const originOf = (source: Source): Origin => (source.kind === "sample" ? "sample" : "files");

/** Which object a sample shows, whatever its light or noise; none that is known of any other source. */
export const objectOf = (source: Source | string, { surface, size, protocol }: Settings): string =>
  typeof source === "string" || source.kind !== "sample" ? "" : [surface, size, protocol].join(" ");

/** The files that are read of a source, in words; nothing of a sample. */
export function namesIn(source: Source): string {
  if (source.kind === "sample") return "";
  const files = source.kind === "saved" ? [source.file] : [source.files.colour, source.files.depth];
  return files.map(({ name, size }) => `${name}, ${sizeInWords(size)}`).join("; ");
}

/** With the pixels of the files that the worker's decoders do not know; what does know them loads with the first such file. */
export async function readable(source: Source): Promise<Source> {
  if (source.kind !== "files") return source;
  const { colour, depth, colourMask, depthMask } = source.files;
  const isNeeded = [colour, depth, colourMask, depthMask].map(
    (file, i) => file !== undefined && isFurther(file, i === 0),
  );
  if (!(await Promise.all(isNeeded)).includes(true)) return source;
  const { pixelsOf } = await import("./own");
  return { ...source, files: { ...source.files, read: await pixelsOf(source.files) } };
}

/** What can be done about what is lacking. */
export const wayOut = (lacking: string): string =>
  lacking.includes("camera:")
    ? "Enter them in the settings, or leave all fields of that camera empty."
    : "Drop files anywhere on this page, or choose them in the settings.";

export const sampleOf = (settings: Settings): SampleSource => ({
  kind: "sample",
  request: sampleRequest(settings),
  turn: turnOf(settings),
});

/** Or in words what it still lacks. */
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
  if (typeof settings.unit === "number") files.unit = settings.unit;
  if (settings.transfer === "srgb" || settings.transfer === "linear") files.transfer = settings.transfer;
  return { kind: "files", files };
}
