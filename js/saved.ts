/**
 * A run as bytes, for `Estimator.save` and `restore`. The views, the options and the number of stages that have been run determine a run to
 * the bit, however the steps were sliced and whatever the number of threads. The file therefore holds these, with a checksum that shows
 * whether the results were reproduced. Restoring takes as long as the run, but the format does not change with every stage.
 *
 * Sixteen bytes of name and format, the header's length (32 bits, little-endian), the header (JSON), the arrays one after the other, CRC-32
 * of all that.
 */
import { array, flag, isObject, object, ranged, word, wrong, type Check } from "./check.js";
import { crc32 } from "./crc.js";
import { BimodalError } from "./errors.js";
import type { ColorImage, DepthMap, Options, Stage, StepReport } from "./types/index.js";

/** The progress of a run. */
export interface Reached {
  /** Whether anything has been run. Before the first step, the report names no stage of this run. */
  begun: boolean;
  stage: Stage;
  iteration: number;
  /** Slices of the search that were done. */
  slices: number;
  /** Whether the status is no longer "running". */
  ended: boolean;
}

export interface Saved {
  image: ColorImage;
  depth: DepthMap;
  options: Options;
  reached: Reached;
  /** The checksum of the results, by `checksumOf`. */
  found: number;
}

const NAME = "bimodal-stereo\n";
const FORMAT = 1;
/** Name and format. */
const MARK = NAME.length + 1;
/** A 32-bit number, for the header's length and the checksum. */
const WORD = 4;
/** Largest number of bytes in a header: options hold at most 800 numbers of 25 characters each. */
const LONGEST_HEADER = 65_536;
/** Largest number of bytes in all: two views of 4096 pixels on a side with all members have 0.7 GB. */
const MOST_BYTES = 2 ** 30;

const TYPES = { Uint8Array, Uint8ClampedArray, Uint16Array, Float32Array } as const;
type Kind = keyof typeof TYPES;
const KINDS = Object.keys(TYPES) as Kind[];
const VIEWS = ["image", "depth"] as const;
const MEMBERS = ["data", "mask", "points", "normals"] as const;
const STAGES: readonly Stage[] = ["search", "light", "shading", "surface", "registration", "refinement"];

/** The place of an array within a view. */
interface Entry {
  view: (typeof VIEWS)[number];
  member: (typeof MEMBERS)[number];
  type: Kind;
  length: number;
}

interface Header extends Omit<Saved, "image" | "depth"> {
  /** The views without their arrays. */
  image: object;
  depth: object;
  arrays: Entry[];
}

const bad = (what: string, cause?: unknown) =>
  new BimodalError("state", `state: ${what}`, "state", cause === undefined ? undefined : { cause });

export const otherNumbers = () =>
  bad("was saved by a version or build of this package that computes different digits; run the pair again");

/** Every error about saved bytes has the code "state". */
export function unusable<T>(call: () => T): T {
  try {
    return call();
  } catch (error) {
    if (!(error instanceof BimodalError) || error.code === "init") throw error;
    throw bad(`cannot be run (${error.message})`, error);
  }
}

const bytesOf = ({ buffer, byteOffset, byteLength }: ArrayBufferView) => new Uint8Array(buffer, byteOffset, byteLength);

/** An estimator, reduced to its results. */
interface Outcome {
  readonly report: StepReport;
  light(): Float64Array;
  imageDepth(): Float32Array;
  refinedDepth(): Float32Array;
}

/** All reports and results of a run, except the times. */
export function checksumOf(estimator: Outcome): number {
  const { milliseconds: _, ...report } = estimator.report;
  const found = [
    new TextEncoder().encode(JSON.stringify(report)),
    estimator.light(),
    estimator.imageDepth(),
    estimator.refinedDepth(),
  ];
  return crc32(joined(found));
}

function joined(parts: readonly ArrayBufferView[]): Uint8Array {
  const all = new Uint8Array(parts.reduce((sum, { byteLength }) => sum + byteLength, 0));
  let at = 0;
  for (const part of parts) {
    all.set(bytesOf(part), at);
    at += part.byteLength;
  }
  return all;
}

const inBytes = (value: number) => new Uint8Array(new Uint32Array([value]).buffer);
const numberAt = (bytes: Uint8Array, at: number) => new DataView(bytes.buffer, bytes.byteOffset).getUint32(at, true);

