/** What `rs-enumerate-devices -c` prints: intrinsics of all streams and sizes, and what relates the streams. */
import { badFile } from "../../errors.js";
import { cameraOf } from "./cameras.js";
import { type Numbers, numberOf } from "./numbers.js";
import { motion } from "./poses.js";
import type { Calibration } from "./tree.js";
import type { ReaderWarning } from "../warnings.js";

const INTRINSIC = /^\s*Intrinsic of "([^"]{1,60})"/;
const EXTRINSIC = /^\s*Extrinsic from "([^"]{1,60})"\s+To\s+"([^"]{1,60})"/i;
/** Streams times sizes of a camera: some sixty. */
const MOST = 2000;

export const isEnumeration = (text: string): boolean => /^[ \t]*(?:Intrinsic of|Extrinsic from) "/m.test(text);

const numbersOf = (text: string): Numbers =>
  text
    .split(/\s+/)
    .map(numberOf)
    .filter((value) => value !== undefined);

function camera(name: string, lines: string[], warnings: ReaderWarning[]): Calibration["cameras"][number] {
  const entries = new Map(
    lines.map((line) => [line.split(":")[0]?.trim().toLowerCase() ?? "", line.slice(line.indexOf(":") + 1).trim()]),
  );
  const number = (key: string): number => numberOf(entries.get(key) ?? "") ?? NaN;
  return cameraOf(
    {
      ...{ name, focal: [number("fx"), number("fy")], centre: [number("ppx"), number("ppy")] },
      ...{
        model: entries.get("distortion"),
        distortion: numbersOf(entries.get("coeffs") ?? ""),
        width: number("width"),
        height: number("height"),
      },
    },
    warnings,
  );
}

/** The rotation is printed row by row, though librealsense keeps it by columns. */
function extrinsics(
  [, from = "", to = ""]: RegExpExecArray,
  lines: string[],
  warnings: ReaderWarning[],
): Calibration["poses"][number] {
  const values = lines.flatMap((line) => numbersOf(line.replace(/^.*:/, "")));
  if (values.length !== 12)
    throw badFile(
      `its extrinsics from "${from}" to "${to}" have ${values.length} numbers; nine of a rotation and three of a translation are needed`,
    );
  return motion(values.slice(0, 9), values.slice(9), { name: `${to} from ${from}`, from, to }, warnings);
}

export function readEnumeration(text: string): Calibration {
  const found: Calibration = { cameras: [], poses: [], warnings: [] };
  const lines = text.split(/\r?\n/);
  const starts = lines.flatMap((line, at) => (INTRINSIC.test(line) || EXTRINSIC.test(line) ? [at] : []));
  if (starts.length > MOST) throw badFile(`it holds more than ${MOST} intrinsics and extrinsics`);
  if (starts.length === 0) throw badFile("it names intrinsics or extrinsics of RealSense, but of no stream");
  starts.forEach((start, index) => {
    const block = lines.slice(start + 1, Math.min(starts[index + 1] ?? lines.length, start + 16));
    const head = lines[start] ?? "";
    const streams = EXTRINSIC.exec(head);
    if (streams) found.poses.push(extrinsics(streams, block.slice(0, 7), found.warnings));
    else found.cameras.push(camera(INTRINSIC.exec(head)?.[1] ?? "", block, found.warnings));
  });
  return found;
}
