/** Files of pixels and points without known first bytes, recognised by their content. */
import { type Kind, kindOf } from "./kinds.js";
import { archiveText, matrixText } from "./npy-matrix.js";
import { arePoints, isColmapMap } from "./raw.js";
import { isTable } from "./table.js";

/** "colmap": a depth map of COLMAP; "table": a depth map as text; "points": a LiDAR's list of points. */
export type RasterKind = Kind | "colmap" | "table" | "points";

const HEAD = 512;

/** The kind of pixels or points that a file holds; undefined for other texts and unknown files. */
export function rasterKind(bytes: Uint8Array): RasterKind | undefined {
  const known = kindOf(bytes);
  if (known === "npy" && matrixText(bytes) !== undefined) return undefined;
  if (known === "npz" && archiveText(bytes) !== undefined) return undefined;
  if (known !== undefined) return known;
  if (isColmapMap(bytes)) return "colmap";
  const isText = bytes.subarray(0, HEAD).every((byte) => byte > 13 || (byte > 8 && byte < 11) || byte === 13);
  if (isText) return isTable(bytes) ? "table" : undefined;
  return arePoints(bytes) ? "points" : undefined;
}
