// Resolves the names in the cells: built-in scenes, and other people's data from beside the project.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { PAIRS, capture } from "../real-pairs.mjs";
import { inRoot } from "../shell.mjs";
import { readHeights } from "./npy.mjs";

const DATA = inRoot("../shared/data");
/** Numbers in the first column of `natural_lights_114.csv`: an easy, a median and a hard one. */
const NATURAL_LIGHTS = { A: 132, B: 214, C: 144 };
/** Side of a relief, and the length that an object of `mit_berkeley` spans in the relief, samples. */
const RELIEF_SIDE = 256;
const OBJECT_SPAN = 230;
/** Lowest height of such an object, samples; heights up to 5 are background. */
const LOWEST = 6;

export const hasData = () => existsSync(DATA);
/** Pairs of a statue: from the data beside the project, or from a folder that the environment names, which child processes inherit. */
const STATUES = () => process.env.BIMODAL_STATUE ?? join(DATA, "statue");
export const statues = () => (existsSync(STATUES()) ? readdirSync(STATUES()).sort() : []);
export const DATA_FOLDER = DATA;

const bytes = (...path) => readFileSync(join(DATA, ...path));

/** Caches a reader. */
function remember(read) {
  const kept = new Map();
  return (name) => {
    if (!kept.has(name)) kept.set(name, read(name));
    return kept.get(name);
  };
}

function naturalLight(index) {
  const rows = bytes("lights", "natural_lights_114.csv").toString().trim().split("\n");
  return rows
    .map((row) => row.split(",").map(Number))
    .find(([first]) => first === index)
    .slice(1);
}

/** Bounding box of the object: first and last column and row with a height. */
function extent({ width, data }) {
  let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const [index, height] of data.entries()) {
    if (Number.isNaN(height)) continue;
    const [column, row] = [index % width, Math.floor(index / width)];
    [left, right] = [Math.min(left, column), Math.max(right, column)];
    [top, bottom] = [Math.min(top, row), Math.max(bottom, row)];
  }
  return { left, right, top, bottom };
}

/** Bilinear interpolation between neighbours that have a value; NaN if the nearest has none. */
function heightAt({ width, height, data }, x, y) {
  const inside = (column, row) => column >= 0 && row >= 0 && column < width && row < height;
  const at = (column, row) => (inside(column, row) ? data[row * width + column] : NaN);
  if (Number.isNaN(at(Math.round(x), Math.round(y)))) return NaN;
  let [sum, weights] = [0, 0];
  for (const row of [Math.floor(y), Math.floor(y) + 1]) {
    for (const column of [Math.floor(x), Math.floor(x) + 1]) {
      const weight = (1 - Math.abs(x - column)) * (1 - Math.abs(y - row));
      if (weight > 0 && !Number.isNaN(at(column, row)))
        [sum, weights] = [sum + weight * at(column, row), weights + weight];
    }
  }
  return sum / weights;
}

/** An object's heights on the grid of a relief, and the grid's position in the object's photographs. */
function objectOn(raster) {
  const { left, right, top, bottom } = extent(raster);
  const place = {
    samplesPerPixel: OBJECT_SPAN / Math.max(right - left, bottom - top),
    x: (left + right) / 2,
    y: (top + bottom) / 2,
  };
  const heights = new Float32Array(RELIEF_SIDE * RELIEF_SIDE);
  for (let index = 0; index < heights.length; index++) {
    const [column, row] = [index % RELIEF_SIDE, Math.floor(index / RELIEF_SIDE)].map(
      (at) => at - (RELIEF_SIDE - 1) / 2,
    );
    const [x, y] = [place.x + column / place.samplesPerPixel, place.y + row / place.samplesPerPixel];
    heights[index] = place.samplesPerPixel * heightAt(raster, x, y);
  }
  const lowest = heights.reduce((low, height) => (height < low ? height : low), Infinity);
  const raised = heights.map((height) => (Number.isNaN(height) ? 0 : height - lowest + LOWEST));
  return { place, relief: { width: RELIEF_SIDE, height: RELIEF_SIDE, heights: raised } };
}

