// npm run pictures: contact sheets of the data beside the project and of a built-in scene, and a screenshot of the page.
//   [FOLDER]         target/pictures by default, so that other people's pictures stay outside the repository
//   --only a,b       only these objects, or "page"
//   photograph-N.png photograph, albedo, shading and residual of an object, with nothing known and 20 degrees between the views; if the
//                    pose is not found, from the true pose
//   depth-N.png      a registered capture: raw and refined depth, both shaded, and the image; the pose is known
//   painted.png      photograph, albedo, shading and residual of the built-in bust with varying albedo
//   screenshot.png   the Lab after a first visitor's run
import { mkdirSync, writeFileSync } from "node:fs";
import { join, relative, resolve } from "node:path";
import { parseArgs } from "node:util";
import { encode } from "fast-png";
import { build } from "./build.mjs";
import { setup } from "./setup.mjs";
import { labPicture } from "./pictures/lab.mjs";
import { Failure, root, say, script } from "./shell.mjs";
import { hasData, library } from "./tables/library.mjs";
import { onto } from "../protocols/measure-reals.mjs";
import { isFlagged, isFound } from "../protocols/counts.mjs";
import { quantile } from "../protocols/numbers.mjs";
import { judged, withRun } from "../protocols/runs.mjs";
import { PAINTED, requestOf } from "../protocols/scenes.mjs";

/** Captures, of which the first frame is shown. */
const CAPTURES = ["coffee_mug_1", "bowl_1", "cap_1", "cereal_box_1", "vase_rgbd", "android_rgbd", "mitten_rgbd"];
const FRAME = 1;
/** The name of the page's picture for --only. */
const PAGE = "page";
const SIZE = 96;
const BETA = 20;
/** Magnification of a photograph and of a capture's depth map, and the gap between pictures, pixels. */
const MAGNIFIED = 4;
const OF_DEPTH = 2;
const GAP = 6;
/** Log units from black to white: around the middle for colours, from zero for a residual. */
const LOG_RANGE = 3;
const RESIDUAL_RANGE = 0.6;
/** Approximates sRGB: converts linear shares to bytes. */
const GAMMA = 2.2;
const asBytes = (share) => 255 * Math.min(1, Math.max(0, share)) ** (1 / GAMMA);

/** A crop of a raster to the pixels for which `pixel` gives R, G, B (linear, 0 to 1); other pixels are black. */
function picture({ width, height }, pixel, magnified = MAGNIFIED) {
  const inside = Array.from({ length: width * height }, (_, index) => pixel(index));
  const filled = [...inside.keys()].filter((index) => inside[index]);
  const [left, top] = [Math.min(...filled.map((index) => index % width)), Math.floor(filled[0] / width)];
  const [right, bottom] = [Math.max(...filled.map((index) => index % width)), Math.floor(filled.at(-1) / width)];
  const size = { width: magnified * (right - left + 1), height: magnified * (bottom - top + 1) };
  const data = new Uint8Array(3 * size.width * size.height);
  for (let index = 0; index < size.width * size.height; index++) {
    const [column, row] = [index % size.width, Math.floor(index / size.width)].map((at) => Math.floor(at / magnified));
    data.set((inside[(row + top) * width + column + left] || [0, 0, 0]).map(asBytes), 3 * index);
  }
  return { ...size, data };
}

/** Joins rows of pictures into one picture. */
function sheet(rows) {
  const columns = rows[0].map((_, column) => Math.max(...rows.map((row) => row[column].width)));
  const heights = rows.map((row) => Math.max(...row.map(({ height }) => height)));
  const ends = (sizes) => sizes.reduce((all, size) => [...all, all.at(-1) + size + GAP], [GAP]);
  const [lefts, tops] = [ends(columns), ends(heights)];
  const [width, height] = [lefts.at(-1), tops.at(-1)];
  const data = new Uint8Array(3 * width * height);
  rows.forEach((row, r) =>
    row.forEach((part, c) => {
      for (let y = 0; y < part.height; y++) {
        data.set(
          part.data.subarray(3 * y * part.width, 3 * (y + 1) * part.width),
          3 * ((tops[r] + y) * width + lefts[c]),
        );
      }
    }),
  );
  return encode({ width, height, data, channels: 3, depth: 8 });
}

const triple = (raster, index) => [...raster.subarray(3 * index, 3 * index + 3)];

/** R, G, B of log colours, with the median mapped to the same brightness. */
function exposed(log) {
  const middle = quantile([...log].filter(Number.isFinite), 0.5);
  return (index) =>
    Number.isFinite(log[3 * index]) &&
    triple(log, index).map((value) => 0.3 * Math.exp(Math.max(-LOG_RANGE, value - middle)));
}

/** Image, albedo, shading and residual of a run with the given options. */
const taken = (api, image, depth, options = {}) =>
  withRun(api, { image, depth }, options, (report, estimator) => {
    const residual = estimator.residual();
    const log = Float32Array.from(image.data, (value, at) => (image.mask[Math.floor(at / 3)] ? Math.log(value) : NaN));
    const grey = (index) => Number.isFinite(residual[index]) && Array(3).fill(residual[index] / RESIDUAL_RANGE);
    const parts = [exposed(log), exposed(estimator.albedo()), exposed(estimator.shading()), grey];
    return { report, row: parts.map((part) => picture(image, part)) };
  });

