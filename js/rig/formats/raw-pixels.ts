/** Pixels without a full header: raw ones of a given size, and COLMAP's depth maps. Loads with the first of them. */
import { badFile } from "../../errors.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { checkBytes, checkSize } from "./limits.js";
import type { Picture } from "./picture.js";
import { COLMAP, type Size, headOf } from "./raw.js";

/** "width&height&channels&", then floats row by row. */
export function readColmapMap(bytes: Uint8Array): Picture {
  const [head = "", width, height, channels] = COLMAP.exec(headOf(bytes)) ?? [];
  const size = { width: Number(width), height: Number(height) };
  checkSize(size.width, size.height);
  if (channels !== "1")
    throw badFile(`it is COLMAP's map of ${channels} channels (normals); the depth map is in stereo/depth_maps`);
  const body = bytes.subarray(head.length);
  checkBytes(4 * size.width * size.height, body.length, "this depth map of COLMAP");
  const warnings: ReaderWarning[] = [
    warning(
      "unit-guessed",
      "COLMAP's depths have the scale of its reconstruction, which was guessed to be metres; give the unit if that is wrong.",
      { unit: 1 },
    ),
  ];
  const data = new Float32Array(body.slice(0, 4 * size.width * size.height).buffer);
  return { ...size, channels: 1, data, format: "COLMAP", bits: 32, unit: 1, notes: ["COLMAP's depth map"], warnings };
}

/** Whether values of four bytes are floats rather than integers, which are next to zero when they are read as floats. */
function areFloats(values: Float32Array): boolean {
  let [plausible, tiny] = [0, 0];
  for (const value of values) {
    if (value === 0 || (Math.abs(value) >= 1e-3 && Math.abs(value) < 1e7) || !Number.isFinite(value)) plausible++;
    else tiny++;
  }
  return tiny < 0.01 * (plausible + tiny);
}

/** Pixels without a header, of a given size. */
export function readRaw(bytes: Uint8Array, [width, height]: Size): Picture {
  checkSize(width, height);
  const each = bytes.length / (width * height);
  const own = () => bytes.slice().buffer;
  const size = { width, height, channels: 1, format: "raw", notes: ["raw pixels"], warnings: [] };
  if (each === 1) return { ...size, data: new Uint8Array(own()), bits: 8 };
  if (each === 2) return { ...size, data: new Uint16Array(own()), bits: 16 };
  if (each === 8) return { ...size, data: new Float32Array(new Float64Array(own())), bits: 64 };
  if (each === 4) {
    const floats = new Float32Array(own());
    return { ...size, data: areFloats(floats) ? floats : new Float32Array(new Uint32Array(own())), bits: 32 };
  }
  throw badFile(
    `its ${bytes.length} bytes are not ${width}x${height} pixels of 1, 2, 4 or 8 bytes: is the size wrong, or does it have a header?`,
  );
}
