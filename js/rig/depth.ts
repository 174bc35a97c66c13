/**
 * A raster or a cloud as a depth map in metres: its unit, told, in the file or guessed from the values; what of it is valid, and whether
 * that looks like what a depth camera sees.
 *
 * Limits: millimetres and fifths of them (TUM) cannot always be told apart by values alone, so that every guess is said.
 */
import { badFile } from "../errors.js";
import { hasColour, single } from "../raster.js";
import { checkAxes } from "./axes.js";
import { decoded } from "./formats/coded.js";
import type { Cloud, Picture } from "./formats/picture.js";
import {
  FARTHEST,
  NEAREST,
  type Unit,
  isThere,
  isVaried,
  metresText,
  nameOf,
  otherUnits,
  quantile,
  sampled,
  shareOf,
  told,
  unitOfFloats,
  unitOfIntegers,
} from "./guess.js";
import { isOptical, turnedCloud } from "./scan.js";
import { isScattered, looksLikeImage } from "./texture.js";
import type { ReadOptions, RigReading } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Depth = Extract<RigReading, { kind: "depth" }>;
export type Found<T> = Omit<T, "name">;

/** More holes than this are worth a word. */
const MANY_HOLES = 0.4;
/** A few stray depths say nothing of the unit: of those beyond the range so many may be. */
const STRAY = 0.01;
/** Share of SUN RGB-D's values that are multiples of 8: depths beyond 8.19 m wrap into the low bits. */
const MOSTLY = 0.9;
/** What a 16-bit sensor says where it is blind. */
const SATURATED = 0xffff;
/** Renderers write 1e10 where they saw nothing, and half floats their largest number. */
const BEYOND = 1e9;
const LARGEST_HALF = 65_504;
/** Depths nearer than this share of the median are none. */
const TINY = 1e-4;
/** The Kinect's 11-bit disparity where it is blind. */
const BLIND_DISPARITY = 2047;

const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;

interface Seen {
  count: number;
  nearest: number;
  farthest: number;
}

/** Of `values[offset + i * step]`. */
function seen(values: ArrayLike<number>, step = 1, offset = 0): Seen {
  const found: Seen = { count: 0, nearest: Infinity, farthest: 0 };
  for (let at = offset; at < values.length; at += step) {
    const value = values[at] ?? 0;
    if (!isThere(value)) continue;
    found.count++;
    if (value < found.nearest) found.nearest = value;
    if (value > found.farthest) found.farthest = value;
  }
  return found;
}

interface Judged {
  says: string;
  measured: NonNullable<Depth["measured"]>;
  warnings: ReaderWarning[];
}

/** What is said of any depth map, and what looks wrong about it. */
function judged(
  size: { width: number; height: number },
  stored: string,
  values: ArrayLike<number>,
  unit: Unit,
  step = 1,
  offset = 0,
): Judged {
  const { count, nearest, farthest } = seen(values, step, offset);
  const valid = count / (size.width * size.height);
  const sample = sampled(values, step, offset);
  const range = `${metresText(nearest * unit.metres)} to ${metresText(farthest * unit.metres)} m`;
  const warnings: ReaderWarning[] = [];
  if (unit.isGuessed)
    warnings.push(
      warning(
        "unit-guessed",
        `The file does not state its unit. It was guessed to be ${nameOf(unit.metres)}, so depths are ${range}${otherUnits(unit, nearest, farthest)}; give the unit if that is wrong.`,
        { unit: unit.metres },
      ),
    );
  const beyond = shareOf(sample, (value) => value * unit.metres < NEAREST || value * unit.metres > FARTHEST);
  if (beyond > STRAY)
    warnings.push(
      warning(
        "depth-range",
        `${percent(beyond)} of the depths are outside ${NEAREST} to ${FARTHEST} m (${range}): is the unit right?`,
        { share: beyond },
      ),
    );
  if (1 - valid > MANY_HOLES)
    warnings.push(warning("many-holes", `${percent(1 - valid)} of the depth map is missing.`, { share: 1 - valid }));
  return {
    measured: { stored, valid, range: [nearest * unit.metres, farthest * unit.metres] },
    says: `${size.width}x${size.height}, ${stored}, read as ${unit.says}, ${percent(valid)} valid, ${range}`,
    warnings,
  };
}

