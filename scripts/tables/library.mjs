// The names in the cells and what they stand for: the package's own scenes, and other people's data from beside the project.
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { PAIRS, capture } from "../real-pairs.mjs";
import { inRoot } from "../shell.mjs";
import { readHeights } from "./npy.mjs";
import { PAINTED } from "./protocol/scenes.mjs";

const DATA = inRoot("../shared/data");
/** Rows of `natural_lights_114.csv`: the easy, the median and the hard one. */
const NATURAL_LIGHTS = { A: 132, B: 214, C: 144 };
/** Side of a relief, and how much of it an object of `mit_berkeley` spans. */
const RELIEF_SIDE = 256;
const OBJECT_SPAN = 230;
/** Lowest height of such an object in samples: at 5 the background begins. */
const LOWEST = 6;

export const hasData = () => existsSync(DATA);
export const DATA_FOLDER = DATA;

const bytes = (...path) => readFileSync(join(DATA, ...path));

/** Reads once. */
function remember(read) {
  const kept = new Map();
  return (name) => {
    if (!kept.has(name)) kept.set(name, read(name));
    return kept.get(name);
  };
}

function naturalLight(index) {
  const rows = bytes("lights", "natural_lights_114.csv").toString().trim().split("\n");
  return rows.map((row) => row.split(",").map(Number)).find(([first]) => first === index).slice(1);
}

/** Box of the object: first and last column and row with a height. */
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

/** Bilinear between the neighbours that have a value; NaN where the nearest has none. */
function heightAt({ width, height, data }, x, y) {
  const inside = (column, row) => column >= 0 && row >= 0 && column < width && row < height;
  const at = (column, row) => (inside(column, row) ? data[row * width + column] : NaN);
  if (Number.isNaN(at(Math.round(x), Math.round(y)))) return NaN;
  let [sum, weights] = [0, 0];
  for (const row of [Math.floor(y), Math.floor(y) + 1]) {
    for (const column of [Math.floor(x), Math.floor(x) + 1]) {
      const weight = (1 - Math.abs(x - column)) * (1 - Math.abs(y - row));
      if (weight > 0 && !Number.isNaN(at(column, row))) [sum, weights] = [sum + weight * at(column, row), weights + weight];
    }
  }
  return sum / weights;
}

/** An object's heights on the grid of a relief, and where the grid lies in the object's photographs. */
function objectOn(raster) {
  const { left, right, top, bottom } = extent(raster);
  const place = {
    samplesPerPixel: OBJECT_SPAN / Math.max(right - left, bottom - top),
    x: (left + right) / 2,
    y: (top + bottom) / 2,
  };
  const heights = new Float32Array(RELIEF_SIDE * RELIEF_SIDE);
  for (let index = 0; index < heights.length; index++) {
    const [column, row] = [index % RELIEF_SIDE, Math.floor(index / RELIEF_SIDE)].map((at) => at - (RELIEF_SIDE - 1) / 2);
    const [x, y] = [place.x + column / place.samplesPerPixel, place.y + row / place.samplesPerPixel];
    heights[index] = place.samplesPerPixel * heightAt(raster, x, y);
  }
  const lowest = heights.reduce((low, height) => (height < low ? height : low), Infinity);
  const raised = heights.map((height) => (Number.isNaN(height) ? 0 : height - lowest + LOWEST));
  return { place, relief: { width: RELIEF_SIDE, height: RELIEF_SIDE, heights: raised } };
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
  return {
    surface: (name) => (name === "mozart" ? mozart(name) : PAINTED.includes(name) ? object(name).relief : name),
    light: (name) => (name in NATURAL_LIGHTS ? natural(name) : name),
    gaussian: JSON.parse(bytes("lights", "natural_light_gaussian.json").toString()),
    pair: (name) => PAIRS[name](files),
    /** Colour and depth of one moment, one frame of their own each. */
    capture: (name, frame) => capture(name, frame, files),
    /** Linear colours with the object's mask, and where a relief's samples lie on it. */
    photograph: (name, image) => photograph(`${name}/${image}`),
  };
}
