// A run, and the same run with slightly changed input.
import { chance, seedOf } from "./numbers.mjs";
import { degreesBetween } from "./rotations.mjs";

/** Share of the depth pixels that are removed. */
const LEFT_OUT = 0.01;

/** Removes depth pixels at random. */
function withoutPoints({ image, depth }, dice) {
  const data = depth.data.map((value) => (dice.uniform() < LEFT_OUT ? 0 : value));
  return { image, depth: { ...depth, data } };
}

/** Shifts the mask of the image, or else of the depth map, right by a pixel. */
function withShiftedMask({ image, depth }) {
  const shifted = (view) => ({
    ...view,
    mask: view.mask.map((_, index) => (index % view.width > 0 ? view.mask[index - 1] : 0)),
  });
  if (image.mask) return { image: shifted(image), depth };
  // Without any mask nothing would change, and the pose could not move.
  if (!depth.mask) throw new Error("neither view has a mask to shift");
  return { image, depth: shifted(depth) };
}

/** Removes the first row of the image. */
function withoutRow({ image, depth }) {
  const { width, height, data, mask, camera } = image;
  const channels = data.length / (width * height);
  const cut = { ...image, height: height - 1, data: data.slice(channels * width) };
  if (mask) cut.mask = mask.slice(width);
  if (camera) cut.camera = { ...camera, cy: camera.cy - 1 };
  return { image: cut, depth };
}

const CHANGES = { points: withoutPoints, mask: withShiftedMask, row: withoutRow };

/** The package with an estimator that first changes its input. */
function changing(api, change, seed) {
  class Estimator extends api.Estimator {
    constructor(image, depth, options) {
      const changed = CHANGES[change]({ image, depth }, chance(seed));
      super(changed.image, changed.depth, options);
    }
  }
  return { ...api, Estimator };
}

/** The rotation of the pose by each change, and whether it is below the norm of the axes' sigmas. `measure` runs any cell. */
export async function measurePerturbed({ id, of }, api, library, measure) {
  const plain = await measure(of, api, library);
  const sigma = plain.sigmas ? Math.hypot(...plain.sigmas) : null;
  const moves = [];
  for (const change of Object.keys(CHANGES)) {
    const other = await measure(of, changing(api, change, seedOf(`${id}/${change}`)), library);
    const degrees = degreesBetween(other.rotation, plain.rotation);
    const isWithin = sigma !== null && degrees < sigma;
    moves.push({ change, degrees, sigma, isWithin, status: plain.status, changedStatus: other.status });
  }
  return { moves };
}
