// The pairs for timing, made once and written to files, so that browser and native loop read the same bytes.
import { mkdirSync, writeFileSync } from "node:fs";
import { inRoot } from "../shell.mjs";
import { hasData, library } from "../tables/library.mjs";
import { drawScene } from "../../protocols/anywhere.mjs";
import { chance } from "../../protocols/numbers.mjs";
import { NOISE, kit, requestOf } from "../../protocols/scenes.mjs";

const FOLDER = "target/bench/scenes";
/** Side of the relief of Mozart and of the built-in surfaces, samples. */
const RELIEF_SIDE = 256;
/** Heights below this are background (docs/lab/protocols.md), samples. */
const FLOOR = 5;

/** "640x480" as numbers. */
export const sidesOf = (size) => size.split("x").map(Number);

/** Heights of a built-in surface, taken from a rendering on its own grid. */
function heightsOf(surface, sample) {
  const { truth } = sample({ surface, light: "colourful", size: RELIEF_SIDE });
  const farthest = truth.imageDepth.reduce((far, depth) => (depth > far ? depth : far), -Infinity);
  const heights = truth.imageDepth.map((depth) => (Number.isNaN(depth) ? 0 : farthest - depth + FLOOR + 1));
  return { width: RELIEF_SIDE, height: RELIEF_SIDE, heights };
}

/** A square relief stretched to the frame's width, so that the object covers about half of the frame at 640x480 as in a square. */
function widened({ width, height, heights }, factor) {
  const wide = Math.round(width * factor);
  const stretched = new Float32Array(wide * height);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < wide; column++) {
      const at = Math.max(0, Math.min(width - 1, (column + 0.5) / factor - 0.5));
      const [low, share] = [Math.floor(at), at - Math.floor(at)];
      const [a, b] = [low, Math.min(width - 1, low + 1)].map((x) => heights[row * width + x]);
      // Object and background are not interpolated; the nearer sample decides.
      const edge = a > FLOOR !== b > FLOOR;
      stretched[row * wide + column] = edge ? (share < 0.5 ? a : b) : a + share * (b - a);
    }
  }
  return { width: wide, height, heights: stretched };
}

/** Little-endian: width and height (u32), the pose (f64: s, R row by row, t), linear RGB and depth (f32, NaN off the masks). */
function write(name, { image, depth, pose }) {
  const { width, height } = image;
  const head = new DataView(new ArrayBuffer(8 + 8 * 13));
  [width, height].forEach((side, index) => head.setUint32(4 * index, side, true));
  [pose.scale, ...pose.rotation, ...pose.translation].forEach((value, index) =>
    head.setFloat64(8 + 8 * index, value, true),
  );
  const colours = image.data.map((value, index) => (image.mask[Math.floor(index / 3)] ? value : NaN));
  const path = `${FOLDER}/${name}.bin`;
  writeFileSync(inRoot(path), Buffer.concat([head, colours, depth.data].map(({ buffer }) => Buffer.from(buffer))));
  const inside = image.mask.reduce((count, value) => count + (value ? 1 : 0), 0);
  return { path, pixels: width * height, covered: inside / (width * height) };
}

/** Makers of scene files; `api` is the package, `files` its readers. */
export function scenes(api, files) {
  mkdirSync(inRoot(FOLDER), { recursive: true });
  const names = kit(hasData());
  const data = library(files);
  // Among the built-in surfaces, ripples cover half of their grid, like Mozart.
  const surface = hasData() ? "mozart" : "ripples";
  const relief = hasData() ? data.surface(surface) : heightsOf(surface, api.sample);
  const lightName = hasData() ? "A" : "window";
  return {
    surface,
    lightName,
    /** The scene for timing steps: beta = 20, natural light. */
    plain(size, seed = 1) {
      const [width, height] = sidesOf(size);
      const made = api.sample({
        ...{ surface: width > height ? widened(relief, width / height) : relief, light: data.light(lightName) },
        ...{ size: width, height, angles: { beta: 20 }, noise: NOISE, seed },
      });
      return write(`${size}-plain-${seed}`, made);
    },
    /** Random surface, light, pose and scale: scenes of the tables at another size. */
    random(size, seed) {
      const [width] = sidesOf(size);
      const scene = { ...drawScene(chance(seed), names, data.gaussian), size: width, seed };
      return write(`${size}-random-${seed}`, api.sample(requestOf(scene, data)));
    },
  };
}
