/** Range images for callers who know what their camera sees: what makes them is loaded when the first one is asked for. */
import type { RangeImage, Scan, View } from "./lidar/index.js";

/**
 * The points of a scan in rows and columns, in the scan's own frame; of a `view` the part that its camera may see, with a margin of some
 * degrees. Nothing for a scan without measurements.
 */
export async function rangeImage(scan: Scan, view?: View): Promise<RangeImage | undefined> {
  const lidar = await import("./lidar/index.js");
  return lidar.rangeImage(scan, view);
}
