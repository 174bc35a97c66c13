/** PNG, turned upright and converted to sRGB by its metadata. */
import { readPng } from "../../png.js";
import { exifOrientation, turnedBy } from "./exif.js";
import { checkSize } from "./limits.js";
import type { Picture } from "./picture.js";
import { once } from "../once.js";
import { warning } from "../warnings.js";

/** Most pictures have no colour profile. */
const profiles = once(() => import("./icc.js"));

/** gAMA of a linear picture and of sRGB, and the tolerance for both. */
const LINEAR = 100_000;
const SRGB = 45_455;
const SAME = 0.02;

function withGamma(picture: Picture, chunk: Uint8Array): Picture {
  const gamma = chunk.length >= 4 ? new DataView(chunk.buffer, chunk.byteOffset).getUint32(0) : 0;
  const is = (other: number) => Math.abs(gamma / other - 1) < SAME;
  if (is(LINEAR)) return { ...picture, transfer: "linear", notes: [...picture.notes, "linear"] };
  if (is(SRGB) || gamma === 0) return picture;
  return {
    ...picture,
    warnings: [
      ...picture.warnings,
      warning("gamma-ignored", `The gamma of ${(gamma / LINEAR).toFixed(3)} is ignored; colours are read as sRGB.`, {
        gamma: gamma / LINEAR,
      }),
    ],
  };
}

async function inColour(picture: Picture, chunks: Map<string, Uint8Array>): Promise<Picture> {
  const [profile, gamma] = [chunks.get("iCCP"), chunks.get("gAMA")];
  if (chunks.has("sRGB")) return { ...picture, transfer: "srgb", notes: ["sRGB"] };
  if (profile) {
    const { damagedProfile, inSrgb, pngProfile } = await profiles();
    try {
      return inSrgb(picture, pngProfile(profile));
    } catch {
      return { ...picture, warnings: [damagedProfile()] };
    }
  }
  return gamma ? withGamma(picture, gamma) : picture;
}

/** `check` refuses a size. */
export async function pngPicture(bytes: Uint8Array, check = checkSize): Promise<Picture> {
  const { chunks, ...raster } = readPng(bytes, check);
  const picture: Picture = { ...raster, format: "PNG", notes: [], warnings: [] };
  // A grey picture may hold depths, so its colour metadata are not used.
  const coloured = picture.channels >= 3 ? await inColour(picture, chunks) : picture;
  const exif = chunks.get("eXIf");
  return exif ? turnedBy(coloured, exifOrientation(exif), "EXIF says") : coloured;
}
