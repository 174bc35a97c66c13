/**
 * The factory's calibration of a ZED, SN12345.conf: both cameras at every size, in sections of an INI file.
 *
 * Depth maps of the ZED belong to its rectified left image. Which rectification the SDK has chosen is not in the file.
 */
import { Findings } from "./findings.js";
import { numberOf } from "./numbers.js";

/** Columns and rows by the name of the mode. */
const SIZES: Record<string, [number, number]> = {
  "2K": [2208, 1242],
  FHD: [1920, 1080],
  FHD1200: [1920, 1200],
  HD: [1280, 720],
  VGA: [672, 376],
  SVGA: [960, 600],
  QHDPLUS: [3200, 1800],
  "4K": [3840, 2160],
  XVGA: [1024, 768],
};
const SECTION = /^[ \t]*\[(LEFT|RIGHT)_CAM_([A-Z0-9]{1,10})\][ \t]*$/im;

export const isZed = (text: string): boolean => SECTION.test(text);

/** The entries of each section, names in small letters. */
function sections(text: string): Map<string, Map<string, number>> {
  const all = new Map<string, Map<string, number>>();
  let current = new Map<string, number>();
  for (const line of text.split(/\r?\n/)) {
    const name = /^\s*\[([^\]]{1,60})\]/.exec(line)?.[1];
    if (name !== undefined) all.set(name.toUpperCase(), (current = new Map()));
    const [, key = "", value = ""] = /^\s*(\w{1,30})\s*=\s*([^;#]{1,60})/.exec(line) ?? [];
    const number = numberOf(value.trim());
    if (key !== "" && number !== undefined) current.set(key.toLowerCase(), number);
  }
  return all;
}

/** Of a section; newer files have one for the lens alone. */
function lensOf(own: Map<string, number>, shared: Map<string, number> | undefined) {
  const from = own.has("k1") ? own : (shared ?? own);
  const values = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"].map((key) => from.get(key) ?? 0);
  const isFisheye = from.has("k4") && !from.has("k5") && !from.has("p1");
  return isFisheye
    ? { model: "fisheye", distortion: ["k1", "k2", "k3", "k4"].map((key) => from.get(key) ?? 0) }
    : { distortion: values };
}

export function readZed(text: string): Findings {
  const found = new Findings();
  const all = sections(text);
  for (const side of ["LEFT", "RIGHT"]) {
    for (const [name, own] of all) {
      const [, which, mode = ""] = SECTION.exec(`[${name}]`) ?? [];
      if (which !== side || !own.has("fx")) continue;
      const n = (key: string) => own.get(key) ?? NaN;
      const size = SIZES[mode];
      found.camera(
        {
          ...{ name: `${side.toLowerCase()} ${mode}`, focal: [n("fx"), n("fy")], centre: [n("cx"), n("cy")] },
          ...{ ...lensOf(own, all.get(`${side}_DISTO`)), width: size?.[0], height: size?.[1] },
        },
        side === "LEFT" ? "both" : undefined,
      );
    }
  }
  if (all.has("STEREO"))
    found.warn(
      "pose-assumed",
      "A ZED's depth maps belong to its left camera, so that no pose lies between them; the intrinsics are those of images that are not rectified.",
    );
  return found.done("a ZED's calibration");
}
