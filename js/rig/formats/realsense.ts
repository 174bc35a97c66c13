/**
 * Prints of RealSense's programs: `rs-enumerate-devices -c` with the intrinsics of all streams and sizes and the extrinsics between them,
 * and pyrealsense2's intrinsics and extrinsics.
 *
 * A stream has intrinsics for each of its sizes; the size of the images selects one. Blocks without values (N/A, or zeros) are left out.
 */
import { badFile } from "../../errors.js";
import { Findings } from "./findings.js";
import { type Numbers, numberOf, transposed } from "./numbers.js";

const INTRINSIC = /^\s*Intrinsic of "([^"]{1,60})"(?:\s*\/?\s*(\d{2,5})\s*x\s*(\d{2,5}))?/;
const EXTRINSIC = /^\s*Extrinsic from "([^"]{1,60})"\s+To\s+"([^"]{1,60})"/i;
/** Largest number of blocks of a print; a camera has some sixty streams and sizes. */
const MOST = 2000;
/** Largest number of lines of a block. */
const LONGEST = 16;

export const isEnumeration = (text: string): boolean => /^[ \t]*(?:Intrinsic of|Extrinsic from) "/m.test(text);

const numbersOf = (text: string): Numbers =>
  text
    .split(/\s+/)
    .map(numberOf)
    .filter((value) => value !== undefined);

/** Whether images of this stream are colour images or depth maps. */
const takesOf = (name: string): "colour" | "depth" | undefined =>
  /^colou?r|^rgb/i.test(name) ? "colour" : /^depth/i.test(name) ? "depth" : undefined;

class Enumeration {
  readonly found = new Findings();
  readonly #missing = new Set<string>();

  camera([, name = "", columns, rows]: RegExpExecArray, lines: string[]): void {
    const entries = new Map(
      lines.map((line) => [line.split(":")[0]?.trim().toLowerCase() ?? "", line.slice(line.indexOf(":") + 1).trim()]),
    );
    const number = (key: string): number | undefined => numberOf(entries.get(key) ?? "");
    const focal = [number("fx"), number("fy")];
    if (/n\/a|nan|inf/i.test(entries.get("coeffs") ?? ""))
      this.found.warn(
        "lens-approximated",
        `The lens of "${name}" has no coefficients (N/A) and was read without distortion.`,
      );
    // Other streams, such as those of motion sensors, have no intrinsics.
    if (focal.some((value) => value === undefined || value === 0)) this.#missing.add(`intrinsics of "${name}"`);
    else
      this.found.camera(
        {
          ...{ name, focal: focal as Numbers, centre: [number("ppx") ?? NaN, number("ppy") ?? NaN] },
          ...{ model: entries.get("distortion"), distortion: numbersOf(entries.get("coeffs") ?? "") },
          ...{ width: number("width") || numberOf(columns), height: number("height") || numberOf(rows) },
        },
        takesOf(name),
      );
  }

  /** The rotation is printed row by row, although librealsense stores it by columns. */
  extrinsics([, from = "", to = ""]: RegExpExecArray, lines: string[]): void {
    if (from === to) return;
    const block = lines.slice(0, 1 + lines.findIndex((line) => /translation/i.test(line)) || lines.length);
    const values = block.flatMap((line) => numbersOf(line.replace(/^.*:/, "")));
    const isEmpty = values.slice(0, 9).every((value) => value === 0);
    if (isEmpty || block.some((line) => /n\/a|not available|nan|inf\b/i.test(line))) {
      this.#missing.add(`extrinsics from "${from}" to "${to}"`);
      return;
    }
    if (values.length !== 12)
      throw badFile(
        `its extrinsics from "${from}" to "${to}" have ${values.length} numbers; nine of a rotation and three of a translation are needed`,
      );
    this.found.pose(values.slice(0, 9), values.slice(9), { name: `${to} from ${from}`, from, to });
  }

  done(devices: number): Findings {
    if (devices > 1)
      this.found.warn(
        "pose-assumed",
        `The file lists ${devices} devices, and only the first one was read. Print one device with rs-enumerate-devices -c -s SERIAL.`,
      );
    if (this.#missing.size > 0) {
      const [first] = this.#missing;
      const more = this.#missing.size > 1 ? ` and ${this.#missing.size - 1} more` : "";
      this.found.warn(
        "pose-left-out",
        `The ${first}${more} are not available on this device (N/A or zeros) and were left out.`,
      );
    }
    return this.found;
  }
}

export function readEnumeration(text: string): Findings {
  const read = new Enumeration();
  const all = text.split(/\r?\n/);
  const [lines, devices] = firstDevice(all);
  const starts = lines.flatMap((line, at) => (INTRINSIC.test(line) || EXTRINSIC.test(line) ? [at] : []));
  if (starts.length > MOST) throw badFile(`it holds more than ${MOST} intrinsics and extrinsics`);
  if (starts.length === 0) throw badFile("it has intrinsics or extrinsics of RealSense, but no stream");
  starts.forEach((start, index) => {
    const block = lines.slice(start + 1, Math.min(starts[index + 1] ?? lines.length, start + LONGEST));
    const head = lines[start] ?? "";
    const streams = EXTRINSIC.exec(head);
    const stream = INTRINSIC.exec(head);
    if (streams) read.extrinsics(streams, block);
    else if (stream) read.camera(stream, block);
  });
  return read.done(devices);
}

/** The lines up to the second device with intrinsics, and the number of such devices. */
function firstDevice(lines: string[]): [lines: string[], devices: number] {
  const heads = lines.flatMap((line, at) => (/^\s*Device info/i.test(line) ? [at] : []));
  const having = heads.filter((at, index) =>
    lines.slice(at, heads[index + 1] ?? lines.length).some((line) => INTRINSIC.test(line)),
  );
  const second = having[1];
  return second === undefined ? [lines, having.length] : [lines.slice(0, second), having.length];
}

const N = String.raw`([-+]?[\d.]+(?:e[-+]?\d+)?)`;
/** `[ 640x480  p[321.7 244.1]  f[611.3 611.8]  Inverse Brown Conrady [0.1 .. 0] ]`, of version 2.40 and later. */
const SHORT = new RegExp(
  String.raw`\[\s*(\d+)x(\d+)\s+p\[${N}\s+${N}\]\s+f\[${N}\s+${N}\]\s+([A-Za-z][A-Za-z0-9 ]{0,40}?)\s*\[([^\]]{0,200})\]\s*\]`,
  "gi",
);
/** `width: 640, height: 480, ppx: ..`, of earlier versions. */
const LONG = new RegExp(
  String.raw`width:\s*(\d+),\s*height:\s*(\d+),\s*ppx:\s*${N},\s*ppy:\s*${N},\s*fx:\s*${N},\s*fy:\s*${N},\s*model:\s*([A-Za-z][A-Za-z0-9_. ]{0,40}?),\s*coeffs:\s*\[([^\]]{0,200})\]`,
  "gi",
);
const MOTION = /rotation:\s*\[([^\]]{1,400})\]\s*,?\s*translation:\s*\[([^\]]{1,200})\]/gi;

