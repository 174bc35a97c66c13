/** Describes cameras and poses in plain words. */
import { degreesOf } from "./formats/poses.js";
import type { NamedCamera, NamedPose } from "./types.js";
import { digits } from "./warnings.js";

/** Largest number of cameras or poses that are described individually. */
const FEW = 4;

function lens({ camera: { model, distortion } }: NamedCamera): string {
  if (model === "fisheye") return "fisheye";
  return distortion === undefined ? "no distortion" : `Brown's distortion with ${distortion.length} numbers`;
}

function ofCamera(each: NamedCamera): string {
  const { fx, fy, cx, cy } = each.camera;
  const size = each.width === undefined ? "" : `${each.width}x${each.height}, `;
  return `${each.name === undefined ? "" : `${each.name}: `}${size}fx ${digits(fx)} fy ${digits(fy)} cx ${digits(cx)} cy ${digits(cy)}, ${lens(each)}`;
}

function ofPose({ name, from, to, pose }: NamedPose): string {
  const called =
    from !== undefined && to !== undefined ? `from ${from} to ${to}: ` : name === undefined ? "" : `${name}: `;
  return `${called}${degreesOf(pose.rotation).toFixed(2)} degrees, ${(1000 * Math.hypot(...pose.translation)).toFixed(1)} mm`;
}

function listed<T>(all: T[], one: string, many: string, say: (each: T) => string): string[] {
  if (all.length === 0) return [];
  const head = all.length === 1 ? one : `${all.length} ${many}`;
  return [`${head} (${all.slice(0, FEW).map(say).join("; ")}${all.length > FEW ? "; .." : ""})`];
}

export const inWords = (cameras: NamedCamera[], poses: NamedPose[]): string =>
  [...listed(cameras, "a camera", "cameras", ofCamera), ...listed(poses, "a pose", "poses", ofPose)].join(", ");
