// Depth with the flaws of sensors, refined at the known pose and compared with its truth.
import { chance, mean, median, seedOf } from "./numbers.mjs";
import { onto } from "./measure-reals.mjs";
import { requestOf } from "./scenes.mjs";
import { optionsOf, withRun } from "./runs.mjs";

/** A structured-light sensor: focal length in pixels, baseline in metres, disparity steps per pixel. */
export const SENSOR = { focalLength: 580, baseline: 0.075, steps: 8 };
/** Width and distance of the objects, metres, and the share of their view that they span. */
const OBJECT = { width: 0.2, distance: 0.8, span: 230 / 256 };
/** Noise of the scans in pixel lengths, its lateral blur in pixels, the depth steps, and the noise of log S. */
const SCAN = { noise: 0.7, blur: 0.8, step: 0.8, colour: 0.01 };
/** Blur of the mitten's truth, pixels: the truth has the same depth steps as the frames. */
const TRUTH_BLUR = 1.5;
/** Sigmas of the Gaussian blurs that the refinement is compared with, pixels; 0 leaves the depth map as it is. */
export const BLURS = [0, 0.4, 0.6, 0.8, 1, 1.25, 1.5, 1.75, 2, 2.5, 3, 3.5, 4, 5, 6, 8, 10];
/** Constants of the image model's harmonics. */
const [C1, C2, C3, C4, C5] = [0.429043, 0.511664, 0.743125, 0.886227, 0.247708];

const IDENTITY = { scale: 1, rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: [0, 0, 0] };

/** Means with Gaussian weights over the pixels that have a value, along rows, then along columns. */
export function blurred({ width, height, data }, sigma) {
  const reach = Math.ceil(3 * sigma);
  const weights = Array.from({ length: 2 * reach + 1 }, (_, k) => Math.exp(-0.5 * ((k - reach) / sigma) ** 2));
  let values = Float64Array.from(data, (value) => (Number.isFinite(value) ? value : 0));
  let shares = Float64Array.from(data, (value) => (Number.isFinite(value) ? 1 : 0));
  const along = (field, stride, side, at) =>
    field.map((_, index) => {
      let sum = 0;
      for (let k = -reach; k <= reach; k++) {
        const place = at(index) + k;
        if (place >= 0 && place < side) sum += weights[k + reach] * field[index + k * stride];
      }
      return sum;
    });
  for (const [stride, side, at] of [
    [1, width, (index) => index % width],
    [width, height, (index) => Math.floor(index / width)],
  ]) {
    [values, shares] = [values, shares].map((field) => along(field, stride, side, at));
  }
  return Float64Array.from(data, (value, index) => (Number.isFinite(value) ? values[index] / shares[index] : NaN));
}

const rms = (errors) => Math.sqrt(mean(errors.map((error) => error ** 2)));

/**
 * The smallest median and the smallest RMS error that a Gaussian blur of the measured depth reaches. The truth chooses the blur, for
 * each cell and for each of the two figures by itself, which favours the blur: nobody who has only the depth map can choose so well.
 */
export function bestBlur({ width, height, mask, data }, errorsOf) {
  const measured = Float64Array.from(data, (value, index) => (value > 0 && (!mask || mask[index]) ? value : NaN));
  const tried = BLURS.map((sigma) => {
    const errors = errorsOf(sigma === 0 ? measured : blurred({ width, height, data: measured }, sigma));
    return { sigma, median: median(errors), rms: rms(errors) };
  });
  const best = (key) => tried.reduce((least, each) => (each[key] < least[key] ? each : least));
  const [byMedian, byRms] = [best("median"), best("rms")];
  return { blur: byMedian.median, blurSigma: byMedian.sigma, blurRms: byRms.rms, blurRmsSigma: byRms.sigma };
}

