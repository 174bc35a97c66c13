/**
 * Scales views down by a whole factor. A colour is the mean linear intensity of the usable pixels of a block, as in src/view/working_size.rs;
 * a depth is that of the block's middle, because the mean across an edge lies on neither surface.
 */
import type { ColorImage, DepthMap, Pinhole } from "../types/index.js";

/** Darkest usable levels, the same as in a run (src/view/colour.rs); the brightest level is saturated. */
const DARKEST = { 8: 4, 16: 64 } as const;
const FULL = 0xffff;
/** Smallest share of a block that usable pixels must cover. */
const COVERED = 0.5;

const decoded = (value: number): number => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
const encoded = (value: number): number => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);

/** Linear intensity of each level; NaN if it is not usable. */
function linearLevels(bits: 8 | 16, isLinear: boolean): Float32Array {
  const most = 2 ** bits - 1;
  return Float32Array.from({ length: most + 1 }, (_, level) => {
    if (level < DARKEST[bits] || level === most) return NaN;
    return isLinear ? level / most : decoded(level / most);
  });
}

/** The pixels of a block of the full view. */
interface Block {
  column: number;
  row: number;
  factor: number;
  /** Columns of the full view. */
  width: number;
}

/** Sums over a block: intensities and number of its usable pixels, brightness and opacity. */
class Sums {
  readonly linear = [0, 0, 0];
  usable = 0;
  inside = 0;
  /** Sum of all levels of the red channel, which distinguishes black from saturated. */
  level = 0;
  opaque = 0;

  clear(): void {
    this.linear.fill(0);
    this.usable = this.inside = this.level = this.opaque = 0;
  }
}

type Integers = Exclude<ColorImage["data"], Float32Array>;

function addLevels(
  { column, row, factor, width }: Block,
  data: Integers,
  mask: Uint8Array | undefined,
  of: Float32Array,
  sums: Sums,
): void {
  for (let y = row * factor; y < (row + 1) * factor; y++) {
    for (let x = column * factor; x < (column + 1) * factor; x++) {
      const pixel = y * width + x;
      const at = 4 * pixel;
      const [level = 0, alpha = 0] = [data[at], data[at + 3]];
      sums.level += level;
      if (alpha > 0) sums.opaque++;
      if (mask !== undefined && mask[pixel] === 0) continue;
      sums.inside++;
      const [r = NaN, g = NaN, b = NaN] = [of[level], of[data[at + 1] ?? 0], of[data[at + 2] ?? 0]];
      if (alpha === 0 || Number.isNaN(r + g + b)) continue;
      sums.usable++;
      sums.linear[0] = (sums.linear[0] ?? 0) + r;
      sums.linear[1] = (sums.linear[1] ?? 0) + g;
      sums.linear[2] = (sums.linear[2] ?? 0) + b;
    }
  }
}

function addFloats(
  { column, row, factor, width }: Block,
  data: Float32Array,
  mask: Uint8Array | undefined,
  sums: Sums,
) {
  for (let y = row * factor; y < (row + 1) * factor; y++) {
    for (let x = column * factor; x < (column + 1) * factor; x++) {
      const pixel = y * width + x;
      if (mask !== undefined && mask[pixel] === 0) continue;
      sums.inside++;
      const rgb = [data[3 * pixel] ?? NaN, data[3 * pixel + 1] ?? NaN, data[3 * pixel + 2] ?? NaN];
      if (!rgb.every((value) => value > 0 && value < Infinity)) continue;
      sums.usable++;
      for (let c = 0; c < 3; c++) sums.linear[c] = (sums.linear[c] ?? 0) + (rgb[c] ?? 0);
    }
  }
}

/** The means of a block as 16-bit levels; black or saturated if too few of its pixels are usable. */
function putLevels(to: Uint16Array, at: number, { linear, usable, level, opaque }: Sums, rules: Rules): void {
  const { area, isLinear, most } = rules;
  const unusable = level / area > most / 2 ? FULL : 0;
  for (let c = 0; c < 3; c++) {
    const mean = (linear[c] ?? 0) / usable;
    const value = Math.round(FULL * (isLinear ? mean : encoded(mean)));
    to[at + c] = usable >= COVERED * area ? Math.min(FULL - 1, Math.max(DARKEST[16], value)) : unusable;
  }
  to[at + 3] = opaque >= COVERED * area ? FULL : 0;
}

