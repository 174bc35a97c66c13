/** Cameras that are typed in. */

import type { Pinhole } from "../../pkg/index.js";
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

export function typedFrom({ fx, fy, cx, cy, model, distortion }: Pinhole): TypedCamera {
  return { ...emptyCamera(), fx, fy, cx, cy, model: model ?? "brown", distortion: Array.from(distortion ?? []) };
}
