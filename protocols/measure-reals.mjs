// Real pairs and photographs from a library: turned, resampled and run.
import { direction } from "./anywhere.mjs";
import { chance, seedOf } from "./numbers.mjs";
import { aboutAxis, aboutY, degreesBetween, product, transpose, turn } from "./rotations.mjs";
import { requestOf } from "./scenes.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";
import { normalDegrees } from "./measure-shapes.mjs";

/** The points of a depth map in metres; NaN where depth is missing. */
function cloudOf({ width, height, data, camera, unit, mask }) {
  const points = new Float32Array(3 * width * height).fill(NaN);
  for (let index = 0; index < width * height; index++) {
    if (!mask[index] || !(data[index] > 0)) continue;
    const z = data[index] * unit;
    const [x, y] = [(index % width) - camera.cx, Math.floor(index / width) - camera.cy];
    points.set([(x * z) / camera.fx, (y * z) / camera.fy, z], 3 * index);
  }
  return points;
}

/** The depth view as seen from `degrees` further left: an organised cloud, rotated about the mean of its points. */
function turnedDepth({ width, height, ...depth }, degrees) {
  const points = cloudOf({ width, height, ...depth });
  const measured = [...Array(width * height).keys()].filter((index) => Number.isFinite(points[3 * index]));
  const centre = [0, 1, 2].map(
    (axis) => measured.reduce((sum, index) => sum + points[3 * index + axis], 0) / measured.length,
  );
  const inverse = transpose(aboutY(degrees));
  for (const index of measured) {
    const offset = centre.map((middle, axis) => points[3 * index + axis] - middle);
    points.set(
      turn(inverse, offset).map((part, axis) => part + centre[axis]),
      3 * index,
    );
  }
  return { width, height, mask: depth.mask, camera: depth.camera, points };
}

export async function measurePair(cell, api, library) {
  const { image, depth } = library.pair(cell.pair);
  const truth = { rotation: aboutY(cell.turned), scale: 1 };
  const given = cell.turned === 0 ? depth : turnedDepth(depth, cell.turned);
  const isHole = (index) => depth.mask[index] && !(depth.data[index] > 0);
  const holes = [...depth.data.keys()].filter(isHole);
  let normalsBefore, residualBefore;
  const atStart = (estimator) => {
    normalsBefore = estimator.depthNormals();
    residualBefore = estimator.report.residual;
  };
  const look = (report, estimator, milliseconds) => {
    const refined = estimator.refinedDepth();
    return {
      ...judged(report, truth, milliseconds),
      identityDegrees: degreesBetween([1, 0, 0, 0, 1, 0, 0, 0, 1], truth.rotation),
      pose: report.pose,
      residualBefore,
      residualAfter: report.residual,
      holesBefore: holes.length,
      holesAfter: holes.filter((index) => !Number.isFinite(refined[index])).length,
      normalChange: normalDegrees(estimator.depthNormals(), normalsBefore, (index) => !isHole(index)),
    };
  };
  return withRun(api, { image, depth: given }, optionsOf(cell.options, {}), look, atStart);
}

/** Smallest share of a pixel's footprint that must lie on the photographed object. */
const COVERED = 0.5;

/** The photograph resampled to the pixels of the rendered view: means over each pixel's footprint. */
export function onto(size, { width, height, data, mask, place }, made) {
  const colours = new Float32Array(3 * size * size);
  const inside = new Uint8Array(size * size);
  // The relief spans 256 samples, the view `size` pixels; the library gives the position of a sample in the photograph.
  const step = 256 / size;
  const reach = (0.5 * step) / place.samplesPerPixel;
  for (let index = 0; index < size * size; index++) {
    if (!made.image.mask[index]) continue;
    const [column, row] = [index % size, Math.floor(index / size)].map((at) => (at - (size - 1) / 2) * step);
    const [x, y] = [place.x + column / place.samplesPerPixel, place.y + row / place.samplesPerPixel];
    const sum = [0, 0, 0];
    let [covered, all] = [0, 0];
    for (let v = Math.ceil(y - reach); v <= y + reach; v++) {
      for (let u = Math.ceil(x - reach); u <= x + reach; u++) {
        all++;
        const at = v * width + u;
        if (u < 0 || v < 0 || u >= width || v >= height || !mask[at]) continue;
        covered++;
        for (let channel = 0; channel < 3; channel++) sum[channel] += data[3 * at + channel];
      }
    }
    if (covered < COVERED * all || covered === 0 || sum.some((channel) => channel <= 0)) continue;
    inside[index] = 255;
    colours.set(
      sum.map((channel) => channel / covered),
      3 * index,
    );
  }
  return { width: size, height: size, data: colours, mask: inside };
}