export const isPrinted = (text: string): boolean =>
  !text.startsWith("{") && [SHORT, LONG].some((pattern) => new RegExp(pattern.source, "i").test(text));

/** The words before a print on its line or the line above, as in "Depth intrinsics: [ 640x480 ..". */
function labelAt(text: string, at: number): string | undefined {
  const [line = "", before = ""] = text
    .slice(Math.max(0, at - 200), at)
    .split(/\r?\n/)
    .reverse();
  const words = /\w/.test(line) ? line : before;
  const label = words.replace(/[^A-Za-z0-9 _]/g, " ").replace(/\b(?:intrinsics?|extrinsics?|stream|profile)\b/gi, " ");
  const name = label.replace(/\s+/g, " ").trim().slice(-40);
  return /[a-z]/i.test(name) && !/\d{3}/.test(name) ? name : undefined;
}

/** pyrealsense2's prints of intrinsics and extrinsics, with rotations column by column. */
export function readPrinted(text: string): Findings {
  const found = new Findings();
  for (const each of [...text.matchAll(SHORT), ...text.matchAll(LONG)]) {
    const [, width, height, cx = "", cy = "", fx = "", fy = "", model = "", coeffs = ""] = each;
    found.camera({
      ...{ name: labelAt(text, each.index), focal: [Number(fx), Number(fy)], centre: [Number(cx), Number(cy)] },
      ...{
        model: model.replace(/^distortion\.|_/g, (part) => (part === "_" ? " " : "")),
        width: numberOf(width),
        height: numberOf(height),
      },
      distortion: numbersOf(coeffs.replace(/,/g, " ")),
    });
  }
  for (const each of text.matchAll(MOTION)) {
    const [r, t] = [each[1] ?? "", each[2] ?? ""].map((part) => numbersOf(part.replace(/,/g, " ")));
    if (r?.length === 9 && t) found.pose(transposed(r, 3), t, directed(labelAt(text, each.index)));
  }
  return found;
}

/** The names of a pose from a label such as "Depth to Color". */
function directed(label: string | undefined) {
  const [, from, to] = /(\w+)[ _]to[ _](\w+)/i.exec(label ?? "") ?? [];
  return from !== undefined && to !== undefined ? { name: label ?? "", from, to } : { name: label ?? "pose" };
}

export const isSnapshot = (text: string): boolean => /^fx\s*,/im.test(text) && /^ppx\s*,/im.test(text);

/** The .csv that RealSense's viewer saves with a snapshot: one camera, with the name of its lens model but no coefficients. */
export function readSnapshot(text: string): Findings {
  const found = new Findings();
  const entries = new Map(
    text.split(/\r?\n/).map((line) => {
      const [key = "", ...rest] = line.split(",");
      return [key.trim().toLowerCase(), rest.join(",").trim()];
    }),
  );
  const number = (key: string): number | undefined => numberOf(entries.get(key) ?? "");
  const name = entries.get("stream") ?? entries.get("type") ?? "camera";
  found.camera(
    {
      ...{
        name,
        focal: [number("fx") ?? NaN, number("fy") ?? NaN],
        centre: [number("ppx") ?? NaN, number("ppy") ?? NaN],
      },
      ...{ width: number("resolution x"), height: number("resolution y") },
    },
    takesOf(name),
  );
  const lens = entries.get("distorsion") ?? entries.get("distortion") ?? "none";
  if (takesOf(name) === "colour" && !/^none$/i.test(lens))
    found.warn(
      "lens-approximated",
      `The file of RealSense's viewer has no coefficients for the lens of "${name}" (${lens.slice(0, 40)}), which was read without distortion.`,
    );
  return found;
}
