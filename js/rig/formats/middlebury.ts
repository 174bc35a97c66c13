/**
 * calib.txt of the Middlebury stereo data: the cameras of a rectified pair, which differ only in their principal points. The right camera is
 * the left one moved along the rows by the baseline, which is in millimetres.
 */
import { ofMatrix } from "./cameras.js";
import { Findings } from "./findings.js";
import { numberOf } from "./numbers.js";
import { identity } from "./poses.js";

const CAMERA = /^cam(\d)\s*=\s*\[([^\]\n]{5,400})\]/gm;
export const isMiddlebury = (text: string): boolean =>
  /^cam0\s*=\s*\[[^\]\n]*;[^\]\n]*\]/m.test(text) && /^baseline\s*=/m.test(text);

export function readMiddlebury(text: string): Findings {
  const found = new Findings();
  const number = (name: string) => numberOf(new RegExp(`^${name}\\s*=\\s*(\\S+)`, "m").exec(text)?.[1] ?? "");
  const size = { width: number("width"), height: number("height") };
  for (const [, index = "", matrix = ""] of text.matchAll(CAMERA)) {
    const k = matrix.split(/[\s;,]+/).map((word) => numberOf(word) ?? NaN);
    found.camera({ name: `cam${index}`, ...ofMatrix(k), ...size });
  }
  const baseline = number("baseline");
  if (baseline !== undefined && found.cameras.length > 1)
    found.pose(identity().rotation, [-baseline / 1000, 0, 0], { name: "cam1 from cam0", from: "cam0", to: "cam1" });
  return found;
}
