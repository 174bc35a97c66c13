/** Cameras by hand. */
import { number } from "../check.js";
import { BimodalError, refused } from "../errors.js";
import type { Pinhole } from "./types.js";

/** A camera of square pixels that looks through the middle of its image, by its horizontal field of view. */
export function cameraFromFieldOfView(width: number, height: number, degrees: number): Pinhole {
  const isSize = (value: number) => Number.isInteger(value) && value > 0;
  for (const [field, side] of Object.entries({ width, height }))
    if (!isSize(side))
      throw new BimodalError("size", `${field}: a whole number of pixels above zero is needed`, field, refused(side));
  number(degrees, "degrees");
  if (!(degrees > 0 && degrees < 180))
    throw new BimodalError(
      "range",
      `degrees: a field of view must be between 0 and 180 (got ${degrees})`,
      "degrees",
      refused(degrees),
    );
  const focal = width / 2 / Math.tan((degrees * Math.PI) / 360);
  // Pixel centres are whole numbers, so the image reaches from -1/2 to width - 1/2.
  return { fx: focal, fy: focal, cx: (width - 1) / 2, cy: (height - 1) / 2 };
}
