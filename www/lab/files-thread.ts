/** The thread that makes large files, because writing a cloud would block the page. It serves one request and ends. */

import "../engine/hold";
import { faultOf } from "../engine/fault";
import type { Fault, Taken } from "../engine/protocol";
import { depthPng, normalsPng, writeClouds, writeNpy } from "./write";

/** The kinds of files that this thread makes. */
export type LargeKind = "clouds" | "depth" | "depthPng" | "normals" | "depthNormals";

export interface FileRequest {
  kind: LargeKind;
  taken: Taken;
}
export type FileAnswer = { bytes: Uint8Array<ArrayBuffer>; says: string } | { fault: Fault };

/** Colours of the clouds, as on the page. */
const [ORANGE, BLUE] = [
  [199, 100, 26],
  [11, 98, 184],
];
const NORMALS = "colour = (n + 1) / 2; x right, y up, z towards the viewer";

const lengthOf = (unit: "m" | "px"): "metres" | "pixels" => (unit === "m" ? "metres" : "pixels");

function tinted(
  name: string,
  points: Float32Array,
  [red = 0, green = 0, blue = 0]: readonly number[],
): { name: string; points: Float32Array; colours: Uint8Array } {
  const colours = new Uint8Array(points.length);
  for (let at = 0; at < points.length; at += 3) {
    colours[at] = red;
    colours[at + 1] = green;
    colours[at + 2] = blue;
  }
  return { name, points, colours };
}

async function pack({ kind, taken }: FileRequest): Promise<{ bytes: Uint8Array<ArrayBuffer>; says: string }> {
  const { unit, depthUnit, image, depth, imagePoints, depthPoints } = taken;
  switch (kind) {
    case "clouds": {
      const clouds = [
        tinted("shape from the image", imagePoints, ORANGE),
        tinted("depth map in the estimated pose", depthPoints, BLUE),
      ];
      return { bytes: writeClouds(clouds, lengthOf(unit)), says: lengthOf(unit) };
    }
    case "depth":
      return { bytes: writeNpy({ ...depth, channels: 1, data: depth.refined }), says: lengthOf(depthUnit) };
    case "depthPng": {
      const { bytes, says } = await depthPng({ ...depth, data: depth.refined }, depthUnit);
      return { bytes, says: `${says} per stored number, 0 is no depth` };
    }
    case "normals":
      return { bytes: await normalsPng({ ...image, data: image.normals }), says: NORMALS };
    case "depthNormals":
      return { bytes: await normalsPng({ ...depth, data: depth.normals }), says: NORMALS };
  }
}

self.onmessage = async ({ data }: MessageEvent<FileRequest>) => {
  try {
    const made = await pack(data);
    self.postMessage(made satisfies FileAnswer, { transfer: [made.bytes.buffer] });
  } catch (error) {
    self.postMessage({ fault: faultOf(error, true) } satisfies FileAnswer);
  }
};
