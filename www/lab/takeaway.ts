/** Results as files of common formats. Loaded when the first is asked for. */

import type { Pose } from "../../pkg/index.js";
import type { Taken } from "../engine/protocol";
import type { Kind } from "./kinds";


interface File {
  name: string;
  type: string;
  parts: BlobPart[];
}

/** The 4x4 matrix that carries the depth map's points into the colour view. */
function matrix({ scale, rotation, translation }: Pose): string {
  const row = (i: number) => [...rotation.slice(3 * i, 3 * i + 3).map((value) => scale * value), translation[i] ?? 0].join(" ");
  return `${[row(0), row(1), row(2), "0 0 0 1"].join("\n")}\n`;
}

/** Both clouds in the colour view's frame: orange the picture's, blue the depth map's. */
function ply({ imagePoints, depthPoints, unit }: Taken): string {
  const lines = (points: Float32Array, colour: string) =>
    Array.from({ length: points.length / 3 }, (_, i) => [...points.subarray(3 * i, 3 * i + 3)].join(" ") + colour).filter((line) => !line.includes("NaN"));
  const vertices = [...lines(imagePoints, " 199 100 26"), ...lines(depthPoints, " 11 98 184")];
  const properties = [...["x", "y", "z"].map((axis) => `property float ${axis}`), ...["red", "green", "blue"].map((colour) => `property uchar ${colour}`)];
  const unitName = unit === "m" ? "metres" : "pixels";
  const head = ["ply", "format ascii 1.0", `comment ${unitName}; x right, y down, z forward, in the colour view's frame`, `element vertex ${vertices.length}`, ...properties, "end_header"];
  return `${[...head, ...vertices].join("\n")}\n`;
}

/** Numpy's format, version 1: a header that fills whole blocks of 64 bytes, then the numbers. */
function npy(data: Float32Array<ArrayBuffer>, width: number, height: number): BlobPart[] {
  const said = `{'descr': '<f4', 'fortran_order': False, 'shape': (${height}, ${width}), }`;
  const total = Math.ceil((10 + said.length + 1) / 64) * 64;
  const head = `${said.padEnd(total - 11, " ")}\n`;
  const lead = new Uint8Array([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, head.length & 255, head.length >> 8]);
  return [lead, head, data];
}

const CHANNELS = ["R", "G", "B"];

/** One channel a line. */
function csv(light: Float64Array): string {
  const names = Array.from({ length: 9 }, (_, k) => `L${k + 1}`);
  const line = (channel: string, c: number) => [channel, ...light.subarray(9 * c, 9 * c + 9)].join(",");
  return `${[["channel", ...names].join(","), ...CHANNELS.map(line)].join("\n")}\n`;
}

function fileOf(kind: Kind, taken: Taken): File {
  switch (kind) {
    case "pose":
      return { name: "pose.json", type: "application/json", parts: [JSON.stringify({ ...taken.pose, unit: taken.unit }, null, 2)] };
    case "matrix":
      return { name: "depth_to_colour.txt", type: "text/plain", parts: [matrix(taken.pose)] };
    case "clouds":
      return { name: "clouds.ply", type: "application/octet-stream", parts: [ply(taken)] };
    case "depth":
      return { name: "refined-depth.npy", type: "application/octet-stream", parts: npy(taken.refinedDepth, taken.width, taken.height) };
    case "light":
      return { name: "light.csv", type: "text/csv", parts: [csv(taken.light)] };
  }
}

export function fileOfKind(kind: Kind, taken: Taken): { name: string; blob: Blob } {
  const { name, type, parts } = fileOf(kind, taken);
  return { name, blob: new Blob(parts, { type }) };
}
