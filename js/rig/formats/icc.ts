/**
 * Colour profiles: those that consist of a matrix and three curves are converted to sRGB; others cause a warning.
 *
 * Written here because lcms as wasm has 100 kB. The profiles that cameras and screens embed (Display P3, Adobe RGB, ProPhoto) are of this
 * kind.
 */
import { inflateUpTo } from "../../inflate.js";
import type { Picture } from "./picture.js";
import { warning } from "../warnings.js";

const MOST_PROFILE = 2 ** 22;
const MOST_TAGS = 200;

/** From the connection space (XYZ under D50) to linear sRGB: the inverse of sRGB's own profile. */
const FROM_XYZ = [3.1338561, -1.6168667, -0.4906146, -0.9787684, 1.9161415, 0.033454, 0.0719453, -0.2289914, 1.4052427];
/** Resolution of the tabulated curves: an eighth of a step of 8 bits where they are steepest. */
const TABLE = 16_384;
/** Profiles that differ by less are sRGB under another name: one step of 8 bits. */
const SAME = 1 / 255;

const encoded = (linear: number): number =>
  linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;

type Curve = (value: number) => number;
interface Profile {
  name: string;
  /** From linear device values to XYZ, with columns red, green and blue; undefined if the profile is of another kind. */
  matrix?: number[];
  curves?: Curve[];
}

const latin = (bytes: Uint8Array): string => String.fromCharCode(...bytes.filter((byte) => byte >= 32 && byte < 127));

function describe(tag: Uint8Array, view: DataView): string {
  if (latin(tag.subarray(0, 4)) === "desc") return latin(tag.subarray(12, 12 + Math.min(view.getUint32(8), 80)));
  if (latin(tag.subarray(0, 4)) !== "mluc") return "";
  return latin(tag.subarray(view.getUint32(24), view.getUint32(24) + Math.min(view.getUint32(20), 160)));
}

function curveOf(view: DataView, type: string): Curve | undefined {
  const fixed = (at: number) => view.getInt32(at) / 65_536;
  if (type === "curv") {
    const count = view.getUint32(8);
    if (count === 0) return (value) => value;
    if (count === 1) return (value) => value ** (view.getUint16(12) / 256);
    const points = Array.from({ length: Math.min(count, 4096) }, (_, index) => view.getUint16(12 + 2 * index) / 65_535);
    return (value) => {
      const at = Math.min(1, Math.max(0, value)) * (points.length - 1);
      const low = Math.floor(at);
      return (points[low] ?? 0) + (at - low) * ((points[low + 1] ?? points[low] ?? 0) - (points[low] ?? 0));
    };
  }
  if (type !== "para") return undefined;
  const kind = view.getUint16(8);
  const p = Array.from({ length: [1, 3, 4, 5, 7][kind] ?? 0 }, (_, index) => fixed(12 + 4 * index));
  const [g = 1, a = 1, b = 0, c = 0, d = 0, e = 0, f = 0] = p;
  if (kind === 0) return (value) => value ** g;
  if (kind === 1) return (value) => (value >= -b / a ? (a * value + b) ** g : 0);
  if (kind === 2) return (value) => (value >= -b / a ? (a * value + b) ** g + c : c);
  if (kind === 3) return (value) => (value >= d ? (a * value + b) ** g : c * value);
  return kind === 4 ? (value) => (value >= d ? (a * value + b) ** g + e : c * value + f) : undefined;
}

function parse(bytes: Uint8Array): Profile {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const tags = new Map<string, Uint8Array>();
  const count = Math.min(view.getUint32(128), MOST_TAGS);
  for (let index = 0; index < count; index++) {
    const at = 132 + 12 * index;
    tags.set(
      latin(bytes.subarray(at, at + 4)),
      bytes.subarray(view.getUint32(at + 4), view.getUint32(at + 4) + view.getUint32(at + 8)),
    );
  }
  const viewOf = (tag: Uint8Array) => new DataView(tag.buffer, tag.byteOffset, tag.byteLength);
  const desc = tags.get("desc");
  const name = desc ? describe(desc, viewOf(desc)).trim() : "";
  const columns = ["rXYZ", "gXYZ", "bXYZ"].map((tag) => tags.get(tag));
  const curves = ["rTRC", "gTRC", "bTRC"].map((tag) => {
    const body = tags.get(tag);
    return body && curveOf(viewOf(body), latin(body.subarray(0, 4)));
  });
  if (
    latin(bytes.subarray(16, 20)).trim() !== "RGB" ||
    tags.has("A2B0") ||
    !columns.every((column) => column !== undefined) ||
    !curves.every((curve) => curve !== undefined)
  )
    return { name };
  const xyz = columns.map((column) => [8, 12, 16].map((at) => viewOf(column).getInt32(at) / 65_536));
  return { name, matrix: [0, 1, 2].flatMap((row) => xyz.map((column) => column[row] ?? 0)), curves };
}

