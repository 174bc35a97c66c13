// Pairs in metres: an analytic body seen by pinhole cameras, which `sample` does not offer. Each pixel's ray is intersected with the
// body's surface, so nothing is resampled and the pose is known.
import { IDENTITY, aboutAxis, transpose, turn } from "../../protocols/rotations.mjs";
import { chance } from "../../protocols/numbers.mjs";

/** Half axes of the body and its distance from each camera, metres. */
const HALF_AXES = [0.1, 0.12, 0.1];
const DISTANCE = 0.8;
/** Rays are searched over this range before and behind the body's middle (metres), in this many strides. */
const REACH = 0.18;
const STRIDES = 60;
/** Number of bisections of a stride, enough for the precision of a double. */
const BISECTIONS = 50;
/** Step of the central differences for normals, half axes. */
const STEP = 1e-5;
/** Rounds of the fixed-point iteration that removes a mild lens's distortion; each gains two digits. */
const UNDISTORTIONS = 30;
/** Middle, height and sharpness of the body's bumps, half axes. No two sides of the body are alike. */
const BUMPS = [
  { at: [0.35, -0.4, -0.8], height: 0.5, sharpness: 9 },
  { at: [-0.5, 0.1, -0.75], height: -0.35, sharpness: 12 },
  { at: [-0.1, 0.6, -0.7], height: 0.4, sharpness: 14 },
  { at: [0.7, 0.35, -0.3], height: 0.45, sharpness: 8 },
  { at: [-0.75, -0.5, -0.1], height: 0.4, sharpness: 7 },
];

/** Positive outside the body, negative inside; the point is in half axes. */
function outside([x, y, z]) {
  let value = x * x + y * y + z * z - 1 + 0.15 * x * y - 0.1 * x * x * x;
  for (const { at, height, sharpness } of BUMPS) {
    const [a, b, c] = [x - at[0], y - at[1], z - at[2]];
    const spread = 1 + sharpness * (a * a + b * b + c * c);
    value -= height / (spread * spread);
  }
  return value;
}

const inHalfAxes = (point) => point.map((value, axis) => value / HALF_AXES[axis]);

/** The unit normal that faces outward. */
function normalAt(point) {
  const middle = inHalfAxes(point);
  const gradient = HALF_AXES.map((length, axis) => {
    const [before, after] = [-STEP, STEP].map((step) =>
      outside(middle.map((value, each) => (each === axis ? value + step : value))),
    );
    return (after - before) / length;
  });
  const length = Math.sqrt(gradient.reduce((sum, part) => sum + part * part, 0));
  return gradient.map((part) => part / length);
}

/** Distance along the ray to the body's surface, or undefined. */
function hit(origin, direction) {
  const at = (along) => outside(inHalfAxes(origin.map((value, axis) => value + along * direction[axis])));
  let near = DISTANCE - REACH;
  for (let stride = 1; stride <= STRIDES; stride++) {
    let far = DISTANCE - REACH + (2 * REACH * stride) / STRIDES;
    if (at(far) > 0) {
      near = far;
      continue;
    }
    for (let turns = 0; turns < BISECTIONS; turns++) {
      const middle = (near + far) / 2;
      if (at(middle) > 0) near = middle;
      else far = middle;
    }
    return far;
  }
  return undefined;
}

/** Brown's distortion k1 k2 p1 p2 k3 of a normalised image point. */
function distort([x, y], [k1, k2, p1, p2, k3]) {
  const r = x * x + y * y;
  const radial = 1 + r * (k1 + r * (k2 + r * k3));
  return [x * radial + 2 * p1 * x * y + p2 * (r + 2 * x * x), y * radial + p1 * (r + 2 * y * y) + 2 * p2 * x * y];
}

function undistort(seen, distortion) {
  let point = seen;
  for (let turns = 0; turns < UNDISTORTIONS; turns++) {
    const off = distort(point, distortion);
    point = point.map((value, axis) => value + seen[axis] - off[axis]);
  }
  return point;
}

/** Origin and direction (with z = 1) of a pixel's ray in the camera's frame; without a camera, rays are parallel. */
function ray({ camera, metresPerPixel, width, height }, column, row) {
  if (!camera) {
    return [
      [(column - (width - 1) / 2) * metresPerPixel, (row - (height - 1) / 2) * metresPerPixel, 0],
      [0, 0, 1],
    ];
  }
  const { fx, fy, cx, cy, distortion = [0, 0, 0, 0, 0] } = camera;
  return [
    [0, 0, 0],
    [...undistort([(column - cx) / fx, (row - cy) / fy], distortion), 1],
  ];
}

/** Depth and normal of each pixel that sees the body, turned by `rotation` about its middle, in the camera's frame. */
function look(view, rotation) {
  const pixels = new Array(view.width * view.height);
  const back = transpose(rotation);
  for (let index = 0; index < pixels.length; index++) {
    const [origin, direction] = ray(view, index % view.width, Math.floor(index / view.width));
    const start = turn(back, [origin[0], origin[1], origin[2] - DISTANCE]);
    const way = turn(back, direction);
    const along = hit(start, way);
    if (along === undefined) continue;
    const normal = normalAt(start.map((value, axis) => value + along * way[axis]));
    pixels[index] = { depth: along, normal: turn(rotation, normal) };
  }
  return pixels;
}

/** Log intensities of three channels by the image model (Eq. 3, 5), with its harmonics written out. */
function shade(light, [x, y, z]) {
  const [c1, c2, c3, c4, c5] = [0.429043, 0.511664, 0.743125, 0.886227, 0.247708];
  const linear = [2 * c2 * y, 2 * c2 * z, 2 * c2 * x];
  const square = [2 * c1 * x * y, 2 * c1 * y * z, c3 * z * z - c5, 2 * c1 * x * z, c1 * (x * x - y * y)];
  const basis = [c4, ...linear, ...square];
  return [0, 9, 18].map((first) => basis.reduce((sum, value, index) => sum + value * light[first + index], 0));
}

const maskOf = (pixels) => Uint8Array.from(pixels, (pixel) => (pixel ? 1 : 0));

/**
 * `image` and `depth` are views ({ width, height, camera } or, for an image without a camera, { metresPerPixel }); the body is
 * turned by `degrees` about `axis` from the depth camera's view to the image's. Noise is that of log S, and of depth in metres.
 */
export function metricPair({ image, depth, axis, degrees, noise = 0, depthNoise = 0, seed = 1 }, light) {
  const dice = chance(seed);
  const rotation = aboutAxis(axis, degrees);
  const seen = look(image, IDENTITY);
  const measured = look(depth, transpose(rotation));
  const colours = new Float32Array(3 * seen.length);
  for (const [index, pixel] of seen.entries()) {
    if (!pixel) continue;
    colours.set(
      shade(light, pixel.normal).map((value) => Math.exp(value + noise * dice.gaussian())),
      3 * index,
    );
  }
  const depths = Float32Array.from(measured, (pixel) => (pixel ? pixel.depth + depthNoise * dice.gaussian() : NaN));
  const scale = image.camera ? 1 : 1 / image.metresPerPixel;
  const middle = [0, 0, DISTANCE];
  const translation = turn(rotation, middle).map((value, part) => scale * (middle[part] - value));
  const base = ({ width, height, camera }) => ({ width, height, ...(camera ? { camera } : {}) });
  return {
    image: { ...base(image), data: colours, mask: maskOf(seen) },
    depth: { ...base(depth), data: depths, mask: maskOf(measured) },
    light,
    pose: { scale, rotation, translation },
  };
}