/** A depth map lit by a lamp beside the camera. */
function shaded({ width, height, camera }, metres) {
  const point = (column, row) => {
    const z = metres[row * width + column];
    return [((column - camera.cx) * z) / camera.fx, ((row - camera.cy) * z) / camera.fy, z];
  };
  return (index) => {
    const [column, row] = [index % width, Math.floor(index / width)];
    if (column + 1 >= width || row + 1 >= height) return undefined;
    const [here, right, below] = [point(column, row), point(column + 1, row), point(column, row + 1)];
    const [u, v] = [right, below].map((other) => other.map((value, axis) => value - here[axis]));
    const normal = [u[2] * v[1] - u[1] * v[2], u[0] * v[2] - u[2] * v[0], u[1] * v[0] - u[0] * v[1]];
    const light = (-0.5 * normal[0] - 0.5 * normal[1] - 0.7 * normal[2]) / Math.hypot(...normal);
    return Number.isFinite(light) ? Array(3).fill(0.05 + 0.9 * Math.max(0, light)) : undefined;
  };
}

/** The pictures of a photographed object. If its pose is not found, the run starts from the true pose. */
async function photographed(api, data, surface) {
  const made = api.sample(requestOf({ surface, light: "A", size: SIZE, angles: { beta: BETA } }, data));
  const image = onto(SIZE, data.photograph(surface, "lab_diffuse"), made);
  const found = await taken(api, image, made.depth);
  const row = judged(found.report, made.pose);
  say(
    `${surface}: ${row.degrees.toFixed(1)} degrees off${isFlagged(row) ? ", flagged" : ""}${isFound(row) ? "" : "; told the truth"}`,
  );
  if (isFound(row)) return found.row;
  return (await taken(api, image, made.depth, { start: made.pose, registration: "fixed" })).row;
}

/** Colours of a file, 8 or 16 bits in sRGB, inside the mask. */
function coloured({ data, mask }) {
  const [channels, most] = [data.length / mask.length, 2 ** (8 * data.BYTES_PER_ELEMENT) - 1];
  return (index) => mask[index] && [0, 1, 2].map((channel) => (data[channels * index + channel] / most) ** GAMMA);
}

/** Raw and refined depth, shaded, and the image. */
const refined = (api, { image, depth }) =>
  withRun(api, { image, depth }, { start: "identity", registration: "fixed", scale: 1 }, (_, estimator) => {
    const raw = Float64Array.from(depth.data, (value, index) =>
      depth.mask[index] && value > 0 ? value * depth.unit : NaN,
    );
    const maps = [raw, estimator.refinedDepth()].map((metres) => picture(depth, shaded(depth, metres), OF_DEPTH));
    return [...maps, picture(image, coloured(image), Math.max(1, Math.round((OF_DEPTH * depth.width) / image.width)))];
  });

/** The built-in bust in window light, in squares of four albedos. */
function painted(api) {
  const { image, depth } = api.sample({
    surface: "bust",
    light: "window",
    size: SIZE,
    angles: { beta: 25 },
    noise: 0.01,
  });
  const paints = [
    [1, 1, 1],
    [0.9, 0.35, 0.3],
    [0.3, 0.7, 0.4],
    [0.35, 0.4, 0.85],
  ];
  const side = Math.round(SIZE / 8);
  const data = image.data.map((value, at) => {
    const index = Math.floor(at / 3);
    const [column, row] = [index % image.width, Math.floor(index / image.width)].map((place) =>
      Math.floor(place / side),
    );
    return value * paints[(column + 3 * row) % 4][at % 3];
  });
  return taken(api, { ...image, data }, depth);
}

function parsed() {
  try {
    const {
      positionals: [folder = "target/pictures"],
      values: { only },
    } = parseArgs({ options: { only: { type: "string" } }, allowPositionals: true });
    const wanted = only?.split(",");
    const names = [...PAINTED, ...CAPTURES, PAGE];
    const unknown = wanted?.find((name) => !names.includes(name));
    if (unknown) throw new Error(`There is no object "${unknown}"; there are ${names.join(", ")}.`);
    return { folder: resolve(root, folder), of: (names) => names.filter((name) => !wanted || wanted.includes(name)) };
  } catch (error) {
    throw new Failure(error.message);
  }
}

await script(async () => {
  const { folder, of } = parsed();
  await setup();
  await build();
  const api = await import("../pkg/index.js");
  await api.default();
  mkdirSync(folder, { recursive: true });
  const save = (name, row) => writeFileSync(join(folder, `${name}.png`), sheet([row]));
  save("painted", (await painted(api)).row);
  if (of([PAGE]).length > 0) writeFileSync(join(folder, "screenshot.png"), await labPicture());
  if (hasData()) {
    const data = library(await import("../pkg/files.js"));
    for (const name of of(PAINTED)) save(`photograph-${name}`, await photographed(api, data, name));
    for (const name of of(CAPTURES)) save(`depth-${name}`, await refined(api, data.capture(name, FRAME)));
  }
  say(`the pictures are in ${relative(root, folder) || "."}`);
});
