/** Files out. A stand-in for "bimodal-stereo/rig-write" with its interface until the package has it: the matrix alone. */

import { BimodalError, type CheckReport, type Pose, type RigCamera } from "../../pkg/index.js";
import { matrixText } from "./poses";
import type { PoseFormat } from "./protocol";

type Size = readonly [width: number, height: number];

interface RigContext {
  colour?: RigCamera;
  depth?: RigCamera;
  sizes?: { colour?: Size; depth?: Size };
}

export interface Cloud {
  points: Float32Array;
  colours?: Uint8Array;
  name?: string;
}

const notYet = (what: string) => new BimodalError("unsupported", `${what} can't be written yet`);

export function writePose(pose: Pose, format: PoseFormat, _context: RigContext): { name: string; text: string; notes: string[] } {
  if (format !== "matrix") throw notYet(`the format ${format}`);
  return { name: "depth_to_colour.txt", text: `${matrixText(pose)}\n`, notes: [] };
}

export function writeClouds(_clouds: readonly Cloud[]): Uint8Array {
  throw notYet("point clouds");
}

export function reportHtml(_report: CheckReport, _pictures: { title: string; dataUrl: string }[], _options: { made?: Date; inputs?: { name: string; says?: string }[] }): string {
  throw notYet("the report");
}