const nothing = () => badFile("no pixel of it holds a depth: all are zero, negative or not a number");

/** SUN RGB-D turns the bits of its millimetres by three, so that most values are multiples of 8. */
const isTurned = (values: Float64Array): boolean =>
  isVaried(values) && shareOf(values, (value) => value % 8 === 0) >= MOSTLY && quantile(values, 0.5) > 1000;
const turnedBack = (data: Uint16Array): Uint16Array => data.map((value) => (value >> 3) | (value << 13));

/** Mean change between neighbours in a row where both are valid; bytes in the wrong order make it a hundredfold. */
function roughness(data: Uint16Array, width: number, swap: boolean): number {
  let [sum, count] = [0, 0];
  for (let at = 1; at < data.length; at++) {
    let [one, other] = [data[at - 1] ?? 0, data[at] ?? 0];
    if (at % width === 0 || one === 0 || other === 0) continue;
    if (swap) [one, other] = [(one >> 8) | ((one & 255) << 8), (other >> 8) | ((other & 255) << 8)];
    sum += Math.abs(one - other);
    count++;
  }
  return count === 0 ? 0 : sum / count;
}

/** How much smoother the other order of bytes has to be before it is believed. */
const CLEARLY = 8;

/** 16-bit PGM are high byte first; some programs write them the other way round. */
function inOrder(picture: Picture, data: Uint16Array, warnings: ReaderWarning[]): Uint16Array {
  if (picture.format !== "PGM" || picture.bits !== 16) return data;
  if (roughness(data, picture.width, false) <= CLEARLY * roughness(data, picture.width, true)) return data;
  warnings.push(
    warning("bytes-swapped", "The samples are stored low byte first, against the format's rule; they were swapped."),
  );
  return data.map((value) => (value >> 8) | ((value & 255) << 8));
}

function ofIntegers(picture: Picture, integers: Uint8Array | Uint16Array, unit: number | undefined): Found<Depth> {
  const warnings = [...picture.warnings];
  let data = inOrder(picture, integers instanceof Uint16Array ? integers : new Uint16Array(integers), warnings);
  const notes = [...picture.notes];
  if (data.includes(SATURATED)) {
    data = data.map((value) => (value === SATURATED ? 0 : value));
    notes.push("65535 taken for holes");
  }
  let sample = sampled(data);
  if (sample.length === 0) throw nothing();
  let found = unit === undefined ? undefined : told(unit);
  if (found === undefined && picture.unit === undefined && picture.bits > 8 && isTurned(sample)) {
    data = turnedBack(data);
    sample = sampled(data);
    found = {
      metres: 0.001,
      says: "millimetres with their bits turned by three (SUN RGB-D; guessed)",
      isGuessed: true,
    };
  }
  const isSparse = isScattered(data, picture.width);
  found ??= picture.unit === undefined ? unitOfIntegers(sample, isSparse) : told(picture.unit);
  const depth = { width: picture.width, height: picture.height, data, unit: found.metres };
  const { says, measured, warnings: more } = judged(picture, `${picture.bits}-bit`, data, found);
  if (picture.bits <= 8)
    warnings.push(
      warning(
        "eight-bits",
        "Depths of 8 bits are too coarse for a calibration, and often a picture of the depth rather than the depth itself.",
      ),
    );
  if (picture.bits === 16 && looksLikeImage(data, picture.width)) warnings.push(warning("files-swapped", IMAGE));
  if (quantile(sample, 1) === BLIND_DISPARITY && shareOf(sample, (value) => value === BLIND_DISPARITY) > STRAY)
    warnings.push(warning("raw-disparity", DISPARITY));
  return {
    kind: "depth",
    depth,
    guessed: found.isGuessed ? ["unit"] : [],
    measured,
    says: [says, ...notes].join(", "),
    warnings: [...warnings, ...more],
  };
}
const IMAGE =
  "Its values change from pixel to pixel as those of an image do (infrared or intensities?), not as depths: is it the depth map?";
const DISPARITY =
  "The largest value is 2047, and common: this looks like a Kinect's raw disparity, which is not depth (z = 351.3 / (1092.5 - d) m or so).";

