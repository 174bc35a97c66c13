// Explains terms of the method on one rendered bust: occluding contour, depth discontinuity, tile, local contrast.
import { aboutY, product, turn } from "../../protocols/rotations.mjs";
import { lookUp } from "../thresholds.mjs";
import { boxAround, byteOf, indices, median, picture, tint, triple } from "./raster.mjs";
import { BLUE, GREEN, INK, ORANGE, SOFT, figure, key, line, placed, strokes, text } from "./svg.mjs";
import { fallsOn, jumps, moved, neighbours, pixelAt, pointOf, sideOf } from "./views.mjs";

const SIZE = 160;
const BETA = 40;
/** Varying albedo of the bust: the log albedo (R, G, B) of the darkest spots, and the wavelengths across and down in pixels. */
const STAIN = [-0.12, -0.3, -0.4];
const WAVES = [52, 64];
const TURNED = Number(lookUp("TURNED", "src/view/limbs.rs").value);
const TILE = Number(lookUp("TILE", "src/pose/photometric/covariance.rs").value);
/** Smallest difference of neighbouring depths that counts as a discontinuity, in pixels. */
const JUMP = 8;
/** Sigma of the Gaussian window for local contrast (depth pixels), and the rotation between the true and the wrong pose (degrees). */
const WINDOW = 5;
const BESIDE = 15;

/** The darkness of the albedo at a pixel, from 0 to 1. */
function stained({ width }, index) {
  const [x, y] = [index % width, Math.floor(index / width)].map((at, axis) => (2 * Math.PI * at) / WAVES[axis]);
  return (1 + Math.sin(x + Math.sin(y)) * Math.sin(y)) / 2;
}

function scene(api) {
  const made = api.sample({ surface: "bust", light: "window", size: SIZE, angles: { beta: BETA }, noise: 0.01 });
  const data = made.image.data.map((value, at) => {
    const index = Math.floor(at / 3);
    return value * Math.exp(STAIN[at % 3] * stained(made.image, index));
  });
  return { ...made, image: { ...made.image, data } };
}

/** Borders of pixels at depth discontinuities: `turned` where the surface bends away from the camera, `cut` elsewhere. */
function contours({ image, truth }) {
  const found = { turned: [], cut: [] };
  for (const index of indices(image, (index) => Number.isFinite(truth.imageDepth[index])))
    for (const { index: beside, direction } of neighbours(image, index)) {
      const step = truth.imageDepth[beside] - truth.imageDepth[index];
      if (step <= JUMP) continue;
      const [x, y] = triple(truth.imageNormals, index);
      const isTurned = x * direction[0] + y * direction[1] > TURNED;
      found[isTurned ? "turned" : "cut"].push(sideOf(image, index, direction));
    }
  return found;
}

/**
 * For each depth pixel, the log intensity of the image at its projection, and the log shading that its normal predicts. Both are NaN where
 * the image does not show the pixel.
 */
function compared(api, { image, depth, light, truth }, pose) {
  const normals = Float32Array.from({ length: 3 * SIZE * SIZE }, () => 0);
  for (let index = 0; index < SIZE * SIZE; index++)
    normals.set(turn(pose.rotation, triple(truth.depthNormals, index)), 3 * index);
  const shading = api.shadeNormals(light, normals);
  const nearest = new Float32Array(SIZE * SIZE).fill(Infinity);
  const points = Array.from({ length: SIZE * SIZE }, (_, index) => moved(pose, pointOf(depth, truth.depth, index)));
  for (const point of points) {
    const at = pixelAt(image, point);
    if (at >= 0 && point[2] < nearest[at]) nearest[at] = point[2];
  }
  const logs = image.data.map(Math.log);
  const mean = (values, at) => (values[3 * at] + values[3 * at + 1] + values[3 * at + 2]) / 3;
  const [seen, predicted] = [new Float32Array(SIZE * SIZE).fill(NaN), new Float32Array(SIZE * SIZE).fill(NaN)];
  points.forEach((point, index) => {
    const at = pixelAt(image, point);
    if (at < 0 || !image.mask[at] || normals[3 * index + 2] > -0.15 || point[2] > nearest[at] + 4) return;
    seen[index] = mean(logs, at);
    predicted[index] = mean(shading, index);
  });
  return { seen, predicted };
}

