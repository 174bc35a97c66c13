// Costs that other people's tools minimise, as functions of a pose over whole frames, implemented from their papers for comparison.
//
// Normalised information distance: Koide, Oishi, Yokozuka, Banno, "General, single-shot, target-less, and automatic LiDAR-camera
// extrinsic calibration toolbox", ICRA 2023, section III-E: NID = (2 H(L, I) - H(L) - H(I)) / H(L, I) over points that the camera sees,
// with L a point's intensity and I the image's, both equalised, in 16 levels each. Files of depth cameras hold no intensity; the
// cosine between normal and ray replaces it, which is the shading by a lamp at the depth camera.
// Edge alignment: distances of projected depth edges to the image's edges, as in Levinson and Thrun, "Automatic online
// calibration of cameras and lasers", RSS 2013, here with Canny's edges (1986) and a distance transform.
import { moved } from "../rigs/draws.mjs";
import { project } from "./lens.mjs";

const LEVELS = 16;
/** A point is hidden if it is farther than the nearest point in its cell by more than this, in metres and as a share of its depth. */
const HIDDEN = { metres: 0.015, share: 0.02 };
/** Side of a cell, pixels, above the spacing of points on one surface. */
const CELL = 3;
/** Pixels to each side over which a normal's differences are taken, above the steps of a quantised map. */
const REACH = 3;
/** Canny's blur in pixels, and MATLAB's share of pixels below the upper threshold and ratio of the lower to the upper threshold. */
const CANNY = { blur: 1.4, below: 0.7, ratio: 0.4 };
/** Largest distance that is counted, in pixels. An edge farther away belongs to another object. */
const FARTHEST = 20;

const point = (points, index) => [points[3 * index], points[3 * index + 1], points[3 * index + 2]];
const clear = (depth) => Math.max(HIDDEN.metres, HIDDEN.share * depth);

/** Ranks of values divided by their number, 0 .. 1; NaN stays NaN. */
function equalised(values) {
  const order = [...values.keys()]
    .filter((index) => !Number.isNaN(values[index]))
    .sort((a, b) => values[a] - values[b]);
  const ranks = new Float32Array(values.length).fill(NaN);
  for (let first = 0; first < order.length; ) {
    let end = first;
    while (end < order.length && values[order[end]] === values[order[first]]) end++;
    for (let k = first; k < end; k++) ranks[order[k]] = (first + end - 1) / 2 / order.length;
    first = end;
  }
  return ranks;
}

/** Ranks of an image's greys; black pixels, which the image's authors cut out, get the lowest level and do not take up most ranks. */
const levelsOf = (light) =>
  equalised(light.map((value) => (value > 0 ? value : NaN))).map((rank) => (Number.isNaN(rank) ? 0 : rank));

const grey = ({ width, height, data }) => {
  const step = data.BYTES_PER_ELEMENT === 1 ? 255 : 65535;
  return Float32Array.from(
    { length: width * height },
    (_, k) => (0.299 * data[4 * k] + 0.587 * data[4 * k + 1] + 0.114 * data[4 * k + 2]) / step,
  );
};

/** Cosine between normal and ray of each point, with the depth camera at `eye`. */
export function shading(points, { width, height }, eye) {
  const values = new Float32Array(width * height).fill(NaN);
  for (let row = REACH; row < height - REACH; row++) {
    for (let column = REACH; column < width - REACH; column++) {
      const at = row * width + column;
      const [left, right, above, below] = [at - REACH, at + REACH, at - REACH * width, at + REACH * width].map((k) =>
        point(points, k),
      );
      const a = right.map((value, k) => value - left[k]);
      const b = below.map((value, k) => value - above[k]);
      const n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const ray = point(points, at).map((value, k) => value - eye[k]);
      values[at] = Math.abs(n[0] * ray[0] + n[1] * ray[1] + n[2] * ray[2]) / (Math.hypot(...n) * Math.hypot(...ray));
    }
  }
  return values;
}

/** Column, row and depth of each point; NaN if it is missing, outside the image or hidden by another point. */
function seen({ points, image }, pose) {
  const { width, height, camera } = image;
  const places = new Float32Array(points.length).fill(NaN);
  const columns = Math.ceil(width / CELL);
  const nearest = new Float32Array(columns * Math.ceil(height / CELL)).fill(Infinity);
  const cell = (at) => Math.floor(places[at + 1] / CELL) * columns + Math.floor(places[at] / CELL);
  for (let at = 0; at < points.length; at += 3) {
    const p = moved(pose, [points[at], points[at + 1], points[at + 2]]);
    if (!(p[2] > 0)) continue;
    const [column, row] = project(camera, p);
    if (!(column >= 0 && row >= 0 && column <= width - 1 && row <= height - 1)) continue;
    places.set([column, row, p[2]], at);
    nearest[cell(at)] = Math.min(nearest[cell(at)], p[2]);
  }
  for (let at = 0; at < places.length; at += 3) {
    const near = nearest[cell(at)];
    if (places[at + 2] > near + clear(near)) places.fill(NaN, at, at + 3);
  }
  return places;
}

const entropy = (counts, total) =>
  -counts.reduce((sum, count) => (count > 0 ? sum + (count / total) * Math.log(count / total) : sum), 0);
const level = (rank) => Math.min(LEVELS - 1, Math.floor(rank * LEVELS));