/** Luminance of linear R, G, B. */
const LUMINANCE = [0.2126, 0.7152, 0.0722];

/** Combines photographs under one lamp each as the channels of one image. */
function channels(photographs) {
  const grey = ({ data }, index) =>
    LUMINANCE.reduce((sum, weight, channel) => sum + weight * data[3 * index + channel], 0);
  const data = photographs[0].data.map((_, at) => grey(photographs[at % 3], Math.floor(at / 3)));
  return { ...photographs[0], data };
}

/** An initial pose that is rotated about the object's middle; the seed follows from the cell's name. */
function startOff({ rotation, scale, translation }, depth, degrees, name) {
  const [middle, { width, height }] = [[0, 0, 0], depth];
  let count = 0;
  for (const [index, z] of depth.data.entries()) {
    if (!(z > 0)) continue;
    count++;
    [(index % width) - (width - 1) / 2, Math.floor(index / width) - (height - 1) / 2, z].forEach(
      (value, axis) => (middle[axis] += value),
    );
  }
  const turned = product(aboutAxis(direction(chance(seedOf(name))), degrees), rotation);
  const [from, to] = [rotation, turned].map((matrix) => turn(matrix, middle).map((value) => (scale * value) / count));
  return { scale, rotation: turned, translation: translation.map((value, axis) => value + from[axis] - to[axis]) };
}

export async function measurePhotograph(cell, api, library) {
  const { size, surface } = cell.scene;
  const made = api.sample(requestOf(cell.scene, library));
  const read = (name) => library.photograph(surface, name);
  const photograph = cell.lamps ? channels(cell.lamps.map(read)) : cell.photograph && read(cell.photograph);
  const image = photograph ? onto(size, photograph, made) : made.image;
  const start = cell.off ? { start: startOff(made.pose, made.depth, cell.off, cell.id) } : {};
  const options = { ...optionsOf(cell.options, made), ...start };
  return withRun(api, { image, depth: made.depth }, options, (report, _, milliseconds) =>
    judged(report, made.pose, milliseconds),
  );
}

/** Correlation of two fields of log colours and their root mean square difference, after removing each channel's mean over the pixels. */
function compared(found, truth, pixels) {
  const squares = { both: 0, found: 0, truth: 0, off: 0 };
  const mean = (field, channel) => pixels.reduce((sum, pixel) => sum + field[3 * pixel + channel], 0) / pixels.length;
  const means = [found, truth].map((field) => [0, 1, 2].map((channel) => mean(field, channel)));
  for (const pixel of pixels) {
    for (let channel = 0; channel < 3; channel++) {
      const [a, b] = [found[3 * pixel + channel] - means[0][channel], truth[3 * pixel + channel] - means[1][channel]];
      squares.both += a * b;
      squares.found += a * a;
      squares.truth += b * b;
      squares.off += (a - b) ** 2;
    }
  }
  const norm = Math.sqrt(squares.found * squares.truth);
  return { correlation: norm > 0 ? squares.both / norm : 0, error: Math.sqrt(squares.off / (3 * pixels.length)) };
}

export async function measureAlbedo(cell, api, library) {
  const made = api.sample(requestOf(cell.scene, library));
  const { size, surface } = cell.scene;
  const image = onto(size, library.photograph(surface, cell.photograph), made);
  const paint = onto(size, library.photograph(surface, "lab_reflectance"), made);
  // A picture of the shading alone has a single albedo.
  const isPainted = cell.photograph !== "lab_shading";
  const truth = paint.data.map((value) => (isPainted ? Math.log(value) : 0));
  return withRun(
    api,
    { image, depth: made.depth },
    optionsOf(cell.options, made),
    (report, estimator, milliseconds) => {
      const albedo = estimator.albedo();
      const pixels = [...image.mask.keys()].filter((pixel) => paint.mask[pixel] && Number.isFinite(albedo[3 * pixel]));
      const log = image.data.map((value) => Math.log(value));
      return {
        ...compared(albedo, truth, pixels),
        naive: compared(log, truth, pixels).error,
        normals: normalDegrees(estimator.imageNormals(), made.truth.imageNormals),
        ...judged(report, made.pose, milliseconds),
        error: compared(albedo, truth, pixels).error,
      };
    },
  );
}
