/**
 * Files of a rig, read by their content. A stand-in for "bimodal-stereo/rig" with the same interface, which takes its place as
 * soon as the package has it: here only images, depth maps and bare numbers are known.
 */

import { BimodalError, type CheckFrame, type Mask, type Pose, type RigCamera } from "../../pkg/index.js";
import { decodeColour, decodeDepth } from "../../pkg/files.js";
import { poseOf } from "./poses";

export interface NamedFile {
  name: string;
  bytes: Uint8Array;
}
export interface NamedPose {
  name?: string;
  pose: Pose;
  from?: string;
  to?: string;
}
export interface Reading {
  name: string;
  says: string;
  warnings: string[];
}
export type RigReading = Reading &
  (
    | { kind: "colour"; image: CheckFrame["image"] }
    | { kind: "depth"; depth: CheckFrame["depth"]; guessed: "unit"[] }
    | { kind: "mask"; mask: Mask }
    | { kind: "cameras"; cameras: { name?: string; camera: RigCamera; width?: number; height?: number }[]; poses: NamedPose[] }
    | { kind: "poses"; poses: NamedPose[] }
  );
export interface ReadOptions {
  as?: RigReading["kind"];
  unit?: number;
}

export async function readRigFile(file: NamedFile, options: ReadOptions = {}): Promise<RigReading> {
  try {
    return read(file, options);
  } catch (error) {
    const reason = error instanceof Error ? error.message.replace(/^file: /, "") : String(error);
    throw new BimodalError("file", reason.startsWith(file.name) ? reason : `${file.name}: ${reason}`, "file");
  }
}

function read({ name, bytes }: NamedFile, { as, unit }: ReadOptions): RigReading {
  const fail = (reason: string) => new BimodalError("file", `${name}: ${reason}`, "file");
  if (bytes.length === 0) throw fail("it is empty");
  const isPng = bytes[0] === 0x89 && bytes[1] === 0x50;
  if (isPng && as !== "colour" && (as === "depth" || bytes[24] === 16)) {
    const read = decodeDepth(bytes);
    const depth = { ...read, unit: unit ?? 0.001 };
    return { name, kind: "depth", depth, guessed: unit === undefined ? ["unit"] : [], says: `${read.width}x${read.height}, 16-bit, read as ${unit === undefined ? "millimetres" : `${unit} m`}`, warnings: [] };
  }
  if (isPng) {
    const image = decodeColour(bytes);
    return { name, kind: "colour", image, says: `${image.width}x${image.height}, 8-bit`, warnings: [] };
  }
  const text = new TextDecoder().decode(bytes);
  const numbers = text.trim().split(/[\s,;]+/).map(Number);
  if (numbers.every(Number.isFinite)) {
    if (numbers.length === 16 || numbers.length === 12) {
      const row = (i: number) => numbers.slice(4 * i, 4 * i + 4) as [number, number, number, number];
      const rows = [row(0), row(1), row(2)];
      return { name, kind: "poses", poses: [{ pose: poseOf(rows.flatMap((r) => r.slice(0, 3)), rows.map((r) => r[3])) }], says: "a 4x4 matrix", warnings: [] };
    }
    if (numbers.length === 9) {
      const [fx = 0, , cx = 0, , fy = 0, cy = 0] = numbers;
      return { name, kind: "cameras", cameras: [{ camera: { fx, fy, cx, cy } }], poses: [], says: "a 3x3 camera matrix", warnings: [] };
    }
  }
  throw fail("it is none of the formats that are known here");
}

export async function readRigFolder(files: NamedFile[], options: ReadOptions = {}) {
  const readings = await Promise.all(files.map((file) => readRigFile(file, options)));
  const images = readings.flatMap((reading) => (reading.kind === "colour" ? [reading.image] : []));
  const depths = readings.flatMap((reading) => (reading.kind === "depth" ? [reading.depth] : []));
  const frames: CheckFrame[] = images.slice(0, depths.length).map((image, i) => ({ image, depth: depths[i] as CheckFrame["depth"], name: `frame ${i + 1}` }));
  return { frames, cameras: readings.flatMap((reading) => (reading.kind === "cameras" ? reading.cameras : [])), poses: readings.flatMap((reading) => ("poses" in reading ? reading.poses : [])), warnings: [] as string[] };
}
