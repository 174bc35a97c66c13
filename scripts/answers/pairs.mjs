// The views of a scene: rendered by the package's `sample` or in metres, then modified as the scene requires.
import { throughJpeg } from "../../protocols/jpeg.mjs";
import { chance, median } from "../../protocols/numbers.mjs";
import { paint } from "../../protocols/painted.mjs";
import { aboutAxis, anglesOf, product, turn } from "../../protocols/rotations.mjs";
import { metricPair } from "./metric.mjs";

/** Grid of an added relief, samples; its radius is that of its disc. */
const SIDE = 128;
const RADIUS = 0.44 * SIDE;

/** Heights over a disc in units of its radius, raised so that no sample is background. */
function relief(height) {
  const heights = new Float32Array(SIDE * SIDE);
  for (let index = 0; index < heights.length; index++) {
    const [x, y] = [index % SIDE, Math.floor(index / SIDE)].map((at) => (at - (SIDE - 1) / 2) / RADIUS);
    heights[index] = x * x + y * y < 0.98 ? RADIUS * (1 + height(x, y)) : NaN;
  }
  return { width: SIDE, height: SIDE, heights };
}

/** Surfaces in addition to the built-in ones. A ball looks the same after any rotation, so its pose is not observable. */
const RELIEFS = {
  ball: (x, y) => Math.sqrt(Math.max(0, 1 - x * x - y * y)),
  hills(x, y) {
    const hill = 0.25 / (1 + 20 * ((x - 0.3) ** 2 + (y + 0.4) ** 2));
    const hollow = 0.3 / (1 + 15 * ((x + 0.4) ** 2 + y * y));
    return 0.4 - 0.5 * x * x - 0.3 * y * y + hill - hollow;
  },
};
/** A light that is neither built in nor natural. */
const OWN_LIGHT = [
  ...[-1.1, 0.3, -0.5, 0.4, 0.05, 0.1, 0.1, -0.1, 0.05],
  ...[-1.2, -0.4, -0.45, 0.1, -0.1, 0.05, -0.05, 0.12, 0.1],
  ...[-1.0, 0.1, -0.6, -0.45, 0.1, -0.1, 0.05, 0.1, -0.1],
];

const lightOf = (light) => (light === "own" ? OWN_LIGHT : light);

function sampled(request, { sample }) {
  const { surface, light, ...rest } = request;
  const complete = { surface: RELIEFS[surface] ? relief(RELIEFS[surface]) : surface, light: lightOf(light), ...rest };
  return { ...sample(complete), request: complete };
}

function metric({ light, ...request }, { sample }) {
  // The package gives the coefficients of its lights.
  const numbers = sample({ surface: "bust", light: lightOf(light), size: 16 }).light;
  return metricPair(request, numbers);
}

/** IEC 61966-2-1, from linear intensity to stored value; both 0 .. 1. */
const toSrgb = (value) => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);

/** RGBA integers of the given type, with the brightest pixel just below saturation. */
function integers({ data, mask, ...image }, Type, most, transfer, encode) {
  const brightest = data.reduce((high, value) => Math.max(high, value), 0);
  const rgba = new Type(4 * image.width * image.height);
  for (let index = 0; index < image.width * image.height; index++) {
    for (let channel = 0; channel < 3; channel++) {
      rgba[4 * index + channel] = Math.round(0.96 * most * encode(data[3 * index + channel] / brightest));
    }
    rgba[4 * index + 3] = most;
  }
  return { ...image, mask, data: rgba, ...(transfer ? { transfer } : {}) };
}

/** The image as a camera stores it if the exposure is set for the object. The surroundings are grey. */
function photographed({ data, mask, ...image }, quality) {
  const [exposure, wall] = [0.9 / data.reduce((high, value) => Math.max(high, value), 0), 0.2];
  const levels = data.map((value, index) => (mask[Math.floor(index / 3)] ? value * exposure : wall));
  return { ...image, mask, data: throughJpeg({ ...image, data: levels }, quality) };
}

/** The object in front of a wall of another colour, without saturation. */
function beforeWall({ data, mask, ...image }) {
  const brightest = data.reduce((high, value) => Math.max(high, value), 0);
  const wall = [0.5, 0.45, 0.4].map((share) => share * brightest);
  return { ...image, mask, data: data.map((value, index) => (mask[Math.floor(index / 3)] ? value : wall[index % 3])) };
}

/** Adds varying albedo in patches or stripes, which a seed determines. */
const painted = ({ data, ...image }, { seed, stripes = false }) => {
  const colours = data.slice();
  paint(colours, image.width, chance(seed), stripes);
  return { ...image, data: colours };
};

const same = (value) => value;
const COLOURS = {
  "JPEG of quality 85": (image) => photographed(image, 85),
  "JPEG of quality 60": (image) => photographed(image, 60),
  "before a wall": beforeWall,
  "8 bit, sRGB": (image) => integers(image, Uint8Array, 255, undefined, toSrgb),
  "8 bit, linear": (image) => integers(image, Uint8ClampedArray, 255, "linear", same),
  "8 bit clamped, sRGB": (image) => integers(image, Uint8ClampedArray, 255, "srgb", toSrgb),
  "16 bit, guessed": (image) => integers(image, Uint16Array, 65535, undefined, same),
  "16 bit, linear": (image) => integers(image, Uint16Array, 65535, "linear", same),
  "16 bit, sRGB": (image) => integers(image, Uint16Array, 65535, "srgb", toSrgb),
  grey: (image) => ({ ...image, data: new Float32Array(image.data.length).fill(0.5) }),
};

