// Renders with the flaws of real pairs, nothing known: varying albedo, lamps with shadows, JPEG, depth in noisy steps.
import { drawScene } from "./anywhere.mjs";
import { measuredRows, rowByKind } from "./counts.mjs";
import { throughJpeg } from "./jpeg.mjs";
import { blurred, SENSOR } from "./measure-sensors.mjs";
import { chance, median, quantile } from "./numbers.mjs";
import { paint } from "./painted.mjs";
import { FROM_ANYWHERE, requestOf } from "./scenes.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";

const SCENES = 200;
const QUICK_SCENES = 4;
const SIZES = [96, 112, 128];
const QUALITY = 85;
/** Width of the frame and distance of the object, metres, which determine the depth steps. */
const FRAME = 0.22;
const DISTANCES = [0.5, 0.8];
/** Noise of the disparity before rounding, in steps, and its lateral blur, pixels. */
const DISPARITY = { noise: 0.4, blur: 0.8 };
/** A lamp: angle to the line of sight in degrees, range of its colour channels, and ambient light as a share of it. */
const LAMP = { off: [15, 60], hue: [0.7, 1], ambient: [0.15, 0.4] };
/** Depth behind the surface at which a ray counts as occluded, and its step, pixels. */
const RAY = { bias: 0.7, step: 0.5 };
/** Noise of a photograph in log units, and the level of its brightest part. */
const NOISE = 0.01;
const BRIGHT = 0.85;
const BACKGROUND = [0.05, 0.6];

const PAINTS = ["stripes", "patches", "print"];
const LIGHTS = ["natural", "lamp"];

export const stress = {
  name: "stress",
  title:
    "Renders with varying albedo, lamps and their shadows, JPEG 85, depth in noisy steps: random scenes at 96 to 128 pixels, nothing known",
  notes: [
    "paint: two to eight colours in stripes or patches, or print in one; light: natural, or a lamp with attached and cast shadows and ambient light",
    "depth: 0.22 m wide frame at 0.5 to 0.8 m, disparity 580 x 0.075 / z with smoothed noise of 0.4 steps, rounded to 1/8 pixel",
  ],
  cells: (kit, quick) =>
    Array.from({ length: quick ? QUICK_SCENES : SCENES }, (_, index) => {
      // Odd and even scenes both include all kinds: constants are set on the odd scenes and judged by the even ones.
      const lit = LIGHTS[(Math.floor(index / 3) + Math.floor(index / 6)) % LIGHTS.length];
      const kinds = { paint: PAINTS[index % PAINTS.length], lit };
      const row = { scene: index + 1, ...kinds };
      return { id: `stress/${index + 1}`, kind: "stress", row, kit, seed: index + 1, options: FROM_ANYWHERE };
    }),
  /** One row for all cells, and one for each kind. */
  rows: (results) =>
    rowByKind(measuredRows(results), [
      { key: "paint", values: PAINTS },
      { key: "lit", values: LIGHTS },
    ]),
};

/** Pixels of an orthographic depth map (larger is farther) whose ray to the lamp is blocked by the map. */
function castShadows({ width, height, depth }, lamp) {
  const across = Math.hypot(lamp[0], lamp[1]);
  const reach = across < 1e-6 ? 0 : Math.ceil(Math.hypot(width, height) / across / RAY.step);
  const nearest = depth.reduce((least, z) => (z < least ? z : least), Infinity);
  return depth.map((z, index) => {
    const [column, row] = [index % width, Math.floor(index / width)];
    for (let k = 2; k < reach; k++) {
      const [x, y, ray] = [column + k * RAY.step * lamp[0], row + k * RAY.step * lamp[1], z + k * RAY.step * lamp[2]];
      const [left, top] = [Math.round(x), Math.round(y)];
      if (ray < nearest || left < 0 || top < 0 || left >= width || top >= height) return 0;
      if (depth[top * width + left] < ray - RAY.bias) return 1;
    }
    return 0;
  });
}