/** One frame of the mitten with its own depth, and the median of twenty depths in the same unit. */
function mitten(files, frame) {
  const read = (name) => bytes("mitten_rgbd", name);
  const { colour, depth, depth_unit_m: unit } = JSON.parse(read("calib.json").toString());
  const camera = ({ fx, fy, cx, cy }) => ({ fx, fy, cx, cy });
  const { width, height, data: mask } = files.decodeMask(read("mask.png"));
  const halved = new Uint8Array(depth.width * depth.height);
  halved.forEach((_, index) => {
    halved[index] = mask[2 * Math.floor(index / depth.width) * width + 2 * (index % depth.width)];
  });
  if (width !== 2 * depth.width || height !== 2 * depth.height)
    throw new Error("the mitten's mask is not twice its depth");
  return {
    image: { ...files.decodeColour(read(`color_${frame}.png`)), mask, camera: camera(colour) },
    depth: { ...files.decodeDepth(read(`depth_${frame}.png`)), mask: halved, camera: camera(depth), unit },
    median20: Float64Array.from(files.decodeDepth(read("depth_median20.png")).data),
  };
}

/** A scan of DiLiGenT: depth in metres, and the normals of its photometric stereo, in this project's frame. */
function scan(files, name) {
  const read = (file) => bytes("diligent", name, file);
  const { width, height, data } = readHeights(read("depth_mm.npy"));
  const [[fx, , cx], [, fy, cy]] = read("K.txt")
    .toString()
    .trim()
    .split("\n")
    .map((row) => row.trim().split(/\s+/).map(Number));
  const encoded = files.decodeColour(read("normal_map.png")).data;
  const normals = new Float32Array(3 * width * height);
  for (let index = 0; index < width * height; index++) {
    const normal = [1, -1, -1].map((sign, axis) => sign * (2 * (encoded[4 * index + axis] / 0xffff) - 1));
    normals.set(
      normal.map((part) => part / Math.hypot(...normal)),
      3 * index,
    );
  }
  const mask = files.decodeMask(read("mask.png")).data;
  return {
    width,
    height,
    metres: Float64Array.from(data, (depth) => depth / 1000),
    normals,
    mask,
    camera: { fx, fy, cx, cy },
  };
}

/** Colour and depth of a statue with both cameras, the pose between them, and the angle between the viewing directions in degrees. */
function statue(name) {
  const read = (file) => readFileSync(join(STATUES(), name, file));
  const { iw, ih, dw, dh, Kc, Kd, rotation, translation, viewDegrees } = JSON.parse(read("meta.json").toString());
  const depth = read("depth.bin");
  return {
    view: viewDegrees,
    image: { width: iw, height: ih, data: new Uint8Array(read("image.bin")), mask: read("imask.bin"), camera: Kc },
    depth: {
      width: dw,
      height: dh,
      data: new Float32Array(new Uint8Array(depth).buffer),
      mask: read("dmask.bin"),
      camera: Kd,
    },
    truth: { scale: 1, rotation, translation },
  };
}

/** `files` is the package's own reader. */
export function library(files) {
  if (!hasData()) return { surface: (name) => name, light: (name) => name, gaussian: undefined };
  const object = remember((name) => objectOn(readHeights(bytes("mit_berkeley", name, "height.npy"))));
  const mozart = remember(() => {
    const { width, height, data } = readHeights(bytes("mozart", "mozart256.npy"));
    return { width, height, heights: data };
  });
  const natural = remember((name) => naturalLight(NATURAL_LIGHTS[name]));
  const photograph = remember((path) => {
    const [name] = path.split("/");
    const { width, height, data } = files.decodeColour(bytes("mit_berkeley", `${path}.png`));
    const colours = new Float32Array(3 * width * height);
    for (let index = 0; index < width * height; index++) {
      for (let channel = 0; channel < 3; channel++) colours[3 * index + channel] = data[4 * index + channel] / 0xffff;
    }
    const mask = files.decodeMask(bytes("mit_berkeley", name, "lab_mask.png")).data;
    return { width, height, data: colours, mask, place: object(name).place };
  });
  const isObject = (name) => existsSync(join(DATA, "mit_berkeley", name, "height.npy"));
  return {
    surface: (name) => (name === "mozart" ? mozart(name) : isObject(name) ? object(name).relief : name),
    light: (name) => (name in NATURAL_LIGHTS ? natural(name) : name),
    gaussian: JSON.parse(bytes("lights", "natural_light_gaussian.json").toString()),
    mitten: (frame) => mitten(files, frame),
    scan: (name) => scan(files, name),
    statue,
    pair: (name) => PAIRS[name](files),
    /** Colour and depth of one moment, each with its own frame. */
    capture: (name, frame) => capture(name, frame, files),
    /** Linear colours with the object's mask, and the position of a relief's samples in it. */
    photograph: (name, image) => photograph(`${name}/${image}`),
  };
}
