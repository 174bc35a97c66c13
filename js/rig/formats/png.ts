/** PNG with what it says of its colours. */
import { readPng } from "../../png.js";
import { checkSize } from "./limits.js";
import type { Picture } from "./picture.js";

export function pngPicture(bytes: Uint8Array): Picture {
  const { chunks, ...raster } = readPng(bytes, checkSize);
  const notes: string[] = [];
  const warnings: string[] = [];
  if (chunks.has("iCCP") && !chunks.has("sRGB") && raster.channels >= 3) warnings.push("It carries a colour profile, which is not applied: colours are taken for sRGB.");
  return { ...raster, format: "PNG", notes, warnings };
}