function informationDistance(places, levels, image, { width }) {
  const joint = new Array(LEVELS * LEVELS).fill(0);
  let total = 0;
  for (let index = 0; index < levels.length; index++) {
    const column = places[3 * index];
    if (Number.isNaN(column) || Number.isNaN(levels[index])) continue;
    joint[
      LEVELS * level(levels[index]) + level(image[Math.round(places[3 * index + 1]) * width + Math.round(column)])
    ]++;
    total++;
  }
  const sums = (of) =>
    Array.from({ length: LEVELS }, (_, k) => joint.reduce((sum, count, at) => (of(at) === k ? sum + count : sum), 0));
  const [depth, light, both] = [sums((at) => Math.floor(at / LEVELS)), sums((at) => at % LEVELS), joint].map((counts) =>
    entropy(counts, total),
  );
  return (2 * both - depth - light) / both;
}

/** Points at a depth discontinuity: one of the adjacent pixels is clearly farther. */
function depthEdges(points, { width, height }, eye) {
  const distance = (index) => Math.hypot(...point(points, index).map((value, k) => value - eye[k]));
  const found = [];
  for (let row = 1; row < height - 1; row++) {
    for (let column = 1; column < width - 1; column++) {
      const at = row * width + column;
      const here = distance(at);
      if ([at - 1, at + 1, at - width, at + width].some((next) => distance(next) > here + 2 * clear(here)))
        found.push(at);
    }
  }
  return found;
}

function blurred(values, { width, height }, sigma) {
  const reach = Math.ceil(3 * sigma);
  const weights = Array.from({ length: 2 * reach + 1 }, (_, k) => Math.exp(-0.5 * ((k - reach) / sigma) ** 2));
  const total = weights.reduce((sum, weight) => sum + weight, 0);
  const along = (from, count, stride, index, at) =>
    weights.reduce(
      (sum, weight, k) =>
        sum + weight * from[at + (Math.min(count - 1, Math.max(0, index + k - reach)) - index) * stride],
      0,
    ) / total;
  const rows = values.map((_, at) => along(values, width, 1, at % width, at));
  return rows.map((_, at) => along(rows, height, width, Math.floor(at / width), at));
}

/** Canny's edges of a grey image, as a mask. */
function canny(values, { width, height }) {
  const smooth = blurred(values, { width, height }, CANNY.blur);
  const strength = new Float32Array(values.length);
  const thin = new Float32Array(values.length);
  const slope = (at) => [smooth[at + 1] - smooth[at - 1], smooth[at + width] - smooth[at - width]];
  const inside = [...values.keys()].filter(
    (at) => at % width > 1 && at % width < width - 2 && at >= 2 * width && at < values.length - 2 * width,
  );
  for (const at of inside) strength[at] = Math.hypot(...slope(at));
  for (const at of inside) {
    const [x, y] = slope(at);
    const step = Math.round(x / (Math.hypot(x, y) || 1)) + width * Math.round(y / (Math.hypot(x, y) || 1));
    if (strength[at] >= strength[at - step] && strength[at] > strength[at + step]) thin[at] = strength[at];
  }
  const high = inside.map((at) => strength[at]).sort((a, b) => a - b)[Math.floor(CANNY.below * inside.length)];
  const edges = new Uint8Array(values.length);
  const reached = inside.filter((at) => thin[at] > high);
  while (reached.length > 0) {
    const at = reached.pop();
    if (edges[at]) continue;
    edges[at] = 1;
    for (const step of [1, -1, width, -width, width + 1, width - 1, -width + 1, -width - 1]) {
      if (!edges[at + step] && thin[at + step] > CANNY.ratio * high) reached.push(at + step);
    }
  }
  return edges;
}

/** Distance of each pixel to the next edge in steps along rows, columns and diagonals (Borgefors 1986). */
function distances(edges, { width, height }) {
  const far = Float32Array.from(edges, (edge) => (edge ? 0 : FARTHEST));
  const steps = [
    [-1, 0, 1],
    [0, -1, 1],
    [-1, -1, Math.SQRT2],
    [1, -1, Math.SQRT2],
  ];
  const pass = (at, sign) => {
    for (const [right, down, length] of steps) {
      const [column, row] = [(at % width) + sign * right, Math.floor(at / width) + sign * down];
      if (column >= 0 && row >= 0 && column < width && row < height)
        far[at] = Math.min(far[at], far[row * width + column] + length);
    }
  };
  for (let at = 0; at < far.length; at++) pass(at, 1);
  for (let at = far.length - 1; at >= 0; at--) pass(at, -1);
  return far;
}

/** Costs of poses for one frame whose depth camera is at `motion` in the frame of its cloud; lower is better. */
export function costs({ image, grid, points, intensity }, motion) {
  const eye = motion.translation;
  const light = grey(image);
  const equal = levelsOf(light);
  const levels = equalised(intensity ?? shading(points, grid, eye));
  const edges = depthEdges(points, grid, eye);
  const far = distances(canny(light, image), image);
  const towards = (pose) => {
    const total = edges.reduce((sum, index) => {
      const p = moved(pose, point(points, index));
      const [column, row] = p[2] > 0 ? project(image.camera, p).map(Math.round) : [-1, -1];
      const inside = column >= 0 && row >= 0 && column < image.width && row < image.height;
      return sum + (inside ? far[row * image.width + column] : FARTHEST);
    }, 0);
    return total / edges.length;
  };
  return {
    information: (pose) => informationDistance(seen({ points, image }, pose), levels, equal, image),
    edges: towards,
    /** Share of depth edges that lie within two pixels of an image edge. */
    near: (pose, camera = image.camera) => {
      const on = edges.filter((index) => {
        const [column, row] = project(camera, moved(pose, point(points, index))).map(Math.round);
        return (
          column >= 0 && row >= 0 && column < image.width && row < image.height && far[row * image.width + column] <= 2
        );
      });
      return on.length / edges.length;
    },
  };
}