export function saved({ image, depth, ...run }: Saved): Uint8Array {
  const arrays: Entry[] = [];
  const data: ArrayBufferView[] = [];
  const without = (view: Entry["view"], raster: ColorImage | DepthMap): object =>
    Object.fromEntries(
      Object.entries(raster).filter(([name, value]) => {
        const type = KINDS.find((kind) => value instanceof TYPES[kind]);
        const member = MEMBERS.find((known) => known === name);
        if (type === undefined || member === undefined) return true;
        arrays.push({ view, member, type, length: value.length });
        data.push(value);
        return false;
      }),
    );
  const header: Header = { image: without("image", image), depth: without("depth", depth), ...run, arrays };
  const text = new TextEncoder().encode(JSON.stringify(header));
  const all = joined([new TextEncoder().encode(NAME), new Uint8Array([FORMAT]), inBytes(text.length), text, ...data]);
  return joined([all, inBytes(crc32(all))]);
}

const whole = ranged({ kind: "whole", min: 0 });
const record: Check = (value, field) => {
  if (!isObject(value) || Array.isArray(value)) throw wrong(field, "an object", value);
};
const list: Check = (value, field) => {
  if (!Array.isArray(value)) throw wrong(field, "a list", value);
  const entry = object(ENTRY, Object.keys(ENTRY));
  for (const [index, each] of value.entries()) entry(each, `${field}[${index}]`);
};
const REACHED = { begun: flag, stage: word(...STAGES), iteration: whole, slices: whole, ended: flag };
const ENTRY = { view: word(...VIEWS), member: word(...MEMBERS), type: word(...KINDS), length: whole };
const HEADER = {
  image: record,
  depth: record,
  options: record,
  reached: object(REACHED, Object.keys(REACHED)),
  found: whole,
  arrays: list,
};

/** The content of a file, if it is complete and was written by this package; the estimator checks its views and options. */
export function opened(state: unknown): Saved {
  array(Uint8Array)(state, "state");
  // A plain Uint8Array, because `slice` of a Node Buffer is a view.
  const bytes = bytesOf(state as Uint8Array);
  const { header, end } = readHeader(bytes);
  const { image, depth, arrays, ...run } = header;
  const views: Record<Entry["view"], object> = { image, depth };
  let at = end;
  for (const { view, member, type, length } of arrays) {
    const size = length * TYPES[type].BYTES_PER_ELEMENT;
    if (size > bytes.length - WORD - at) throw bad("is cut off");
    const values = new TYPES[type](bytes.slice(at, at + size).buffer);
    views[view] = { ...views[view], [member]: values };
    at += size;
  }
  if (at !== bytes.length - WORD) throw bad("is longer than it declares");
  return { ...run, image: views.image as ColorImage, depth: views.depth as DepthMap };
}

function readHeader(bytes: Uint8Array): { header: Header; end: number } {
  const name = new TextDecoder("latin1").decode(bytes.subarray(0, NAME.length));
  if (name !== NAME) throw bad("is not a saved run");
  if (bytes.length < MARK + 2 * WORD) throw bad("is cut off");
  if (bytes[NAME.length] !== FORMAT) throw bad(`has format ${bytes[NAME.length]}; this version reads format ${FORMAT}`);
  if (bytes.length > MOST_BYTES) throw bad(`has ${bytes.length} bytes; at most ${MOST_BYTES} are allowed`);
  const end = bytes.length - WORD;
  if (numberAt(bytes, end) !== crc32(bytes.subarray(0, end)))
    throw bad("is damaged or cut off: its checksum does not match");
  const length = numberAt(bytes, MARK);
  if (length > Math.min(LONGEST_HEADER, end - MARK - WORD)) throw bad("has a header that is too long");
  const text = bytes.subarray(MARK + WORD, MARK + WORD + length);
  return { header: unusable(() => checkedHeader(new TextDecoder().decode(text))), end: MARK + WORD + length };
}

function checkedHeader(text: string): Header {
  let header: unknown;
  try {
    header = JSON.parse(text);
  } catch (error) {
    throw bad("has a header that cannot be read", error);
  }
  object(HEADER, Object.keys(HEADER))(header, "header");
  return header as Header;
}