/** Values minus their mean within a Gaussian window. */
function normalised({ width, height }, values) {
  const reach = 2 * WINDOW;
  return Float32Array.from(values, (value, index) => {
    if (!Number.isFinite(value)) return NaN;
    let [sum, weights] = [0, 0];
    for (let v = -reach; v <= reach; v++)
      for (let u = -reach; u <= reach; u++) {
        const [column, row] = [(index % width) + u, Math.floor(index / width) + v];
        const other = values[row * width + column];
        if (column < 0 || row < 0 || column >= width || row >= height || !Number.isFinite(other)) continue;
        const weight = Math.exp(-(u * u + v * v) / (2 * WINDOW * WINDOW));
        [sum, weights] = [sum + weight * other, weights + weight];
      }
    return value - sum / weights;
  });
}

const spread = (values) => {
  const finite = values.filter(Number.isFinite);
  const middle = median([...finite]);
  return 1.4826 * median([...finite].map((value) => Math.abs(value - middle)));
};

/** The logarithm of the ratio of two spreads: that of the local contrast, and that of its difference from the predicted shading. */
function gain(size, { seen, predicted }) {
  const [contrast, shading] = [seen, predicted].map((values) => normalised(size, values));
  const left = contrast.map((value, at) => value - shading[at]);
  return Math.log(spread(contrast) / spread(left));
}

/** The true pose, rotated about the middle of the object. */
function turnedPose({ pose, depth, truth }) {
  const points = indices(depth, (index) => Number.isFinite(truth.depth[index])).map((index) =>
    moved(pose, pointOf(depth, truth.depth, index)),
  );
  const middle = [0, 1, 2].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
  const rotation = aboutY(BESIDE);
  const shifted = pose.translation.map((value, axis) => value - middle[axis]);
  return {
    ...pose,
    rotation: product(rotation, pose.rotation),
    translation: turn(rotation, shifted).map((value, axis) => value + middle[axis]),
  };
}

