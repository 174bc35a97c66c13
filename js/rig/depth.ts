/**
 * Converts a raster or a cloud to a depth map in metres: its unit (given, in the file, or guessed from the values), its valid part, and
 * whether the values look like those of a depth camera.
 *
 * Limits: values alone do not always distinguish millimetres from fifths of a millimetre (TUM), so every guess is a warning.
 */
import { badFile } from "../errors.js";
import { type Pixels, hasColour, single } from "../raster.js";
import { checkAxes } from "./axes.js";
import { decoded } from "./formats/coded.js";
import type { Cloud, Picture } from "./formats/picture.js";
import {
  type Extent,
  FARTHEST,
  NEAREST,
  type Unit,
  extentOf,
  isThere,
  isVaried,
  knownUnit,
  metresText,
  nameOf,
  otherUnits,
  sampled,
  shareOf,
  unitOfFloats,
  unitOfIntegers,
} from "./guess.js";
import { type InverseDepth, depthsOf } from "./inverse.js";
import { isOptical, turnedCloud } from "./scan.js";
import { quantile } from "./statistics.js";
import { isScattered, looksLikeImage } from "./texture.js";
import type { DepthReading, ReadOptions, Unnamed } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

type Depth = Unnamed<DepthReading>;

/** Smallest share of missing pixels that causes a warning. */
const MANY_HOLES = 0.4;
/** Share of the depths that may be out of range without a warning: a few stray depths are no evidence against the unit. */
const STRAY = 0.01;
/** Least share of multiples of 8 by which SUN RGB-D's values are recognised: depths beyond 8.19 m wrap into the low bits. */
const MOSTLY = 0.9;
/** A 16-bit sensor's value for a pixel without a measurement. */
const SATURATED = 0xffff;
/** Renderers write 1e10 where no surface is hit, and half floats their largest number. */
const BEYOND = 1e9;
const LARGEST_HALF = 65_504;
/** Depths below this share of the median are holes. */
const TINY = 1e-4;
/** The 11-bit disparity of a Kinect for a pixel without a measurement. */
const BLIND_DISPARITY = 2047;

const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;

interface Values extends Extent {
  /** A sample of the values, in ascending order. */
  sample: Float64Array;
}

