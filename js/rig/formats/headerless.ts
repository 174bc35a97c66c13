/** Files of pixels and points that have no first bytes of their own, by what they hold. */
import { type Kind, kindOf } from "./kinds.js";
import { matrixText } from "./npy-matrix.js";
import { isColmapMap, pointSize } from "./raw.js";
import { isTable } from "./table.js";

/** "colmap": a depth map of COLMAP; "table": a depth map as text; "points": a LiDAR's list of points. */
export type RasterKind = Kind | "colmap" | "table" | "points";

const HEAD = 512;

/** What kind of pixels or points a file holds; nothing where it is a text of something else, or unknown. */
export function rasterKind(bytes: Uint8Array): RasterKind | undefined {
  const known = kindOf(bytes);
  if (known === "npy" && matrixText(bytes) !== undefined) return undefined;
  if (known !== undefined) return known;
  if (isColmapMap(bytes)) return "colmap";
  const isText = bytes.subarray(0, HEAD).every((byte) => byte > 13 || (byte > 8 && byte < 11) || byte === 13);
  if (isText) return isTable(bytes) ? "table" : undefined;
  return pointSize(bytes) === undefined ? undefined : "points";
}
