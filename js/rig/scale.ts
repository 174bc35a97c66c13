/** Cameras of pictures that were scaled down or up. */
import type { Pinhole } from "./types.js";

type Size = [width: number, height: number];

/** Largest difference of the two scales: sides of pictures are whole pixels. */
const ASPECT = 0.01;

/** Whether a picture of one size can be a scaled version of a picture of the other size. */
export const haveLikeAspects = ([w, h]: Size, [width, height]: Size): boolean =>
  Math.abs((w * height) / (h * width) - 1) <= ASPECT;

/** The camera of the same view at another size. Pixel centres are whole numbers, so that the image begins at -1/2. */
export function scaledCamera(camera: Pinhole, [w, h]: Size, [width, height]: Size): Pinhole {
  const [x, y] = [width / w, height / h];
  return {
    ...camera,
    ...{ fx: camera.fx * x, fy: camera.fy * y, cx: (camera.cx + 0.5) * x - 0.5, cy: (camera.cy + 0.5) * y - 0.5 },
  };
}
