/** Cameras that are typed in or taken from a common sensor. */

import type { Pinhole } from "../../pkg/index.js";
import type { Sensor } from "./sensors";
import type { CameraChoice, TypedCamera } from "./state";

export const emptyCamera = (): TypedCamera => ({
  by: "focal",
  model: "brown",
  fx: NaN,
  fy: NaN,
  cx: NaN,
  cy: NaN,
  view: NaN,
  distortion: [],
});
export const choice = (): CameraChoice => ({ source: "", chosen: false, typed: emptyCamera() });

export function fromTyped(
  { by, model, fx, fy, cx, cy, view, distortion }: TypedCamera,
  size: { width: number; height: number } | undefined,
): Pinhole | undefined {
  const lens = distortion.length > 0 ? { model, distortion } : {};
  if (by === "focal") return [fx, fy, cx, cy].every(Number.isFinite) ? { fx, fy, cx, cy, ...lens } : undefined;
  if (!size || !(view > 0 && view < 180)) return undefined;
  const focal = size.width / 2 / Math.tan((view * Math.PI) / 360);
  return { fx: focal, fy: focal, cx: (size.width - 1) / 2, cy: (size.height - 1) / 2, ...lens };
}

type Size = { width: number; height: number };

/** Largest difference between the shapes of two pictures of one camera, as a share: sizes are rounded to whole pixels. */
const SAME_SHAPE = 0.02;

export const hasShape = (sensor: Size, size: Size | undefined): boolean =>
  !size || Math.abs((sensor.width * size.height) / (sensor.height * size.width) - 1) < SAME_SHAPE;

/** The published figures of a sensor, scaled to the picture; undefined for a picture of another shape. */
export function fromSensor(sensor: Sensor | undefined, size: Size | undefined): Pinhole | undefined {
  if (!sensor || !size || !hasShape(sensor, size)) return undefined;
  const scale = size.width / sensor.width;
  const focal = sensor.focal * scale;
  const [cx, cy] = sensor.centre ?? [(sensor.width - 1) / 2, (sensor.height - 1) / 2];
  // Pixels are counted from their middles, so that the corner of the picture is at -0.5.
  const scaled = (place: number) => (place + 0.5) * scale - 0.5;
  return { fx: focal, fy: focal, cx: scaled(cx), cy: scaled(cy) };
}

export function typedFrom({ fx, fy, cx, cy, model, distortion }: Pinhole): TypedCamera {
  return { ...emptyCamera(), fx, fy, cx, cy, model: model ?? "brown", distortion: Array.from(distortion ?? []) };
}