function ofFloats(picture: Picture, stored: Float32Array, unit: number | undefined): Found<Depth> {
  const beyond = picture.bits === 16 ? LARGEST_HALF : BEYOND;
  // What a lossy compression leaves of holes.
  const nothingThere = TINY * quantile(sampled(stored), 0.5);
  const isHole = (value: number) => value >= beyond || (value > 0 && value < nothingThere);
  const data = stored.some(isHole) ? stored.map((value) => (isHole(value) ? 0 : value)) : stored;
  const sample = sampled(data);
  if (sample.length === 0) throw nothing();
  const known = unit ?? picture.unit;
  const found = known === undefined ? unitOfFloats(sample) : told(known);
  const depth = { width: picture.width, height: picture.height, data, unit: found.metres };
  const { says, measured, warnings } = judged(picture, `${picture.bits}-bit float`, data, found);
  return {
    kind: "depth",
    depth,
    guessed: found.isGuessed ? ["unit"] : [],
    measured,
    says: [says, ...picture.notes].join(", "),
    warnings: [...picture.warnings, ...warnings],
  };
}

/** An organised cloud; its points are brought to metres, NaN where there is none. */
export function cloudDepth(cloud: Cloud, { unit }: ReadOptions): Found<Depth> {
  const points = cloud.points;
  if (!isOptical(points)) return turnedCloud(cloud, unit);
  const behind = sampled(
    points.map((value) => -value),
    3,
    2,
  ).length;
  const sample = sampled(points, 3, 2);
  if (sample.length === 0 && behind === 0) throw nothing();
  if (behind > sample.length)
    throw badFile("its points lie behind the camera (z is negative): turn them so that z looks forward, y down");
  const found = unit === undefined ? unitOfFloats(sample) : told(unit);
  checkAxes(points, cloud);
  const { says, measured, warnings } = judged(cloud, "an organised cloud", points, found, 3, 2);
  for (let at = 0; at < points.length; at += 3) {
    const there = isThere(points[at + 2] ?? NaN) && Number.isFinite(points[at]) && Number.isFinite(points[at + 1]);
    for (let axis = 0; axis < 3; axis++) points[at + axis] = there ? (points[at + axis] ?? NaN) * found.metres : NaN;
  }
  const depth = { width: cloud.width, height: cloud.height, points };
  return {
    kind: "depth",
    depth,
    guessed: found.isGuessed ? ["unit"] : [],
    measured,
    says: [says, ...cloud.notes].join(", "),
    warnings: [...cloud.warnings, ...warnings],
  };
}

/** The first `kept` of every so many values. */
const every = (data: Float32Array, channels: number, kept: number): Float32Array =>
  data.filter((_, at) => at % channels < kept);

/** A picture as a depth map; a float one of three channels is a cloud, as .npy has it. */
export function pictureDepth(picture: Picture, options: ReadOptions): Found<Depth> {
  const { data, channels } = picture;
  if (data instanceof Float32Array) {
    const isRepeated = channels === 3 && isGrey(picture);
    if (isRepeated) return ofFloats(picture, every(data, 3, 1), options.unit);
    if (channels === 3) return cloudDepth({ ...picture, points: data }, options);
    // x, y, z and intensity.
    if (channels === 4) return cloudDepth({ ...picture, points: every(data, 4, 3) }, options);
    if (channels !== 1) throw badFile(`a depth map has 1 channel and a cloud 3, not ${channels}`);
    return ofFloats(picture, data, options.unit);
  }
  const inside = hasColour(channels) && !isGrey(picture) ? decoded(picture) : undefined;
  if (inside !== undefined) return pictureDepth(inside, options);
  if (hasColour(channels) && !isGrey(picture))
    throw badFile(
      "it is a colour picture where a depth map was asked for: were the files swapped, or is it a rendering of the depth?",
    );
  const one = single(picture);
  if (one instanceof Float32Array) throw badFile("a depth map has 1 channel");
  return ofIntegers(picture, one, options.unit);
}

/** Whether all pixels are grey. */
export function isGrey({ channels, data }: Picture): boolean {
  if (!hasColour(channels)) return true;
  for (let at = 0; at < data.length; at += channels)
    if (data[at] !== data[at + 1] || data[at] !== data[at + 2]) return false;
  return true;
}
