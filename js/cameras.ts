/** Checks a camera, for the loop and the calibration check alike. */
import { type Check, isObject, number, numbers, object, word, wrong } from "./check.js";
import { BimodalError } from "./errors.js";
import { cameraOf } from "./matrices.js";

/** OpenCV's longest list. The numerics refuse the coefficients that they do not support. */
const MOST_COEFFICIENTS = 14;

/** The number of coefficients of the lens model. */
const coefficients: Check = (value, field) => {
  const length = isObject(value) && "length" in value ? value.length : undefined;
  if (typeof length !== "number") throw wrong(field, "a list of numbers", value);
  if (!(length <= MOST_COEFFICIENTS))
    throw new BimodalError("size", `${field}: needs 4, 5 or 8 numbers, not ${length}`, field);
  numbers(length)(value, field);
};
const members = object(
  { fx: number, fy: number, cx: number, cy: number, model: word("brown", "fisheye"), distortion: coefficients },
  ["fx", "fy", "cx", "cy"],
);

/** A camera in any of the forms of `PinholeInput`. */
export const camera: Check = (value, field) => members(cameraOf(value, field), field);
