/** Makes the input of a run from the visitor's files, with notes about guesses and changes, by field. */
import { BimodalError } from "../errors.js";
import { nameOf } from "../rig/guess.js";
import type { DepthReading, RigReading } from "../rig/types.js";
import type { ColorImage, DepthMap, Mask, Pinhole } from "../types/index.js";
import { showsBackground } from "./background.js";
import { finerBy, surplus } from "./finer.js";
import { reducedDepth, reducedImage } from "./reduce.js";

/** Longest side that a run takes. */
const LONGEST = 4096;

/** The files that were read, and the visitor's entries about them. */
export interface Parts {
  colour: Extract<RigReading, { kind: "colour" }>;
  depth: DepthReading & { name: string; measured?: { range: [number, number] } };
  colourMask?: Mask;
  depthMask?: Mask;
  colourCamera?: Pinhole;
  depthCamera?: Pinhole;
  /** Metres per stored unit, or pixels without a depth camera. */
  unit?: number;
  transfer?: "srgb" | "linear";
}

/** A pair as the library takes it. */
export interface Pair {
  image: ColorImage;
  depth: DepthMap;
  /** Guesses and changes, in words, by field. */
  notes: Record<string, string>;
  /** The unit from the file or guessed from its values, if none was given. */
  unit?: number;
}

/** Reports how a large picture is reduced. */
type Say = (words: string) => void;
type Notes = Pair["notes"];

/** Images of 8 bits, also if stored with 16, are made for screens. Finer levels come from sensors and renderers. */
function guessedTransfer(data: Exclude<ColorImage["data"], Float32Array>): "srgb" | "linear" {
  return data instanceof Uint16Array && !data.every((level) => level % 257 === 0) ? "linear" : "srgb";
}

function fitting(mask: Mask, { width, height }: { width: number; height: number }, field: string): Uint8Array {
  if (mask.width === width && mask.height === height) return mask.data;
  const words = `the mask is ${mask.width} × ${mask.height} px, its picture ${width} × ${height}`;
  throw new BimodalError("size", words, field);
}

function wholeImage({ colour, colourMask, colourCamera, transfer }: Parts, notes: Notes): ColorImage {
  const { camera: _, ...image } = colour.image;
  const whole: ColorImage = { ...image, ...(colourCamera && { camera: colourCamera }) };
  if (colourMask) whole.mask = fitting(colourMask, whole, "image.mask");
  if (whole.data instanceof Float32Array) return whole;
  const known = transfer ?? whole.transfer;
  whole.transfer = known ?? guessedTransfer(whole.data);
  if (!known) notes["image.transfer"] = `guessed: ${whole.transfer === "srgb" ? "sRGB" : "linear"}`;
  return whole;
}

/** The reader's guess of the unit and its warning about the range of depths; empty if the file gives the unit. */
function guessInWords({ warnings, guessed }: Parts["depth"]): string {
  const doubt = guessed.length > 0 ? warnings.find(({ code }) => code === "unit-guessed") : undefined;
  const range = warnings.find(({ code }) => code === "depth-range");
  return [doubt?.message, range?.message].filter(Boolean).join(" ");
}

const RELATIVE =
  "Inverse depths are known up to a factor only: the median depth was set to the longer side of the map, in pixels. Another unit makes the relief deeper or flatter.";
const SAME = 1e-9;

/** The unit of the map: given, or with a camera from the file or its values. Without a camera one stored unit is one pixel. */
function unitOf(parts: Parts, notes: Notes): { unit?: number; found?: number } {
  const { depth, depthCamera, unit: given } = parts;
  const doubt = depth.warnings.find(({ code }) => code === "unit-guessed");
  const own = depth.depth.unit ?? (doubt?.unit as number | undefined) ?? 1;
  const isRelative = depth.guessed.length > 0 && doubt?.unit === undefined;
  if (isRelative) {
    notes["depth.unit"] = RELATIVE;
    return given === undefined ? {} : { unit: given };
  }
  const isSame = given !== undefined && Math.abs(given / own - 1) < SAME;
  if (depthCamera === undefined) {
    if (given === undefined && doubt)
      notes["depth.unit"] =
        `Its numbers look like ${nameOf(own)}, but without a depth camera each counts as one pixel of depth.`;
    return given === undefined ? {} : { unit: given };
  }
  const words = given === undefined || isSame ? guessInWords(depth) : "";
  if (words) notes["depth.unit"] = words;
  return given === undefined ? { unit: own, found: own } : { unit: given };
}

function wholeDepth(parts: Parts, notes: Notes): { depth: DepthMap; found?: number } {
  const { depthMask, depthCamera } = parts;
  const { unit: _, camera: __, ...map } = parts.depth.depth;
  const { unit, found } = unitOf(parts, notes);
  const depth: DepthMap = { ...map, ...(depthCamera && { camera: depthCamera }), ...(unit !== undefined && { unit }) };
  if (depthMask) depth.mask = fitting(depthMask, depth, "depth.mask");
  return { depth, ...(found !== undefined && { found }) };
}

const inPixels = ({ width, height }: { width: number; height: number }): string => `${width} × ${height} px`;
const least = ({ width, height }: { width: number; height: number }): number =>
  Math.ceil(Math.max(width, height) / LONGEST);

/** The depth map at a size that the library accepts, and the image at one that the run can use with it. */
export function pairOf(parts: Parts, say: Say): Pair {
  const notes: Notes = {};
  const [image, { depth: map, found }] = [wholeImage(parts, notes), wholeDepth(parts, notes)];
  const thin = least(map);
  if (thin > 1) {
    notes.depth = `${inPixels(map)} exceeds the library's limit; one pixel in ${thin} is used`;
    say(`${parts.depth.name}: ${notes.depth}.`);
  }
  const depth = thin > 1 ? reducedDepth(map, thin) : map;
  if (showsBackground(image))
    notes["image.mask"] =
      "The colour image has no mask, and its background is not black: it counts as part of the object.";
  const finer = finerBy(image, depth);
  const [needed, useful] = [least(image), surplus(image, finer)];
  const factor = Math.max(needed, useful);
  if (factor > 1) {
    const why =
      needed >= useful ? "exceeds the library's limit" : `is ${finer.toFixed(1)} times as fine as the depth map`;
    // Poses of views without a camera are in pixels.
    const whose = needed < useful && image.camera === undefined ? "; pixels are those of the smaller picture" : "";
    notes.image = `${inPixels(image)} ${why}; scaled down by ${factor}${whose}`;
    say(`${parts.colour.name}: ${notes.image}.`);
  }
  return {
    image: factor > 1 ? reducedImage(image, factor) : image,
    depth,
    notes,
    ...(found !== undefined && { unit: found }),
  };
}
