// The inputs of a run and the result of each stage, on one rendered bust.
import { IDENTITY } from "../../protocols/rotations.mjs";
import { withRun } from "../../protocols/runs.mjs";
import { boxAround, byteOf, clamped, grey, median, normalColour, picture, tint, triple } from "./raster.mjs";
import { BLUE, SOFT, figure, placed, text } from "./svg.mjs";
import { fallsOn, lit, moved, normalsOf, pointOf } from "./views.mjs";

const SIZE = 144;
const SCENE = {
  surface: "bust",
  light: "window",
  size: SIZE,
  angles: { beta: 35 },
  noise: 0.01,
  depthNoise: 0.2,
  holes: 0.02,
};
/** Number of points per axis that are interpolated between two neighbouring depth points, so that a projected surface has no gaps. */
const FILLED = 4;
/** Smallest jump in depth that the surface does not bridge, in pixels. */
const JUMP = 6;
/** Residual (log units) that gets the darkest colour, and the range of log brightness from black to white in the overlay. */
const RESIDUAL = 0.3;
const LOG_RANGE = 2;

/** The pose before the run, which lays the views over each other as they are. */
const BEFORE = { scale: 1, rotation: IDENTITY, translation: [0, 0, 0] };

/** Mean log shading of the depth map's surface in the image, after projection by a pose; NaN where nothing projects. */
function projected(api, { depth }, light, values, pose) {
  const turned = normalsOf(depth, values);
  for (let index = 0; index < SIZE * SIZE; index++)
    turned.set(moved({ ...pose, scale: 1, translation: [0, 0, 0] }, triple(turned, index)), 3 * index);
  const shading = api.shadeNormals(
    light,
    turned.map((value) => (Number.isFinite(value) ? value : 0.577)),
  );
  const nearest = new Float32Array(SIZE * SIZE).fill(Infinity);
  const found = new Float32Array(SIZE * SIZE).fill(NaN);
  for (let index = 0; index < SIZE * SIZE - SIZE - 1; index++) {
    const corners = [index, index + 1, index + SIZE, index + SIZE + 1];
    const depths = corners.map((at) => values[at]);
    const step = Math.max(...depths) - Math.min(...depths);
    if (!(step < JUMP) || !Number.isFinite(turned[3 * index])) continue;
    const points = corners.map((at) => moved(pose, pointOf(depth, values, at)));
    for (let at = 0; at < FILLED * FILLED; at++) {
      const [u, v] = [(at % FILLED) / FILLED, Math.floor(at / FILLED) / FILLED];
      const point = [0, 1, 2].map(
        (axis) =>
          (1 - v) * ((1 - u) * points[0][axis] + u * points[1][axis]) +
          v * ((1 - u) * points[2][axis] + u * points[3][axis]),
      );
      const [column, row] = fallsOn(depth, point).map(Math.round);
      const pixel = row * SIZE + column;
      if (column < 0 || row < 0 || column >= SIZE || row >= SIZE || point[2] >= nearest[pixel]) continue;
      nearest[pixel] = point[2];
      found[pixel] = triple(shading, index).reduce((sum, value) => sum + value / 3, 0);
    }
  }
  return found;
}

/** Mean log intensity of the image; NaN outside its mask. */
const brightness = ({ data, mask }) =>
  Float32Array.from(mask, (inside, index) =>
    inside ? triple(data, index).reduce((sum, value) => sum + Math.log(value) / 3, 0) : NaN,
  );

/** Shows the image in red and the depth map's shading in cyan. Where they agree, the colours add up to grey. */
function overlay(image, shading) {
  const shared = (_, index) => Number.isFinite(image[index] + shading[index]);
  const both = [image, shading].map((values) => median([...values.filter(shared)]));
  const level = (value, middle) => 150 + (220 * (value - middle)) / LOG_RANGE;
  return (index) => {
    const [red, cyan] = [image, shading].map((values, at) =>
      Number.isFinite(values[index]) ? clamped(level(values[index], both[at]), 0, 235) : undefined,
    );
    if (red === undefined && cyan === undefined) return undefined;
    return [red ?? 255, cyan ?? 255, cyan ?? 255].map((value, channel) =>
      red === undefined ? (channel === 0 ? 90 : value) : cyan === undefined ? (channel === 0 ? value : 90) : value,
    );
  };
}

