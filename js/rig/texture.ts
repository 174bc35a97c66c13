/** What the values of neighbouring pixels reveal: depths of a LiDAR are scattered, and images vary from pixel to pixel. */

/** Smallest number of valid pixels for a decision. */
const FEWEST = 1000;

/** Largest share of valid pixels in a projected scan. */
const SPARSE = 0.35;
/** Largest share of valid pixels among the neighbours of valid pixels in a projected scan. */
const ALONE = 0.6;

/** Whether valid pixels are few and isolated, as the points of a LiDAR that were projected; holes of depth cameras are connected. */
export function isScattered(data: ArrayLike<number>, width: number): boolean {
  if (data.length < FEWEST) return false;
  let [valid, beside] = [0, 0];
  for (let at = 1; at < data.length; at++) {
    if (!((data[at] ?? 0) > 0)) continue;
    valid++;
    if (at % width !== 0 && (data[at - 1] ?? 0) > 0) beside++;
  }
  return valid > 0 && valid < SPARSE * data.length && beside < ALONE * valid;
}

/** On a surface, a pixel differs from the mean of its neighbours by less than this share, except at edges. */
const CHANGE = 0.04;
/** Share of pixels with such a difference above which values are those of an image. A depth map has a tenth of this share. */
const MANY = 0.3;

/** Whether values change from pixel to pixel as those of an image do. */
export function looksLikeImage(data: Uint16Array, width: number): boolean {
  if (data.length < FEWEST) return false;
  let [known, changed] = [0, 0];
  for (let at = 2; at < data.length; at++) {
    const [value, middle, before] = [data[at] ?? 0, data[at - 1] ?? 0, data[at - 2] ?? 0];
    if (at % width < 2 || value === 0 || middle === 0 || before === 0) continue;
    known++;
    if (Math.abs((value + before) / 2 - middle) > CHANGE * middle) changed++;
  }
  return known > FEWEST / 2 && changed > MANY * known;
}