/** Errors before and after refinement and after the best blur, over measured pixels whose true depth is known. */
async function refined(api, image, depth, truth, unit, options) {
  const known = [...truth.keys()].filter(
    (index) => Number.isFinite(truth[index]) && depth.data[index] > 0 && (!depth.mask || depth.mask[index]),
  );
  const errors = (found, scale) => known.map((index) => Math.abs(found[index] * scale - truth[index]) / unit);
  const blur = bestBlur(depth, (found) => errors(found, depth.unit ?? 1));
  return withRun(api, { image, depth }, options, (report, estimator, milliseconds) => {
    const [given, found] = [errors(depth.data, depth.unit ?? 1), errors(estimator.refinedDepth(), 1)];
    const [before, after] = [given, found].map(median);
    return {
      before,
      after,
      ratio: before / after,
      meanRatio: mean(given) / mean(found),
      rms: rms(found),
      ...blur,
      overBlur: blur.blur / after,
      rmsOverBlur: blur.blurRms / rms(found),
      status: report.status,
      iterations: report.iteration,
      milliseconds,
    };
  });
}

export async function measureMitten(cell, api, library) {
  const { image, depth, median20 } = library.mitten(cell.frame);
  const inside = median20.map((value, index) => (depth.mask[index] && value > 0 ? value * depth.unit : NaN));
  const truth = blurred({ ...depth, data: inside }, TRUTH_BLUR);
  return refined(api, image, depth, truth, 0.001, optionsOf(cell.options, { pose: IDENTITY }));
}

export async function measureKinect(cell, api, library) {
  const { size } = cell.scene;
  const made = api.sample(requestOf(cell.scene, library));
  const pixel = OBJECT.width / (OBJECT.span * size);
  const middle = median([...made.truth.depth]);
  const metres = Float64Array.from(made.truth.depth, (depth) => OBJECT.distance + (depth - middle) * pixel);
  const { focalLength, baseline, steps } = SENSOR;
  const quantised = metres.map(
    (z) => (focalLength * baseline) / (Math.round((steps * focalLength * baseline) / z) / steps),
  );
  const photograph = cell.photograph && library.photograph(cell.scene.surface, cell.photograph);
  const image = photograph ? onto(size, photograph, made) : made.image;
  const depth = { ...made.depth, data: Float32Array.from(quantised, (z) => z / pixel) };
  return refined(
    api,
    image,
    depth,
    metres.map((z) => z / pixel),
    1,
    optionsOf(cell.options, made),
  );
}

/** log S by the image model: nine coefficients for each channel. */
function logShading([x, y, z], light) {
  const basis = [
    C4,
    2 * C2 * y,
    2 * C2 * z,
    2 * C2 * x,
    2 * C1 * x * y,
    2 * C1 * y * z,
    C3 * z * z - C5,
    2 * C1 * x * z,
    C1 * (x * x - y * y),
  ];
  return [0, 1, 2].map((channel) => basis.reduce((sum, value, k) => sum + value * light[9 * channel + k], 0));
}

export async function measureScan(cell, api, library) {
  const { width, height, metres, normals, mask, camera } = library.scan(cell.scan);
  const dice = chance(seedOf(cell.id));
  const light = library.light(cell.lightName);
  const inside = [...metres.keys()].filter((index) => mask[index] && metres[index] > 0);
  const colours = new Float32Array(3 * width * height).fill(1);
  for (const index of inside) {
    const log = logShading(normals.subarray(3 * index, 3 * index + 3), light);
    colours.set(
      log.map((value) => Math.exp(value + SCAN.colour * dice.gaussian())),
      3 * index,
    );
  }
  const pixel = median(inside.map((index) => metres[index])) / camera.fx;
  const noise = blurred({ width, height, data: metres.map(() => dice.gaussian()) }, SCAN.blur);
  const spread = Math.sqrt(mean(inside.map((index) => noise[index] ** 2)));
  const [data, truth] = [new Float32Array(width * height), new Float64Array(width * height).fill(NaN)];
  const step = SCAN.step * pixel;
  for (const index of inside) {
    truth[index] = metres[index];
    data[index] = Math.round((metres[index] + (SCAN.noise * pixel * noise[index]) / spread) / step) * step;
  }
  const image = { width, height, data: colours, mask, camera };
  return refined(
    api,
    image,
    { width, height, data, mask, camera },
    truth,
    pixel,
    optionsOf(cell.options, { pose: IDENTITY }),
  );
}
