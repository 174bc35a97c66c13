/**
 * The unit of depth maps and the size of raw ones, if a text beside them states it, found by the names that programs use for these numbers.
 *
 * Limits: a number is recognised only by its name, whatever the format of the text.
 */
import { base, folderOf, stem } from "./names.js";
import { textOf } from "./formats/decode.js";
import type { Size } from "./formats/raw.js";
import type { NamedFile } from "./types.js";
import { type ReaderWarning, warning } from "./warnings.js";

/** Largest number of characters that are searched for a unit. */
const MOST = 2 ** 20;

/** ORB-SLAM, NICE-SLAM, ScanNet, GraspNet and others: stored units per metre. */
const TO_THE_METRE =
  "(?:rgbd[._])?depth_?map_?factor|png_depth_scale|(?:m_)?depth_?shift|factor_depth|depth_?factor|depth_units_per_met(?:re|er)";
/** nerfstudio, instant-ngp, librealsense, Kimera: metres per stored unit. */
const METRES =
  "depth_unit_scale_factor|integer_depth_scale|depth_?units?(?:_m|_in_met(?:re|er)s)?|depth_to_met(?:re|er)s?(?:_factor)?|met(?:re|er)s_per_unit";
/** RealSense, also as "Depth Scale is: 0.001": metres per unit; Open3D and others: units per metre; BOP: millimetres per unit. */
const EITHER = "depth[_ ]?scale(?:_factor| is)?";

/** Replica's cameras in NICE-SLAM: stored units per metre, as the "scale" of the camera; smaller numbers scale pictures. */
const [OF_CAMERA, LEAST_SCALE] = [/(?<![a-z_.])scale["']?\s*[:=]\s*(\d+(?:\.\d*)?)(?![\w.])/gi, 1000];

const named = (names: string): RegExp =>
  new RegExp(
    `(?<![a-z])(?:${names})["']?(?:\\s*[:=,>]\\s*|\\s+)["'\\[]*([-+]?(?:\\d+(?:\\.\\d*)?|\\.\\d+)(?:e[-+]?\\d+)?)(?![\\w.])\\s*(mm|m|cm)?`,
    "gi",
  );
/** "depth_unit: mm" */
const WORD =
  /(?<![a-z])depth_?units?["'\s]*[:=,]\s*["']?(millimet(?:re|er)s?|mm|met(?:re|er)s?|m|centimet(?:re|er)s?|cm)\b/gi;

/**
 * Smallest and largest plausible unit, from a hundredth of a millimetre to a tenth of a metre; other numbers of that name mean something
 * else.
 */
const isUnit = (metres: number): boolean => metres >= 9e-6 && metres <= 0.1;

/**
 * Metres per unit from a number that programs call the scale of depths: units per metre if it is large, metres per unit if it is small,
 * else BOP's millimetres per unit.
 */
function ofScale(value: number): number {
  if (value >= 100) return 1 / value;
  return value >= 0.01 ? value / 1000 : value;
}

const METRES_OF: Record<string, number> = { m: 1, cm: 0.01, mm: 0.001 };
function unitsIn(text: string): number[] {
  const found: number[] = [];
  const add = (pattern: RegExp, of: (value: number, word?: string) => number) => {
    for (const [, value = "", word] of text.matchAll(pattern)) found.push(of(Number(value), word));
  };
  add(named(TO_THE_METRE), (value) => 1 / value);
  // librealsense's settings give micrometres.
  add(named(METRES), (value, word = "") => value * (METRES_OF[word] ?? (value >= 1 ? 1e-6 : 1)));
  add(named(EITHER), ofScale);
  if (/["']?\bfx["']?\s*[:=]/.test(text)) add(OF_CAMERA, (value) => (value >= LEAST_SCALE ? 1 / value : NaN));
  for (const [, word = ""] of text.matchAll(WORD)) {
    const short = /^(?:mm|milli)/i.test(word) ? "mm" : /^c/i.test(word) ? "cm" : "m";
    found.push(METRES_OF[short] ?? NaN);
  }
  return found.filter(isUnit);
}

/** The unit of a folder's depth maps that its texts state; undefined if they state none or contradict each other. */
export function unitBeside(
  texts: NamedFile[],
  warnings: ReaderWarning[],
): { unit: number; files: Set<string> } | undefined {
  const found = texts.flatMap(({ name, bytes }) => {
    const text = bytes.length <= MOST ? textOf(bytes) : undefined;
    return text === undefined ? [] : unitsIn(text).map((unit) => ({ unit, file: name }));
  });
  const [first, ...others] = found;
  if (first === undefined) return undefined;
  const different = others.find(({ unit }) => Math.abs(unit / first.unit - 1) > 1e-6);
  if (different === undefined) return { unit: first.unit, files: new Set(found.map(({ file }) => file)) };
  const millimetres = (unit: number) => `${Number((1000 * unit).toPrecision(4))} mm`;
  warnings.push(
    warning(
      "units-differ",
      `The files give different units of depth: ${first.file} ${millimetres(first.unit)}, ${different.file} ${millimetres(different.unit)}. None of them was used: give the unit.`,
    ),
  );
  return undefined;
}

const WIDE = /(?:resolution[ _]?x|width|cols)["'\s]*[:=,>]\s*(\d{2,5})/i;
const HIGH = /(?:resolution[ _]?y|height|rows)["'\s]*[:=,>]\s*(\d{2,5})/i;

/** The size of raw pixels from a text that is named after them, such as the metadata of realsense-viewer. */
export function sizeBeside(raw: NamedFile, texts: NamedFile[]): Size | undefined {
  for (const { name, bytes } of texts) {
    if (folderOf(name) !== folderOf(raw.name) || !base(name).startsWith(stem(raw.name))) continue;
    const text = bytes.length <= MOST ? (textOf(bytes) ?? "") : "";
    const [width, height] = [Number(WIDE.exec(text)?.[1]), Number(HIGH.exec(text)?.[1])];
    if (width > 0 && height > 0) return [width, height];
  }
  return undefined;
}