const hexOf = (colour) => [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
/** Colours negative values blue and positive values orange. */
const signed = (value, range) =>
  Number.isFinite(value) ? tint(Math.abs(value) / range, hexOf(value < 0 ? BLUE : ORANGE)) : undefined;

/** The lines between tiles inside a box, and a frame around one tile. */
function tiles(box, [column, row]) {
  const grid = [];
  for (let x = Math.ceil(box.left / TILE) * TILE; x <= box.left + box.width; x += TILE)
    grid.push([x, box.top, x, box.top + box.height]);
  for (let y = Math.ceil(box.top / TILE) * TILE; y <= box.top + box.height; y += TILE)
    grid.push([box.left, y, box.left + box.width, y]);
  const [x, y] = [column * TILE, row * TILE];
  return [
    strokes(grid, "#8c959f", 0.25),
    `<rect x="${x}" y="${y}" width="${TILE}" height="${TILE}" fill="none" stroke="${INK}" stroke-width="1.2"/>`,
  ];
}

/** The tile whose residuals have the largest absolute sum. */
function strongest({ width }, residuals) {
  const sums = new Map();
  for (const index of indices({ width, height: width }, (index) => Number.isFinite(residuals[index]))) {
    const tile = `${Math.floor((index % width) / TILE)} ${Math.floor(index / width / TILE)}`;
    sums.set(tile, (sums.get(tile) ?? 0) + residuals[index]);
  }
  const [best] = [...sums].reduce((a, b) => (Math.abs(b[1]) > Math.abs(a[1]) ? b : a));
  return best.split(" ").map(Number);
}

const tall = (box, height) => (height * box.width) / box.height;
const titled = (x, y, words) => text(x, y, words, { size: 15, bold: true });

function contourPanel(made) {
  const { image } = made;
  const box = boxAround(image, (index) => image.mask[index]);
  const brightest = image.data.reduce((a, b) => Math.max(a, b), 0);
  const coloured = (index) =>
    image.mask[index] ? triple(image.data, index).map((value) => byteOf(value / brightest)) : undefined;
  const { turned, cut } = contours(made);
  return [
    titled(20, 26, "Occluding contour (image)"),
    placed(picture(image, box, coloured), 80, 38, tall(box, 200), [
      strokes(cut, BLUE, 1),
      strokes(turned, ORANGE, 1.4),
    ]),
    key(20, 262, ORANGE, "the surface turns away from the camera"),
    key(20, 281, BLUE, "border where it does not (shoulders)"),
  ];
}

function discontinuityPanel({ depth, truth }, box) {
  const depths = truth.depth.filter(Number.isFinite);
  const [near, far] = [depths.reduce((a, b) => Math.min(a, b)), depths.reduce((a, b) => Math.max(a, b))];
  const byDepth = (index) => {
    const share = (truth.depth[index] - near) / (far - near);
    return Number.isFinite(share) ? Array(3).fill(240 - 190 * share) : undefined;
  };
  const { ahead, ofNothing } = jumps(depth, truth.depth, JUMP);
  return [
    titled(370, 26, "Depth discontinuity (depth map)"),
    placed(picture(depth, box, byDepth), 440, 38, tall(box, 200), [
      strokes(ofNothing, GREEN, 1),
      strokes(ahead, ORANGE, 1.6),
    ]),
    key(370, 262, ORANGE, "a near surface ends in front of a farther one"),
    key(370, 281, GREEN, "it ends in front of nothing"),
  ];
}

function tilePanel({ depth }, box, { seen, predicted }) {
  const differences = seen.map((value, at) => value - predicted[at]);
  const offset = median([...differences.filter(Number.isFinite)]);
  const residuals = differences.map((value) => value - offset);
  const coloured = picture(depth, box, (index) => signed(residuals[index], 0.35));
  return [
    titled(20, 330, "Tiles of the covariance (residuals)"),
    placed(coloured, 80, 342, tall(box, 200), tiles(box, strongest(depth, residuals))),
    text(250, 380, ["orange: image", "brighter than", "the prediction;", "blue: darker"], { colour: SOFT }),
    text(20, 566, [
      `Residuals in a tile of ${TILE}x${TILE} depth pixels`,
      "add up to one score. Noise cancels;",
      "varying albedo does not (thick frame):",
      "it shows as spatial covariance.",
    ]),
  ];
}

function contrastPanel(api, made, box, right) {
  const { depth } = made;
  const level = median([...right.seen].filter(Number.isFinite));
  const contrast = normalised(depth, right.seen);
  const coloured = (values, range) => picture(depth, box, (index) => signed(values[index], range));
  const [x, y] = fallsOn(depth, [0, 0]);
  const circle = `<circle cx="${x}" cy="${y}" r="${2 * WINDOW}" fill="none" stroke="${INK}" stroke-width="1"/>`;
  const [here, beside] = [right, compared(api, made, turnedPose(made))].map((pair) => gain(depth, pair).toFixed(2));
  const centred = right.seen.map((value) => value - level);
  return [
    titled(370, 330, "Local contrast and its gain"),
    placed(coloured(centred, 0.6), 370, 342, tall(box, 150)),
    placed(coloured(contrast, 0.3), 530, 342, tall(box, 150), [circle]),
    text(370, 512, "log intensity v", { colour: SOFT }),
    text(530, 512, "v minus its local mean", { colour: SOFT }),
    text(370, 547, [
      "Circle: two sigmas of the window. Gain: ln of",
      "the spread of the right picture over the part",
      `that shading leaves: ${here} at the true pose,`,
      `${beside} at a pose ${BESIDE} degrees beside it.`,
    ]),
  ];
}

export function terms(api) {
  const made = scene(api);
  const box = boxAround(made.depth, (index) => Number.isFinite(made.truth.depth[index]));
  const right = compared(api, made, made.pose);
  return figure(
    700,
    640,
    "Four panels on a rendered bust: its occluding contour in the image, discontinuities of its depth map, tiles of the residuals, local contrast",
    [
      ...contourPanel(made),
      ...discontinuityPanel(made, box),
      line(20, 302, 680, 302, { colour: "#d0d7de" }),
      ...tilePanel(made, box, right),
      ...contrastPanel(api, made, box, right),
    ],
  );
}
