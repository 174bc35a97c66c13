// A run and the same with its input changed a little.
import { chance, seedOf } from "./numbers.mjs";
import { degreesBetween } from "./rotations.mjs";

/** Share of the depth pixels that is left out. */
const LEFT_OUT = 0.01;

/** The same camera where the picture lost its first row. */
const lowered = (camera) => (camera ? { ...camera, cy: camera.cy - 1 } : camera);

/** Without some pixels' depth, by chance. */
function withoutPoints({ image, depth }, dice) {
  const data = depth.data.slice();
  for (let index = 0; index < data.length; index++) if (dice.uniform(0, 1) < LEFT_OUT) data[index] = 0;
  return { image, depth: { ...depth, data } };
}

/** With the image's mask, or else the depth map's, a pixel to the right. */
function withMaskAside({ image, depth }) {
  const aside = (view) => {
    const mask = new Uint8Array(view.mask.length);
    for (let index = 0; index < mask.length; index++) mask[index] = index % view.width > 0 ? view.mask[index - 1] : 0;
    return { ...view, mask };
  };
  if (image.mask) return { image: aside(image), depth };
  return { image, depth: depth.mask ? aside(depth) : depth };
}

/** Without the image's first row. */
function withoutRow({ image, depth }) {
  const { width, height, data, mask, camera } = image;
  const channels = data.length / (width * height);
  const cut = {
    ...image,
    height: height - 1,
    data: data.slice(channels * width),
    ...(mask ? { mask: mask.slice(width) } : {}),
    ...(camera ? { camera: lowered(camera) } : {}),
  };
  return { image: cut, depth };
}

const CHANGED = { points: withoutPoints, mask: withMaskAside, row: withoutRow };

/** The package with an estimator that changes its input first. */
function changing(api, change, seed) {
  class Estimator extends api.Estimator {
    constructor(image, depth, options) {
      const changed = CHANGED[change]({ image, depth }, chance(seed));
      super(changed.image, changed.depth, options);
    }
  }
  return { ...api, Estimator };
}

/** By how much the rotation moves, over its sigma: the root of the sum of squares of the axes' sigmas. `measure` runs any cell. */
export async function measurePerturbed({ id, of, change }, api, library, measure) {
  const plain = await measure(of, api, library);
  const other = await measure(of, changing(api, change, seedOf(id)), library);
  const degrees = degreesBetween(other.rotation, plain.rotation);
  const sigma = plain.sigmas ? Math.hypot(...plain.sigmas) : null;
  return {
    degrees,
    sigma,
    isWithin: sigma !== null && degrees < sigma,
    status: plain.status,
    changedStatus: other.status,
    off: plain.degrees,
    changedOff: other.degrees,
  };
}
