/** Warnings about the input of a check: each of them caps the verdict. */

import type { Doubt, RigState, Side } from "./state";

/** A principal point farther from the middle than this share of the picture's side probably belongs to another picture size. */
const OFF_CENTRE = 0.2;

/** A warning if a camera's parameters may be for another image size, the second most common mistake; empty if not. */
export function cameraDoubt(rig: RigState, side: Side): string {
  if (side === "depth" && !rig.needsDepthCamera) return "";
  const file = rig.given.find(({ source }) => source === rig.cameras[side].source)?.camera;
  const size = rig.sizeOf(side);
  if (!size) return "";
  if (file?.width && file.height && (file.width !== size.width || file.height !== size.height))
    return `these are for ${file.width}×${file.height} px, but the files have ${size.width}×${size.height} px.`;
  const camera = rig.cameraOf(side);
  const isOff = (centre: number, length: number) => Math.abs(centre / length - 0.5) > OFF_CENTRE;
  return camera && (isOff(camera.cx, size.width) || isOff(camera.cy, size.height))
    ? `the principal point is far from the centre of the ${size.width}×${size.height} px image; are these for another size?`
    : "";
}

/**
 * The warnings about the cameras' parameters, and those warnings of the readers that are evidence against the values. A warning that
 * several files have appears once. A guessed unit is left out, because the visitor can confirm it.
 */
export function doubtsOf(rig: RigState): Doubt[] {
  const used = new Set(rig.complete.flatMap(({ colour, depth }) => [colour, depth]));
  const alike = new Map<string, { first: string; count: number }>();
  for (const { id, name, summary } of rig.items) {
    if (!used.has(id)) continue;
    for (const { code, message, isDoubt } of summary?.warnings ?? []) {
      if (code === "unit-guessed" || !isDoubt) continue;
      const known = alike.get(code);
      if (known) known.count++;
      else alike.set(code, { first: `${name}: ${message}`, count: 1 });
    }
  }
  const ofFiles = [...alike].map(([code, { first, count }]) => ({
    code,
    message: count > 1 ? `${first} (And ${count - 1} more like it.)` : first,
  }));
  const sizes = rig.complete.flatMap((frame) =>
    (["colour", "depth"] as const).flatMap((side) => {
      const [own, usual] = [rig.item(frame[side])?.summary, rig.sizeOf(side)];
      const isUsual = !own || !usual || (own.width === usual.width && own.height === usual.height);
      const isOwn = own?.hasOwnCamera === true && !rig.cameras[side].chosen;
      return isUsual || isOwn || !rig.cameraOf(side) || own.organised
        ? []
        : [
            ofSize(
              `${frame.name}: its ${side === "colour" ? "colour image" : "depth map"} is ${own.width}×${own.height} px, not ${usual.width}×${usual.height} px as in the first frame, and the camera's parameters are valid for one size only.`,
            ),
          ];
    }),
  );
  const sides = rig.cameras.depth.source === "same" ? (["colour"] as const) : (["colour", "depth"] as const);
  const ofSensors = sides.flatMap((side) => {
    const { source, sensor } = rig.cameras[side];
    if (source !== "sensor" || !sensor || (side === "depth" && !rig.needsDepthCamera)) return [];
    const message = `The ${side} camera's parameters are published figures of a sensor (${sensor.name}), which is a guess: single devices differ by some percent.`;
    return [{ code: "intrinsics-guessed", message }];
  });
  const ofCameras = sides.flatMap((side) => {
    const words = cameraDoubt(rig, side);
    return words ? [ofSize(`The ${side} camera's parameters: ${words}`)] : [];
  });
  return [
    ...ofFiles,
    ...rig.notes.filter((note) => note.code !== "unit-guessed" && note.isDoubt),
    ...sizes,
    ...ofCameras,
    ...ofSensors,
  ];
}

const ofSize = (message: string): Doubt => ({ code: "camera-size", message });