/** From linear values of the profile to linear sRGB. */
const toSrgb = (matrix: number[]): number[] =>
  Array.from({ length: 9 }, (_, index) =>
    [0, 1, 2].reduce(
      (sum, k) => sum + (FROM_XYZ[3 * Math.floor(index / 3) + k] ?? 0) * (matrix[3 * k + (index % 3)] ?? 0),
      0,
    ),
  );

const isSrgb = (matrix: number[], curves: Curve[]): boolean =>
  toSrgb(matrix).every((value, index) => Math.abs(value - (index % 4 === 0 ? 1 : 0)) < 0.01) &&
  [0.1, 0.25, 0.5, 0.75].every((value) => curves.every((curve) => Math.abs(encoded(curve(value)) - value) < SAME));

function converted({ width, height, channels, data }: Picture, matrix: number[], curves: Curve[]): Picture["data"] {
  const out = data.slice() as typeof data;
  const most = data instanceof Uint16Array ? 65_535 : 255;
  const tables = curves.map((curve) => Float64Array.from({ length: most + 1 }, (_, value) => curve(value / most)));
  const back = Float64Array.from({ length: TABLE + 1 }, (_, index) => Math.round(most * encoded(index / TABLE)));
  const m = toSrgb(matrix);
  const [red, green, blue] = tables as [Float64Array, Float64Array, Float64Array];
  for (let at = 0; at < width * height * channels; at += channels) {
    const [r, g, b] = [red[data[at] ?? 0] ?? 0, green[data[at + 1] ?? 0] ?? 0, blue[data[at + 2] ?? 0] ?? 0];
    for (let channel = 0; channel < 3; channel++) {
      const value = (m[3 * channel] ?? 0) * r + (m[3 * channel + 1] ?? 0) * g + (m[3 * channel + 2] ?? 0) * b;
      out[at + channel] = back[Math.round(TABLE * Math.min(1, Math.max(0, value)))] ?? 0;
    }
  }
  return out;
}

export const damagedProfile = () =>
  warning("colour-profile-ignored", "The colour profile is damaged; colours are read as sRGB.");

/** The picture in sRGB, or a warning that its profile is ignored. */
export function inSrgb(picture: Picture, profile: Uint8Array): Picture {
  if (picture.channels < 3 || picture.data instanceof Float32Array) return picture;
  let found: Profile;
  try {
    found = parse(profile);
  } catch {
    return {
      ...picture,
      warnings: [...picture.warnings, damagedProfile()],
    };
  }
  const { name, matrix, curves } = found;
  const called = name === "" ? "without a name" : `"${name.slice(0, 60)}"`;
  if (matrix === undefined || curves === undefined) {
    if (/srgb/i.test(name)) return { ...picture, transfer: "srgb", notes: [...picture.notes, "sRGB"] };
    return {
      ...picture,
      warnings: [
        ...picture.warnings,
        warning("colour-profile-ignored", `The colour profile ${called} is not supported; colours are read as sRGB.`, {
          profile: name,
        }),
      ],
    };
  }
  if (isSrgb(matrix, curves)) return { ...picture, transfer: "srgb", notes: [...picture.notes, "sRGB"] };
  return {
    ...picture,
    data: converted(picture, matrix, curves),
    transfer: "srgb",
    notes: [...picture.notes, `from the colour profile ${called} to sRGB`],
  };
}

/** PNG stores a name, a zero byte and the compressed profile. */
export function pngProfile(chunk: Uint8Array): Uint8Array {
  return inflateUpTo(chunk.subarray(chunk.indexOf(0) + 2), MOST_PROFILE, "its colour profile");
}
