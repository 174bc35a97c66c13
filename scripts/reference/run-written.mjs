// Writes the files of the Lab's "Download" for a synthetic run, for independent readers (run-written.py) and for
// tests/contract/write.test.mjs.
//
// npm run build && node scripts/reference/run-written.mjs     writes tests/fixtures/run/
import { mkdirSync, realpathSync, writeFileSync } from "node:fs";
import {
  depthPng,
  lightCsv,
  matrixText,
  normalsPng,
  poseJson,
  writeClouds,
  writeNpy,
  writePng,
} from "../../pkg/write.js";
import { inRoot } from "../shell.mjs";

export const FOLDER = "tests/fixtures/run";

const [width, height] = [7, 5];
const [sine, cosine] = [Math.sin(0.3), Math.cos(0.3)];

/** A rotation about y, a scale other than one, a tiny number and a round one. */
export const POSE = {
  scale: 1.25,
  rotation: [cosine, 0, sine, 0, 1, 0, -sine, 0, cosine],
  translation: [-0.02503, 1e-7, 3],
  angles: { alpha: 0, beta: (0.3 * 180) / Math.PI, gamma: 0 },
};
export const LIGHT = Float64Array.from({ length: 27 }, (_, k) => Math.cos(k) / 3);
/** Depths in metres and in pixels. Values that are not positive or NaN mean no depth; in pixels, a value below zero would be refused. */
export const DEPTH = Float32Array.from({ length: width * height }, (_, i) =>
  i === 3 ? NaN : i === 8 ? 0 : i === 9 ? -1 : i === 11 ? Infinity : 0.5 + 0.0123 * i,
);
export const FAR = Float32Array.from(DEPTH, (value) => 20 * value);
export const PIXELS = Float32Array.from(DEPTH, (value) => (value < 0 ? NaN : 100 * value));
export const NORMALS = Float32Array.from({ length: 3 * width * height }, (_, i) => {
  const [x, y] = [Math.sin(Math.floor(i / 3)) / 2, Math.cos(Math.floor(i / 3)) / 3];
  return Math.floor(i / 3) === 4 ? NaN : [x, y, -Math.sqrt(1 - x * x - y * y)][i % 3];
});
export const CLOUDS = [
  {
    name: "shape from the picture",
    points: new Float32Array([0, 0.1, 1, NaN, NaN, NaN, -0.2, 1 / 3, 2.5]),
    colours: new Uint8Array([199, 100, 26, 0, 0, 0, 199, 100, 26]),
  },
  {
    name: "depth map, moved by the pose",
    points: new Float32Array([1e-7, -4, 8]),
    colours: new Uint8Array([11, 98, 184]),
  },
];

/** Every file by its name. */
export async function files() {
  const text = (words) => new TextEncoder().encode(words);
  const size = { width, height };
  return {
    "pose.json": text(poseJson(POSE, "m")),
    "depth_to_colour.txt": text(matrixText(POSE)),
    "light.csv": text(lightCsv(LIGHT)),
    "clouds-metres.ply": writeClouds(CLOUDS, "metres"),
    "clouds-pixels.ply": writeClouds(CLOUDS, "pixels"),
    "depth.npy": writeNpy({ ...size, channels: 1, data: DEPTH }),
    "normals.npy": writeNpy({ ...size, channels: 3, data: NORMALS }),
    "levels.npy": writeNpy({ ...size, channels: 1, data: Uint16Array.from(DEPTH, (_, i) => 1871 * i) }),
    "depth.png": (await depthPng({ ...size, data: DEPTH }, "m")).bytes,
    "depth-far.png": (await depthPng({ ...size, data: FAR }, "m")).bytes,
    "depth-pixels.png": (await depthPng({ ...size, data: PIXELS }, "px")).bytes,
    "normals.png": await normalsPng({ ...size, data: NORMALS }),
    "grey.png": await writePng({ ...size, channels: 1, data: Uint8Array.from(DEPTH, (_, i) => 7 * i) }),
  };
}

if (import.meta.filename === realpathSync(process.argv[1])) {
  mkdirSync(inRoot(FOLDER), { recursive: true });
  for (const [name, bytes] of Object.entries(await files())) writeFileSync(inRoot(FOLDER, name), bytes);
}
