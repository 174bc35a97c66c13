/**
 * calib.txt of the Middlebury stereo data: both cameras of a rectified pair, which differ in their principal points alone.
 *
 * Its baseline is in millimetres. The right camera is the left one moved along its rows.
 */
import { Findings } from "./findings.js";
import { numberOf } from "./numbers.js";

const CAMERA = /^cam(\d)\s*=\s*\[([^\]\n]{5,400})\]/gm;
export const isMiddlebury = (text: string): boolean =>
  /^cam0\s*=\s*\[[^\]\n]*;[^\]\n]*\]/m.test(text) && /^baseline\s*=/m.test(text);

const EYE = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export function readMiddlebury(text: string): Findings {
  const found = new Findings();
  const number = (name: string) => numberOf(new RegExp(`^${name}\\s*=\\s*(\\S+)`, "m").exec(text)?.[1] ?? "");
  const size = { width: number("width"), height: number("height") };
  for (const [, index = "", matrix = ""] of text.matchAll(CAMERA)) {
    const [fx = NaN, skew = 0, cx = NaN, , fy = NaN, cy = NaN] = matrix
      .split(/[\s;,]+/)
      .map((word) => numberOf(word) ?? NaN);
    found.camera({ name: `cam${index}`, focal: [fx, fy], centre: [cx, cy], skew, ...size });
  }
  const baseline = number("baseline");
  if (baseline !== undefined && found.cameras.length > 1)
    found.pose(EYE, [-baseline / 1000, 0, 0], { name: "cam1 from cam0", from: "cam0", to: "cam1" });
  return found.done("Middlebury's calibration of a stereo pair");
}
