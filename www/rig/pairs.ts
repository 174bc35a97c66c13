/** The visitor's files of the Lab as the pair of a run, read by the readers of rig files. Runs in the worker. */

import { BimodalError } from "../../pkg/index.js";
import * as pair from "../../pkg/pair.js";
import type * as Pairs from "../../pkg/pair/index.js";
import type { ReadOptions, RigReading } from "./files";
import type { Calls, PartFile, PartName } from "./protocol";

const readPart = pair.readPart as typeof Pairs.readPart;
const pairOf = pair.pairOf as typeof Pairs.pairOf;
export const arranged = pair.arranged as typeof Pairs.arranged;
export const camerasFor = pair.camerasFor as typeof Pairs.camerasFor;

/** The kind as which a part is read, and the library's name for it. */
const PLACES: Record<PartName, { as: "colour" | "depth" | "mask"; field: string }> = {
  colour: { as: "colour", field: "image" },
  depth: { as: "depth", field: "depth" },
  colourMask: { as: "mask", field: "image.mask" },
  depthMask: { as: "mask", field: "depth.mask" },
};

/** Files that were read as another kind than their content suggests, by number and kind. */
const others = new Map<string, RigReading>();

/** Forgets the other readings of a file. */
export function forgetOthers(file: number): void {
  for (const key of others.keys()) if (key.startsWith(`${file} `)) others.delete(key);
}

type Known = ReadonlyMap<number, RigReading>;

async function bytesOf({ name, blob }: PartFile): Promise<Uint8Array> {
  try {
    return new Uint8Array(await blob.arrayBuffer());
  } catch (error) {
    // Reading fails if the file has been removed or replaced.
    throw new BimodalError("file", `${name}: ${error instanceof Error ? error.message : String(error)}`);
  }
}

async function partOf(part: PartFile, options: ReadOptions, known: Known): Promise<RigReading> {
  const { file, name } = part;
  const own = known.get(file);
  const isPlain = options.inverse === undefined && options.unit === undefined;
  if (isPlain && own && own.kind === options.as) return own;
  const key = `${file} ${JSON.stringify(options)}`;
  const found = others.get(key) ?? (await readPart({ name, bytes: await bytesOf(part) }, options));
  others.set(key, found);
  return found;
}

const isOfKind = <K extends RigReading["kind"]>(
  reading: RigReading,
  kind: K,
): reading is Extract<RigReading, { kind: K }> => reading.kind === kind;

/** The reading of a part; errors name the part. */
async function placed<K extends "colour" | "depth" | "mask">(
  name: PartName,
  kind: K,
  { parts, inverse }: Calls["pair"]["ask"],
  known: Known,
): Promise<Extract<RigReading, { kind: K }> | undefined> {
  const part = parts[name];
  if (!part) return undefined;
  const { as, field } = PLACES[name];
  try {
    const reading = await partOf(part, { as, ...(as === "depth" && inverse ? { inverse } : {}) }, known);
    if (isOfKind(reading, kind)) return reading;
    throw new BimodalError("file", `${part.name}: it was read as ${reading.kind}`, field);
  } catch (error) {
    if (!(error instanceof BimodalError)) throw error;
    throw new BimodalError(error.code, error.message, field, { cause: error });
  }
}

/** A cloud in its stored unit, with the guess of that unit, because the readers convert its points to metres. */
async function asStored(
  depth: Extract<RigReading, { kind: "depth" }>,
  part: PartFile,
  known: Known,
): Promise<Extract<RigReading, { kind: "depth" }>> {
  if (!depth.depth.points) return depth;
  const stored = await partOf(part, { as: "depth", unit: 1 }, known);
  return isOfKind(stored, "depth") ? { ...depth, depth: stored.depth } : depth;
}

export async function pairFrom(
  ask: Calls["pair"]["ask"],
  known: Known,
  say: (words: string) => void,
): Promise<Calls["pair"]["answer"]> {
  const { parts, inverse: _, ...given } = ask;
  const colour = await placed("colour", "colour", ask, known);
  const depth = await placed("depth", "depth", ask, known);
  const [colourMask, depthMask] = [
    await placed("colourMask", "mask", ask, known),
    await placed("depthMask", "mask", ask, known),
  ];
  if (!colour || !depth || !parts.depth) throw new Error("A pair has a colour image and a depth map.");
  return pairOf(
    {
      ...given,
      colour,
      depth: await asStored(depth, parts.depth, known),
      ...(colourMask ? { colourMask: colourMask.mask } : {}),
      ...(depthMask ? { depthMask: depthMask.mask } : {}),
    },
    say,
  );
}