/** Warnings about suspicious values of a depth map, whatever its format. */
function doubts({ sample, ...extent }: Values, unit: Unit, valid: number, range: string): ReaderWarning[] {
  const warnings: ReaderWarning[] = [];
  if (unit.isGuessed)
    warnings.push(
      warning(
        "unit-guessed",
        `The file does not state its unit. It was guessed to be ${nameOf(unit.metres)}, so depths are ${range}${otherUnits(unit, extent)}; give the unit if that is wrong.`,
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
    warnings.push(
      warning("many-holes", `${(100 * (1 - valid)).toFixed(0)} % of the depth map is missing.`, { share: 1 - valid }),
    );
  return warnings;
}

/** The reading of a depth map or a cloud; `stored` describes the format of its numbers. */
function reading(
  { width, height, notes, warnings }: Pick<Picture, "width" | "height" | "notes" | "warnings">,
  depth: Depth["depth"],
  stored: string,
  values: Values,
  unit: Unit,
): Depth {
  const range: [number, number] = [values.nearest * unit.metres, values.farthest * unit.metres];
  const valid = values.count / (width * height);
  const between = `${range.map(metresText).join(" to ")} m`;
  const says = [`${width}x${height}`, stored, `read as ${unit.says}`, `${percent(valid)} valid`, between, ...notes];
  return {
    kind: "depth",
    depth,
    guessed: unit.isGuessed ? ["unit"] : [],
    measured: { stored, valid, range },
    says: says.join(", "),
    warnings: [...warnings, ...doubts(values, unit, valid, between)],
  };
}

const nothing = () => badFile("it has no valid depth: all values are zero, negative or not a number");

/** SUN RGB-D rotates the bits of its millimetres by three, so that most values are multiples of 8. */
const isTurned = (values: Float64Array): boolean =>
  isVaried(values) && shareOf(values, (value) => value % 8 === 0) >= MOSTLY && quantile(values, 0.5) > 1000;
const turnedBack = (data: Uint16Array): Uint16Array => data.map((value) => (value >> 3) | (value << 13));
const TURNED: Unit = {
  metres: 0.001,
  says: "millimetres with their bits rotated by three (SUN RGB-D; guessed)",
  isGuessed: true,
};

/** Mean change between valid neighbours in a row; bytes in the wrong order make it a hundred times as large. */
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

/** Factor by which the other byte order must be smoother to be used. */
const CLEARLY = 8;

/** Puts the samples into the right order of bytes. The format stores the high byte first, but some programs write it last. */
function inOrder(picture: Picture, data: Uint16Array, warnings: ReaderWarning[]): Uint16Array {
  if (picture.format !== "PGM" || picture.bits !== 16) return data;
  if (roughness(data, picture.width, false) <= CLEARLY * roughness(data, picture.width, true)) return data;
  warnings.push(
    warning("bytes-swapped", "The samples are stored low byte first, against the format's rule; they were swapped."),
  );
  return data.map((value) => (value >> 8) | ((value & 255) << 8));
}

/** Warnings about integers that are too coarse for depths, or are not depths at all. */
function lookalikes({ bits, width }: Picture, data: Uint16Array, sample: Float64Array): ReaderWarning[] {
  const isDisparity =
    quantile(sample, 1) === BLIND_DISPARITY && shareOf(sample, (value) => value === BLIND_DISPARITY) > STRAY;
  return [
    ...(bits <= 8 ? [warning("eight-bits", COARSE)] : []),
    ...(bits === 16 && looksLikeImage(data, width) ? [warning("files-swapped", IMAGE)] : []),
    ...(isDisparity ? [warning("raw-disparity", DISPARITY)] : []),
  ];
}
const COARSE =
  "Depths of 8 bits are too coarse for a calibration, and often a picture of the depth rather than the depth itself.";
const IMAGE =
  "Its values vary from pixel to pixel like those of an image (infrared or intensities?), not like depths: is it the depth map?";
const DISPARITY =
  "The largest value is 2047 and occurs often: this looks like a Kinect's raw disparity, not depth (z is about 351.3 / (1092.5 - d) m).";

function ofIntegers(picture: Picture, integers: Uint8Array | Uint16Array, given: number | undefined): Depth {
  const [warnings, notes] = [[...picture.warnings], [...picture.notes]];
  let data = inOrder(picture, integers instanceof Uint16Array ? integers : new Uint16Array(integers), warnings);
  if (data.includes(SATURATED)) {
    data = data.map((value) => (value === SATURATED ? 0 : value));
    notes.push("65535 treated as holes");
  }
  let sample = sampled(data);
  if (sample.length === 0) throw nothing();
  const { width, height, bits } = picture;
  const known = given ?? picture.unit;
  const isSunRgbd = known === undefined && bits > 8 && isTurned(sample);
  if (isSunRgbd) {
    data = turnedBack(data);
    sample = sampled(data);
  }
  const guessed = () => (isSunRgbd ? TURNED : unitOfIntegers(sample, isScattered(data, width)));
  const unit = known === undefined ? guessed() : knownUnit(known);
  warnings.push(...lookalikes(picture, data, sample));
  const depth = { width, height, data, unit: unit.metres };
  return reading({ ...picture, notes, warnings }, depth, `${bits}-bit`, { ...extentOf(data), sample }, unit);
}

function ofFloats(picture: Picture, stored: Float32Array, given: number | undefined): Depth {
  const beyond = picture.bits === 16 ? LARGEST_HALF : BEYOND;
  const before = sampled(stored);
  // A lossy compression leaves values next to zero in holes.
  const tiny = TINY * quantile(before, 0.5);
  const isHole = (value: number) => value >= beyond || (value > 0 && value < tiny);
  const hasHoles = stored.some(isHole);
  const data = hasHoles ? stored.map((value) => (isHole(value) ? 0 : value)) : stored;
  const sample = hasHoles ? sampled(data) : before;
  if (sample.length === 0) throw nothing();
  const { width, height, bits } = picture;
  const known = given ?? picture.unit;
  const unit = known === undefined ? unitOfFloats(sample) : knownUnit(known);
  const depth = { width, height, data, unit: unit.metres };
  return reading(picture, depth, `${bits}-bit float`, { ...extentOf(data), sample }, unit);
}

const RELATIVE =
  "Its numbers are inverse depths, known up to a factor only. The median depth was set to the longer side of the map, in pixels, which suits a view without a camera; for metres give the numerator (focal length * baseline).";

/** A map whose numbers are larger where a surface is nearer. */
function ofInverse(
  picture: Picture,
  stored: Exclude<Pixels, Uint8Array>,
  inverse: InverseDepth,
  given?: number,
): Depth {
  const data = depthsOf(stored, picture, inverse);
  const sample = sampled(data);
  if (sample.length === 0) throw nothing();
  const { width, height, bits } = picture;
  const { numerator } = inverse;
  const said = numerator === undefined ? "pixels, from inverse depths" : `metres: ${numerator} / stored number`;
  const unit: Unit = given === undefined ? { metres: 1, says: said, isGuessed: false } : knownUnit(given);
  const kind = stored instanceof Float32Array ? `${bits}-bit float` : `${bits}-bit`;
  const found = reading(picture, { width, height, data, unit: unit.metres }, kind, { ...extentOf(data), sample }, unit);
  if (numerator !== undefined) return found;
  const warnings = found.warnings.filter(({ code }) => code !== "depth-range");
  return { ...found, guessed: ["unit"], warnings: [...warnings, warning("unit-guessed", RELATIVE)] };
}

/** An organised cloud; its points are converted to metres in place, NaN where missing. */
export function cloudDepth(cloud: Cloud, { unit: given }: ReadOptions): Depth {
  const { points, width, height, intensity } = cloud;
  if (!isOptical(points)) return turnedCloud(cloud, given);
  const extent = extentOf(points, 3, 2);
  let behind = 0;
  for (let at = 2; at < points.length; at += 3) if (isThere(-(points[at] ?? NaN))) behind++;
  if (extent.count === 0 && behind === 0) throw nothing();
  if (behind > extent.count)
    throw badFile("its points lie behind the camera (z is negative): rotate them so that z points forward and y down");
  const sample = sampled(points, 3, 2);
  const unit = given === undefined ? unitOfFloats(sample) : knownUnit(given);
  checkAxes(points, cloud);
  for (let at = 0; at < points.length; at += 3) {
    const there = isThere(points[at + 2] ?? NaN) && Number.isFinite(points[at]) && Number.isFinite(points[at + 1]);
    for (let axis = 0; axis < 3; axis++) points[at + axis] = there ? (points[at + axis] ?? NaN) * unit.metres : NaN;
  }
  const depth = { width, height, points, ...(intensity && { intensity }) };
  return reading(cloud, depth, "an organised cloud", { ...extent, sample }, unit);
}

/** The first three channels of all pixels. */
const every = (data: Float32Array, channels: number, kept: number): Float32Array =>
  data.filter((_, at) => at % channels < kept);

/** A picture as a depth map; floats of three channels are a cloud, which .npy files hold. */
export function pictureDepth(picture: Picture, options: ReadOptions): Depth {
  const { data, channels } = picture;
  const { unit, inverse } = options;
  const floats = (values: Float32Array) =>
    inverse ? ofInverse(picture, values, inverse, unit) : ofFloats(picture, values, unit);
  if (data instanceof Float32Array) {
    const isRepeated = channels === 3 && isGrey(picture);
    if (isRepeated) return floats(every(data, 3, 1));
    if (channels === 3) return cloudDepth({ ...picture, points: data }, options);
    // The channels are x, y, z and intensity.
    if (channels === 4) {
      const intensity = data.filter((_, at) => at % 4 === 3);
      return cloudDepth({ ...picture, points: every(data, 4, 3), intensity }, options);
    }
    if (channels !== 1) throw badFile(`a depth map has 1 channel and a cloud 3, not ${channels}`);
    return floats(data);
  }
  const inside = hasColour(channels) && !isGrey(picture) ? decoded(picture) : undefined;
  if (inside !== undefined) return pictureDepth(inside, options);
  if (hasColour(channels) && !isGrey(picture))
    throw badFile(
      "it is a colour picture where a depth map was expected: were the files swapped, or is it a rendering of the depth?",
    );
  const one = single(picture);
  if (one instanceof Float32Array) throw badFile("a depth map has 1 channel");
  return inverse ? ofInverse(picture, Uint16Array.from(one), inverse, unit) : ofIntegers(picture, one, unit);
}

/** Whether all pixels are grey. */
export function isGrey({ channels, data }: Picture): boolean {
  if (!hasColour(channels)) return true;
  for (let at = 0; at < data.length; at += channels)
    if (data[at] !== data[at + 1] || data[at] !== data[at + 2]) return false;
  return true;
}
