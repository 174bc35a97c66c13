/** Range images for callers who know what their camera sees; the code that makes them is loaded with the first one. */
import { camera } from "../cameras.js";
import { array, numbers, object, side } from "../check.js";
import { BimodalError } from "../errors.js";
import { cameraOf } from "../matrices.js";
import type { RangeImage, Scan, View } from "./lidar/index.js";

const scanShape = object(
  {
    points: array(Float32Array),
    ring: array(Float32Array),
    intensity: array(Float32Array),
    times: array(Float64Array),
  },
  ["points"],
);
const members = ["rotation", "translation", "camera", "width", "height"];
const viewShape = object({ rotation: numbers(9), translation: numbers(3), camera, width: side, height: side }, members);

/** Lists of a scan whose length differs from the number of points. */
function checkLengths({ points, ...lists }: Scan): void {
  if (points.length % 3 !== 0)
    throw new BimodalError(
      "size",
      `scan.points: needs three numbers for each point, not ${points.length}`,
      "scan.points",
    );
  const count = points.length / 3;
  for (const [name, list] of Object.entries(lists))
    if (list !== undefined && list.length !== count)
      throw new BimodalError("size", `scan.${name}: needs ${count} numbers, not ${list.length}`, `scan.${name}`);
}

/**
 * The points of a scan in rows and columns, in the scan's own frame; with a `view`, only the part that its camera may see, with a margin of
 * some degrees. Undefined for a scan without measurements.
 */
export async function rangeImage(scan: Scan, view?: View): Promise<RangeImage | undefined> {
  scanShape(scan, "scan");
  checkLengths(scan);
  if (view !== undefined) viewShape(view, "view");
  const lidar = await import("./lidar/index.js");
  return lidar.rangeImage(scan, view && { ...view, camera: cameraOf(view.camera, "view.camera") as View["camera"] });
}
