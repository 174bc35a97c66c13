/** Files out. A stand-in for the writers of "bimodal-stereo/rig" until the package has them: the matrix alone. */

import { BimodalError, type CheckFrame, type CheckReport, type Pose, type RigCamera } from "../../pkg/index.js";
import { matrixText } from "./poses";
import type { PoseFormat } from "./protocol";

interface Context {
  colour?: RigCamera;
  depth?: RigCamera;
  sizes?: { colour: [number, number]; depth: [number, number] };
}

const notYet = (what: string) => new BimodalError("unsupported", `${what} can't be written yet`);

export function writePose(pose: Pose, format: PoseFormat, _context: Context): { name: string; text: string } {
  if (format !== "matrix") throw notYet(`the format ${format}`);
  return { name: "extrinsics.txt", text: `${matrixText(pose)}\n` };
}

export function writeClouds(_frame: CheckFrame, _pose: Pose): Uint8Array {
  throw notYet("point clouds");
}

export function reportHtml(_report: CheckReport, _frames: CheckFrame[], _pictures: { title: string; dataUrl: string }[]): string {
  throw notYet("the report");
}
