/** Points as a LiDAR or a mapping tool writes them: without rows and columns, in the frame of the sensor. */

/** A cloud without rows and columns. */
export interface Scan {
  /** x, y, z interleaved, in the cloud's own frame. */
  points: Float32Array;
  /** Number of the laser that measured each point, if the file has it. */
  ring?: Float32Array;
  /** Strength of each return in the file's own unit, if the file has it. */
  intensity?: Float32Array;
  /** Time of each point in the file's own unit, if the file has it. */
  times?: Float64Array;
}

/** Returns nearer than this, metres, come from the sensor's own housing or mark a missing return. */
const NEAREST = 0.1;
/** Smallest distance that marks a missing point, metres. */
const FARTHEST = 1e4;

/** Distance from the origin of the point whose x is at this index. Math.hypot would be several times slower. */
export function rangeOf(points: Float32Array, at: number): number {
  const [x, y, z] = [points[at] ?? NaN, points[at + 1] ?? NaN, points[at + 2] ?? NaN];
  return Math.sqrt(x * x + y * y + z * z);
}

/** Indices of the points that are measurements. */
export function measured({ points }: Scan): Uint32Array {
  const kept = new Uint32Array(points.length / 3);
  let count = 0;
  for (let index = 0; index < kept.length; index++) {
    const range = rangeOf(points, 3 * index);
    if (range >= NEAREST && range < FARTHEST) kept[count++] = index;
  }
  return kept.slice(0, count);
}

/** The part of a scan that has these indices. */
export function subset(scan: Scan, kept: Uint32Array): Scan {
  const points = new Float32Array(3 * kept.length);
  for (let to = 0; to < kept.length; to++) {
    const from = kept[to] ?? 0;
    for (let axis = 0; axis < 3; axis++) points[3 * to + axis] = scan.points[3 * from + axis] ?? NaN;
  }
  const { ring, intensity, times } = scan;
  return {
    points,
    ...(ring && { ring: Float32Array.from(kept, (from) => ring[from] ?? NaN) }),
    ...(intensity && { intensity: Float32Array.from(kept, (from) => intensity[from] ?? NaN) }),
    ...(times && { times: Float64Array.from(kept, (from) => times[from] ?? NaN) }),
  };
}
