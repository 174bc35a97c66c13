/**
 * The factory calibration of a ZED, SN12345.conf: both cameras at every size, in sections of an .ini file.
 *
 * Depth maps of the ZED belong to its rectified left image. The SDK's rectification is not in the file.
 */
import { BROWN_NAMES, FISHEYE_NAMES } from "./cameras.js";
import { Findings } from "./findings.js";
import { isNode, numberOf } from "./numbers.js";
import { readIni } from "./settings.js";

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

type Section = Map<string, number>;

/** The numbers of each section; sections by their names in capitals, numbers in small letters. */
function sections(text: string): Map<string, Section> {
  const all = new Map<string, Section>();
  for (const [name, section] of Object.entries(readIni(text))) {
    if (!isNode(section)) continue;
    const numbers: Section = new Map();
    for (const [key, value] of Object.entries(section)) {
      const number = numberOf(value);
      if (number !== undefined) numbers.set(key.toLowerCase(), number);
    }
    all.set(name.toUpperCase(), numbers);
  }
  return all;
}

/** The lens of a camera; newer files have it in a section that all sizes share. */
function lensOf(own: Section, shared: Section | undefined) {
  const from = own.has("k1") ? own : (shared ?? own);
  const isFisheye = from.has("k4") && !from.has("k5") && !from.has("p1");
  return isFisheye
    ? { model: "fisheye", distortion: FISHEYE_NAMES.map((key) => from.get(key) ?? 0) }
    : { distortion: BROWN_NAMES.map((key) => from.get(key) ?? 0) };
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
      "A ZED's depth maps belong to its left camera, so there is no pose between depth maps and colour images. The intrinsics are those of images that are not rectified.",
    );
  return found;
}
