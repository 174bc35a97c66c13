/**
 * calib.txt of the Middlebury stereo data: both cameras of a rectified pair, which differ in their principal points alone.
 *
 * Its baseline is in millimetres. The right camera is the left one moved along its rows.
 */
import { badFile } from "../../errors.js";
import type { ReaderWarning } from "../warnings.js";
import { cameraOf } from "./cameras.js";
import { type Numbers, numberOf } from "./numbers.js";
import { motion } from "./poses.js";
import type { Calibration } from "./tree.js";

const CAMERA = /^cam(\d)\s*=\s*\[([^\]\n]{5,400})\]/gm;
export const isMiddlebury = (text: string): boolean =>
  /^cam0\s*=\s*\[[^\]\n]*;[^\]\n]*\]/m.test(text) && /^baseline\s*=/m.test(text);

const EYE = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export function readMiddlebury(text: string): Calibration {
  const number = (name: string) => numberOf(new RegExp(`^${name}\\s*=\\s*(\\S+)`, "m").exec(text)?.[1] ?? "");
  const warnings: ReaderWarning[] = [];
  const size = { width: number("width"), height: number("height") };
  const cameras = [...text.matchAll(CAMERA)].map(([, index = "", matrix = ""]) => {
    const k: Numbers = matrix.split(/[\s;,]+/).flatMap((word) => numberOf(word) ?? []);
    if (k.length !== 9) throw badFile(`its cam${index} has ${k.length} numbers; 3x3 of intrinsics are needed`);
    const [fx = NaN, skew = 0, cx = NaN, , fy = NaN, cy = NaN] = k;
    return cameraOf({ name: `cam${index}`, focal: [fx, fy], centre: [cx, cy], skew, ...size }, warnings);
  });
  const baseline = number("baseline");
  if (baseline === undefined || cameras.length < 2) return { cameras, poses: [], warnings };
  const names = { name: "cam1 from cam0", from: "cam0", to: "cam1" };
  return { cameras, poses: [motion(EYE, [-baseline / 1000, 0, 0], names, warnings)], warnings };
}