/** Linear colours of a scene under a distant lamp and ambient light. */
function litByLamp({ image, truth }, dice) {
  const off = (Math.PI / 180) * dice.uniform(...LAMP.off);
  const around = dice.uniform(0, 2 * Math.PI);
  const lamp = [Math.sin(off) * Math.cos(around), Math.sin(off) * Math.sin(around), -Math.cos(off)];
  const [hue, sky] = [0, 1].map(() => [0, 1, 2].map(() => dice.uniform(...LAMP.hue)));
  const ambient = dice.uniform(...LAMP.ambient);
  const shadow = castShadows({ ...image, depth: truth.imageDepth }, lamp);
  const out = new Float32Array(image.data.length);
  for (let index = 0; index < image.width * image.height; index++) {
    if (!image.mask[index]) continue;
    const normal = truth.imageNormals.subarray(3 * index, 3 * index + 3);
    const direct = shadow[index] ? 0 : Math.max(0, normal[0] * lamp[0] + normal[1] * lamp[1] + normal[2] * lamp[2]);
    for (let channel = 0; channel < 3; channel++) {
      out[3 * index + channel] = (direct * hue[channel] + ambient * sky[channel]) * Math.exp(NOISE * dice.gaussian());
    }
  }
  return out;
}

/** Multiplies the colours by printed text, in place: lines of small dark marks with gaps, in one ink on one paper. */
function print(colours, size, dice) {
  const [paper, ink] = [dice.uniform(0.6, 1), dice.uniform(0.1, 0.35)];
  const hues = [0, 1].map(() => [0, 1, 2].map(() => dice.uniform(0.6, 1)));
  const [angle, line, mark] = [dice.uniform(0, 2 * Math.PI), dice.uniform(6, 12), dice.uniform(2, 5)];
  const marks = Array.from({ length: 61 * 61 }, () => dice.uniform() < 0.6);
  for (let index = 0; index < size * size; index++) {
    const [column, row] = [index % size, Math.floor(index / size)];
    const along = (column * Math.cos(angle) + row * Math.sin(angle)) / mark;
    const across = (row * Math.cos(angle) - column * Math.sin(angle)) / line;
    const place = (value) => ((Math.floor(value) % 61) + 61) % 61;
    const inked = across - Math.floor(across) < 0.5 && marks[61 * place(across) + place(along)];
    const [level, hue] = inked ? [ink, hues[1]] : [paper, hues[0]];
    for (let channel = 0; channel < 3; channel++) colours[3 * index + channel] *= level * hue[channel];
  }
}

/** The image as a camera stores it if the exposure is set for the object. Behind the object is a grey wall. */
function photographed(image, colours, dice) {
  const { width, height, mask } = image;
  const inside = [...mask.keys()].filter((index) => mask[index]);
  const exposure =
    BRIGHT /
    quantile(
      inside.map((index) => Math.max(...colours.subarray(3 * index, 3 * index + 3))),
      0.99,
    );
  const wall = dice.uniform(...BACKGROUND);
  const data = colours.map((value, index) => (mask[Math.floor(index / 3)] ? value * exposure : wall));
  return { width, height, mask, data: throughJpeg({ width, height, data }, QUALITY) };
}

/** Depth as a structured-light sensor measures it, in pixels. */
function measured(depth, width, dice) {
  const distance = dice.uniform(...DISTANCES);
  const pixel = FRAME / width;
  const middle = median([...depth.data]);
  const bf = SENSOR.focalLength * SENSOR.baseline;
  const noise = blurred({ ...depth, data: depth.data.map(() => dice.gaussian()) }, DISPARITY.blur);
  const spread = Math.sqrt(noise.reduce((sum, value) => sum + value * value, 0) / noise.length);
  const data = depth.data.map((z, index) => {
    const steps = (SENSOR.steps * bf) / (distance + (z - middle) * pixel) + (DISPARITY.noise * noise[index]) / spread;
    return (SENSOR.steps * bf) / Math.round(steps) / pixel;
  });
  return { ...depth, data };
}

function makeStress(cell, api, library) {
  const dice = chance(cell.seed);
  const scene = {
    ...drawScene(dice, cell.kit, library.gaussian),
    size: SIZES[dice.below(SIZES.length)],
    seed: cell.seed,
  };
  const made = api.sample(requestOf(scene, library));
  const colours = cell.row.lit === "lamp" ? litByLamp(made, dice) : made.image.data.slice();
  if (cell.row.paint === "print") print(colours, scene.size, dice);
  else paint(colours, scene.size, dice, cell.row.paint === "stripes");
  const image = photographed(made.image, colours, dice);
  return { scene, made, pair: { image, depth: measured(made.depth, scene.size, dice) } };
}

export async function measureStress(cell, api, library) {
  const { scene, made, pair } = makeStress(cell, api, library);
  const { surface, overlap, angles, scale, size } = scene;
  return withRun(api, pair, optionsOf(cell.options, made), (report, _, milliseconds) => ({
    ...{ surface, overlap, size, trueAngles: angles, trueScale: scale },
    ...judged(report, made.pose, milliseconds),
  }));
}
