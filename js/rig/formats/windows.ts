/** Reads the output of Orbbec's SDK in Python, and matrices and camera parameters as MATLAB's command window shows them. */
import { badFile } from "../../errors.js";
import { BROWN_NAMES, ofMatrix } from "./cameras.js";
import { Findings } from "./findings.js";
import { isMatlab, readMatlab } from "./matlab.js";
import { type Node, type Numbers, numberOf, transposed } from "./numbers.js";

/** Longest translation in metres; a longer one is in the SDK's millimetres (orbbec.ts). */
const LONGEST = 1;
const MOST_LINES = 2000;
const numbersIn = (text: string): Numbers => text.split(/[\s,;[\]()]+/, 64).flatMap((part) => numberOf(part) ?? []);

const PART = /\b(depth|rgb|color)_?(intrinsic|distortion)s?\s*[:=]?\s*<([^<>]{1,600})>/gi;

export const isOrbbecPrint = (text: string): boolean =>
  /<\s*OBCamera|\bOBCameraParam\b/.test(text.slice(0, 4000)) && new RegExp(PART.source, "i").test(text.slice(0, 4000));

/** print() of OBCameraParam: both cameras, and the motion from the depth camera to the colour camera. */
export function readOrbbecPrint(text: string): Findings {
  const found = new Findings();
  const parts = new Map<string, Map<string, number>>();
  for (const [, who = "", what = "", body = ""] of text.matchAll(PART)) {
    // The SDK prints no space before "fy": "fx=504.6fy = 504.7".
    const pairs = [...body.matchAll(/([a-z]\w{0,7})\s*=\s*(-?\d+(?:\.\d*)?(?:e[-+]?\d+)?)/gi)];
    const camera = who.toLowerCase() === "depth" ? "depth" : "color";
    parts.set(
      `${camera} ${what.toLowerCase()}`,
      new Map(pairs.map(([, key = "", value]) => [key, numberOf(value) ?? NaN])),
    );
  }
  for (const name of ["depth", "color"] as const) {
    const [own, lens] = [parts.get(`${name} intrinsic`), parts.get(`${name} distortion`)];
    if (own === undefined) continue;
    const at = (key: string) => own.get(key) ?? NaN;
    const raw = { name, focal: [at("fx"), at("fy")], centre: [at("cx"), at("cy")] };
    const distortion = lens ? BROWN_NAMES.map((key) => lens.get(key) ?? 0) : [];
    found.camera(
      { ...raw, distortion, isByName: true, width: own.get("width"), height: own.get("height") },
      name === "depth" ? "depth" : "colour",
    );
  }
  const [, rotation = "", shift = ""] =
    /\brot\s*=\s*\[([^\]]{1,400})\]\s*,?\s*(?:trans\w*)\s*=\s*\[([^\]]{1,200})\]/.exec(text) ?? [];
  const [r, t] = [numbersIn(rotation), numbersIn(shift)];
  if (r.length === 9 && t.length === 3) {
    const unit = Math.hypot(...t) > LONGEST ? 1e-3 : 1;
    const metres = t.map((value) => value * unit);
    found.pose(r, metres, { name: "color from depth", from: "depth", to: "color" });
  }
  return found;
}

const TITLE = /^([A-Za-z]\w{0,60})\s*=\s*$/;
const WITH = /^\s*(\w{1,40})(?: object)? with properties:\s*$/;
const FACTOR = /^\s*(\d(?:\.\d+)?e[-+]?\d{1,3})\s*\*\s*$/;
const PROPERTY = /^\s*([A-Za-z]\w{0,40}):\s*(.{1,200})$/;

interface Shown {
  name: string;
  rows: Numbers[];
  properties: Node;
}

/** The variables of a command window. */
function shownIn(text: string): Shown[] {
  const all: Shown[] = [];
  let factor = 1;
  for (const line of text.split(/\r?\n/, MOST_LINES)) {
    const title = TITLE.exec(line.trim())?.[1];
    if (title !== undefined) {
      all.push({ name: title, rows: [], properties: {} });
      factor = 1;
      continue;
    }
    const now = all.at(-1);
    if (now === undefined || line.trim() === "" || WITH.test(line)) continue;
    const [, key, value = ""] = PROPERTY.exec(line) ?? [];
    const words = line.trim().split(/\s+/);
    if (FACTOR.test(line)) factor = Number(FACTOR.exec(line)?.[1]);
    else if (key !== undefined) {
      const numbers = numbersIn(value);
      if (!/double\]/.test(value) && numbers.length > 0)
        now.properties[key] = numbers.length > 1 ? numbers : numbers[0];
    } else if (words.every((word) => numberOf(word) !== undefined))
      now.rows.push(words.map((word) => Number(word) * factor));
  }
  return all;
}

/** Only MATLAB shows properties and common factors; other matrices are read by their names (notes.ts). */
export const isCommandWindow = (text: string): boolean => {
  const lines = text.slice(0, 4000).split(/\r?\n/);
  return lines.some((line) => TITLE.test(line.trim())) && lines.some((line) => WITH.test(line) || FACTOR.test(line));
};

/** Intrinsics by rows, or by columns as in MATLAB's older IntrinsicMatrix. */
function intrinsicsOf({ rows }: Shown): Numbers | undefined {
  const values = rows.flat();
  if (rows.length !== 3 || values.length !== 9) return undefined;
  const isRows = values[6] === 0 && values[7] === 0 && values[8] === 1;
  const isColumns = values[2] === 0 && values[5] === 0 && values[8] === 1;
  return isRows ? values : isColumns ? transposed(values, 3) : undefined;
}

/** The cameras of a command window. MATLAB counts their pixels from 1. */
export function readCommandWindow(text: string): Findings {
  const found = new Findings();
  const all = shownIn(text);
  const objects = all.filter(({ properties }) => isMatlab(properties));
  for (const { properties } of objects) found.cameras.push(...readMatlab(properties).cameras);
  const lens = (pattern: RegExp) => all.find(({ name }) => pattern.test(name))?.rows.flat() ?? [];
  for (const each of objects.length > 0 ? [] : all) {
    const k = intrinsicsOf(each);
    if (k === undefined) continue;
    const own = ofMatrix(k);
    const [[k1 = 0, k2 = 0, k3 = 0], [p1 = 0, p2 = 0]] = [lens(/radial/i), lens(/tangential/i)];
    found.camera({
      ...own,
      name: each.name,
      centre: own.centre.map((value) => value - 1),
      distortion: [k1, k2, p1, p2, k3],
    });
    found.warn(
      "principal-point",
      `MATLAB counts pixels from 1, so 1 was subtracted from both coordinates of the principal point of "${each.name}"; if the matrix came from another program, add 1 to them again.`,
    );
  }
  const others = all.filter((each) => each.rows.length > 2 && intrinsicsOf(each) === undefined);
  for (const { name } of others)
    found.warn(
      "pose-left-out",
      `The matrix "${name}" of MATLAB's command window was left out: write poses as rows of 4x4 into separate files.`,
    );
  if (found.cameras.length === 0)
    throw badFile(
      "it is a print of MATLAB's command window without intrinsics; save the variables with jsonencode, or write poses as rows of 4x4 with the names of their frames",
    );
  return found;
}