/** How the levels of a block are reduced. */
interface Rules {
  /** Pixels of a block. */
  area: number;
  isLinear: boolean;
  /** The largest level of the full view. */
  most: number;
}

/** A colour image and its mask, scaled down by a whole factor. Integers become 16-bit, in the same encoding. */
export function reducedImage(image: ColorImage, factor: number): ColorImage {
  const { data, mask, camera, ...rest } = image;
  const size = smaller(image, factor);
  const count = size.width * size.height;
  const area = factor ** 2;
  const isFloat = data instanceof Float32Array;
  const bits = data instanceof Uint16Array ? 16 : 8;
  const rules: Rules = { area, isLinear: image.transfer === "linear", most: 2 ** bits - 1 };
  const levels = isFloat ? undefined : linearLevels(bits, rules.isLinear);
  const out = isFloat ? new Float32Array(3 * count) : new Uint16Array(4 * count);
  const inside = mask && new Uint8Array(count);
  const sums = new Sums();
  for (let pixel = 0; pixel < count; pixel++) {
    const block = { column: pixel % size.width, row: Math.floor(pixel / size.width), factor, width: image.width };
    sums.clear();
    if (data instanceof Float32Array) addFloats(block, data, mask, sums);
    else if (levels) addLevels(block, data, mask, levels, sums);
    if (out instanceof Uint16Array) putLevels(out, 4 * pixel, sums, rules);
    else
      for (let c = 0; c < 3; c++)
        out[3 * pixel + c] = sums.usable >= COVERED * area ? (sums.linear[c] ?? 0) / sums.usable : NaN;
    if (inside) inside[pixel] = sums.inside >= COVERED * area ? 255 : 0;
  }
  return {
    ...rest,
    ...size,
    data: out,
    ...(inside && { mask: inside }),
    ...(camera && { camera: reducedCamera(camera, factor, (factor - 1) / 2) }),
  };
}

/** A depth map and its mask, reduced to the middle pixel of each block. */
export function reducedDepth(depth: DepthMap, factor: number): DepthMap {
  const { data, points, mask, camera, intensity: _, ...rest } = depth;
  const size = smaller(depth, factor);
  const count = size.width * size.height;
  const middle = Math.floor(factor / 2);
  const pick = <T extends Float32Array | Uint16Array | Uint8Array>(from: T, to: T, channels: number): T => {
    for (let pixel = 0; pixel < count; pixel++) {
      const [column, row] = [pixel % size.width, Math.floor(pixel / size.width)];
      const source = (row * factor + middle) * depth.width + column * factor + middle;
      for (let c = 0; c < channels; c++) to[pixel * channels + c] = from[source * channels + c] ?? 0;
    }
    return to;
  };
  return {
    ...rest,
    ...size,
    ...(data instanceof Float32Array && { data: pick(data, new Float32Array(count), 1) }),
    ...(data instanceof Uint16Array && { data: pick(data, new Uint16Array(count), 1) }),
    ...(points && { points: pick(points, new Float32Array(3 * count), 3) }),
    ...(mask && { mask: pick(mask, new Uint8Array(count), 1) }),
    ...(camera && { camera: reducedCamera(camera, factor, middle) }),
  };
}

const smaller = ({ width, height }: { width: number; height: number }, factor: number) => ({
  width: Math.floor(width / factor),
  height: Math.floor(height / factor),
});

/** The camera of a view reduced to every `factor`-th pixel, starting at pixel `offset`. */
function reducedCamera(camera: Pinhole, factor: number, offset: number): Pinhole {
  const { fx, fy, cx, cy } = camera;
  return { ...camera, fx: fx / factor, fy: fy / factor, cx: (cx - offset) / factor, cy: (cy - offset) / factor };
}