/** A ball under a light, as the camera sees it. */
function ball(api, light, side) {
  const size = { width: side, height: side };
  const normals = new Float32Array(3 * side * side).fill(NaN);
  for (let index = 0; index < side * side; index++) {
    const [x, y] = [index % side, Math.floor(index / side)].map((at) => (2 * (at + 0.5)) / side - 1);
    if (x * x + y * y < 0.98) normals.set([x, y, -Math.sqrt(1 - x * x - y * y)], 3 * index);
  }
  const shading = api.shadeNormals(
    light,
    normals.map((value) => (Number.isFinite(value) ? value : 0.577)),
  );
  const inside = (index) => Number.isFinite(normals[3 * index]);
  const brightest = shading.filter((_, at) => inside(Math.floor(at / 3))).reduce((a, b) => Math.max(a, b));
  const pixel = (index) =>
    inside(index) ? triple(shading, index).map((value) => byteOf(Math.exp(value - brightest))) : undefined;
  return picture(size, { left: 0, top: 0, ...size }, pixel);
}

const hexOf = (colour) => [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));

/** The pictures of a run that has ended. */
function panels(api, made, report, estimator) {
  const { image, depth } = made;
  const inImage = boxAround(image, (index) => image.mask[index], 5);
  const inDepth = boxAround(depth, (index) => depth.data[index] > 0, 4);
  const brightest = image.data.reduce((a, b) => Math.max(a, b), 0);
  const light = estimator.light();
  const [imageNormals, residual, refined] = [estimator.imageNormals(), estimator.residual(), estimator.refinedDepth()];
  const measured = Float32Array.from(depth.data, (value) => (value > 0 ? value : NaN));
  const shade = (normals) => {
    const share = lit(normals);
    return (index) => (share(index) === undefined ? undefined : grey(share(index)));
  };
  const seen = brightness(image);
  const laid = (pose) => picture(image, inImage, overlay(seen, projected(api, made, light, measured, pose)));
  const coloured = (index) =>
    image.mask[index] ? triple(image.data, index).map((value) => byteOf(value / brightest)) : undefined;
  const left = (index) =>
    Number.isFinite(residual[index]) ? tint(residual[index] / RESIDUAL, hexOf(BLUE)) : undefined;
  const normals = (index) =>
    Number.isFinite(imageNormals[3 * index]) ? normalColour(triple(imageNormals, index)) : undefined;
  return {
    image: picture(image, inImage, coloured),
    depth: picture(depth, inDepth, shade(normalsOf(depth, measured))),
    light: ball(api, light, 96),
    before: laid(BEFORE),
    after: laid(report.pose),
    normals: picture(image, inImage, normals),
    surface: picture(image, inImage, shade(normalsOf(image, estimator.imageDepth()))),
    refined: picture(depth, inDepth, shade(normalsOf(depth, refined))),
    residual: picture(image, inImage, left),
  };
}

const TALL = 172;
const PLACES = [
  ["image", "Input: colour image", "one object, unknown light"],
  ["depth", "Input: depth map", "shaded; noise and holes"],
  ["light", "Light", "found, on a ball"],
  ["before", "Registration: before", "red image, cyan depth map"],
  ["after", "Registration: after", "grey where both agree"],
  ["normals", "Normals of the image", "red x, green y, blue to camera"],
  ["surface", "Integrated surface", "of the image, shaded"],
  ["refined", "Refined depth map", "less noise, no holes"],
  ["residual", "Residual", `white 0, blue ${RESIDUAL} log units`],
];

export async function stages(api) {
  const made = api.sample(SCENE);
  const found = await withRun(api, made, {}, (report, estimator) => panels(api, made, report, estimator));
  const parts = PLACES.flatMap(([name, title, words], at) => {
    const [x, y] = [20 + 230 * (at % 3), 24 + 248 * Math.floor(at / 3)];
    const { box } = found[name];
    const tall = name === "light" ? 130 : TALL;
    const width = (tall * box.width) / box.height;
    return [
      text(x, y, title, { size: 15, bold: true }),
      text(x, y + 18, words, { colour: SOFT }),
      placed(found[name], x + (200 - width) / 2, y + 30 + (TALL - tall) / 2, width),
    ];
  });
  return figure(
    700,
    752,
    "Nine pictures of one run: colour image, depth map, light, registration before and after, normals, integrated surface, refined depth map, residual",
    parts,
  );
}