/** Stored units per unit of the depth map; the default unit is left out. */
function quantised({ data, ...depth }, unit, isDefault) {
  const stored = Uint16Array.from(data, (value) => (value > 0 ? Math.round(value / unit) : 0));
  return { ...depth, data: stored, ...(isDefault ? {} : { unit }) };
}

/** The orthographic map as an organised cloud. */
function cloud({ data, ...depth }) {
  const points = new Float32Array(3 * data.length);
  for (const [index, value] of data.entries()) {
    const [column, row] = [index % depth.width, Math.floor(index / depth.width)];
    points.set(
      Number.isNaN(value) ? [NaN, NaN, NaN] : [column - (depth.width - 1) / 2, row - (depth.height - 1) / 2, value],
      3 * index,
    );
  }
  return { ...depth, points };
}

/** Some pixels float behind the surface, as they do at depth discontinuities. */
function flying(depth, seed = 5) {
  const dice = chance(seed);
  const share = 0.03;
  return {
    ...depth,
    data: depth.data.map((value) => (dice.uniform() < share ? value + dice.uniform(0.1, 0.3) * depth.width : value)),
  };
}

/** Misstates the unit: lengths become `factor` times too long. */
const misread = (depth, factor) => ({ ...depth, unit: factor * (depth.unit ?? 1) });

/** Inverts the relief: near becomes far. */
function hollow({ data, ...depth }) {
  const middle = median(data.filter((value) => value > 0));
  return { ...depth, data: data.map((value) => 2 * middle - value) };
}

/** A wall behind the object, at a distance of the object's width. */
function wall({ data, mask: _, ...depth }) {
  const seen = data.filter((value) => value > 0);
  const pixel = depth.camera ? median(seen) / depth.camera.fx : 1;
  const behind = median(seen) + 0.5 * depth.width * pixel;
  return { ...depth, data: data.map((value) => (value > 0 ? value : behind)) };
}

const without =
  (key) =>
  ({ [key]: _, ...rest }) =>
    rest;

/** The changes to the depth view that scenes name; they are applied in the given order. */
const DEPTHS = {
  "16 bit, 1/200 pixel": (depth) => quantised(depth, 1 / 200, false),
  "16 bit, quarter pixels": (depth) => quantised(depth, 1 / 4, false),
  "16 bit, millimetres": (depth) => quantised(depth, 0.001, true),
  "16 bit, 0.2 mm": (depth) => quantised(depth, 0.0002, false),
  "float, half pixels": (depth) => ({ ...depth, data: depth.data.map((value) => 2 * value), unit: 0.5 }),
  "with given normals": (depth, made) => ({ ...depth, normals: made.truth.depthNormals }),
  "as a cloud": cloud,
  "without normals": without("normals"),
  "without mask": without("mask"),
  "flying pixels": (depth) => flying(depth),
  "unit ten times too long": (depth) => misread(depth, 10),
  "unit twice too long": (depth) => misread(depth, 2),
  "unit half as long": (depth) => misread(depth, 0.5),
  hollow,
  "before a wall, without mask": wall,
};

/** Axis of the rotation between an initial pose and the truth; not an axis of symmetry. */
const AWAY = [0.48, 0.6, 0.64];

/** The initial pose of a scene, `off` degrees from the truth about the surface's middle or about the depth camera. */
function startOf({ off, about = "middle", members = ["scale", "rotation", "translation"] }, { pose, middle }) {
  const rotation = product(aboutAxis(AWAY, off), pose.rotation);
  const stays = [0, 0, about === "middle" ? middle : 0];
  const [before, after] = [pose.rotation, rotation].map((matrix) => turn(matrix, stays));
  const translation = pose.translation.map((value, axis) => value + pose.scale * (before[axis] - after[axis]));
  const all = { scale: pose.scale, rotation, translation, angles: anglesOf(rotation) };
  return Object.fromEntries(members.map((member) => [member, all[member]]));
}

/** Median depth of a rendered view. */
function middleOf({ data, points }) {
  const depths = (data ?? points.filter((_, index) => index % 3 === 2)).filter((depth) => depth > 0).sort();
  return depths[Math.floor(depths.length / 2)];
}

/** The pair of a scene, rendered by a package; `request` is what was passed to `sample`, `middle` the depth of the surface's middle. */
export function pairOf({ sample, metric: body, albedo, colours, depths = [], maskless = false }, api) {
  const made = body ? metric(body, api) : sampled(sample, api);
  const bare = albedo ? painted(made.image, albedo) : made.image;
  const image = colours ? COLOURS[colours](bare) : bare;
  return {
    ...made,
    middle: middleOf(made.depth),
    image: maskless ? without("mask")(image) : image,
    depth: depths.reduce((depth, change) => DEPTHS[change](depth, made), made.depth),
  };
}

/** Options as the estimator takes them; known values come from the pair. */
export function optionsOf({ light, start, ...rest }, made) {
  return {
    ...rest,
    ...(light === undefined ? {} : { light: light === "known" ? made.light : light }),
    ...(start === undefined ? {} : { start: typeof start === "string" ? start : startOf(start, made) }),
  };
}
