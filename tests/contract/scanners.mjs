// Simulated LiDAR scanners in a simulated room, for the tests of range images: rings, a rosette, and sweeps from several places in one cloud.
// The axes are those of most LiDARs: x forward, y left, z up.

/** A reproducible random number in 0 .. 1. */
export function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** A room with objects, as boxes with a lowest and a highest corner. */
const ROOM = [
  [-6, -5, -1.5],
  [9, 6, 2.5],
];
const THINGS = [
  [
    [3, -1, -1.5],
    [4, 0.2, 0.4],
  ],
  [
    [5, 1, -1.5],
    [5.6, 1.5, 2],
  ],
  [
    [2.5, 2, -0.6],
    [3.1, 2.6, 0.1],
  ],
];

/** Distances along a ray at which it enters and leaves a box. */
function through([low, high], from, along) {
  let [enter, leave] = [-Infinity, Infinity];
  for (let axis = 0; axis < 3; axis++) {
    const [a, b] = [low, high].map((corner) => (corner[axis] - from[axis]) / along[axis]);
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return [enter, leave];
}

/** Distance along a ray to the room or an object. */
export function cast(from, along) {
  const hits = THINGS.map((thing) => through(thing, from, along)).filter(
    ([enter, leave]) => enter > 0 && enter < leave,
  );
  return Math.min(through(ROOM, from, along)[1], ...hits.map(([enter]) => enter));
}

const direction = (azimuth, elevation) => [
  Math.cos(elevation) * Math.cos(azimuth),
  Math.cos(elevation) * Math.sin(azimuth),
  Math.sin(elevation),
];

/** A ray's measurement; one ray in twenty gives none, as on black surfaces. */
function measured(points, from, along, noise) {
  if (noise() < 0.05) return false;
  const range = cast(from, along) + 0.01 * (noise() - 0.5);
  points.push(...[0, 1, 2].map((axis) => Math.fround(from[axis] + range * along[axis])));
  return true;
}

/**
 * A spinning scanner: ring by ring, each by azimuth, in the order of KITTI. A clock's ticks make azimuths coarse; the upper block of lasers
 * is `offset` metres above the origin, the lower block half as high.
 */
export function spinning({ lasers, step = 0.2, offset = 0, seed = 1, tick = 0 }) {
  const noise = random(seed);
  const [points, ring] = [[], []];
  const columns = Math.round(360 / step);
  for (let laser = 0; laser < lasers; laser++) {
    const elevation = ((15 - (30 * laser) / (lasers - 1)) * Math.PI) / 180;
    const origin = [0, 0, laser < lasers / 2 ? offset : offset / 2];
    const phase = noise();
    for (let column = 0; column < columns; column++) {
      const due = ((column + phase) * 360) / columns;
      const degrees = tick > 0 ? tick * Math.round(due / tick) : due;
      if (measured(points, origin, direction((degrees * Math.PI) / 180, elevation), noise)) ring.push(laser);
    }
  }
  return { points: Float32Array.from(points), ring: Float32Array.from(ring) };
}

/** The same scan with its points in random order. */
export function shuffled({ points, ring }, seed = 3) {
  const noise = random(seed);
  const order = Array.from(ring.keys());
  for (let at = order.length - 1; at > 0; at--) {
    const other = Math.floor(noise() * (at + 1));
    [order[at], order[other]] = [order[other], order[at]];
  }
  return {
    points: Float32Array.from(order.flatMap((from) => [...points.subarray(3 * from, 3 * from + 3)])),
    ring: Float32Array.from(order, (from) => ring[from]),
  };
}

/** A scan in other axes; each new axis is a signed old one, [axis, sign]. */
export const turned = ({ points, ...rest }, axes) => ({
  ...rest,
  points: points.map((_, at) => axes[at % 3][1] * points[at - (at % 3) + axes[at % 3][0]]),
});
/** Right, down and forward, from x forward, y left and z up. */
export const OPTICAL = [
  [1, -1],
  [2, -1],
  [0, 1],
];

/** A rosette, 38 degrees wide, drawn by two prisms that rotate in opposite directions. */
export function rosette({ count, from = [0, 0, 0], seed = 5 }) {
  const noise = random(seed);
  const points = [];
  for (let pulse = 0; pulse < count; pulse++) {
    const [one, other] = [pulse * 0.0331, pulse * -0.02113];
    const [a, b] = [Math.cos(one) + Math.cos(other), Math.sin(one) + Math.sin(other)].map(
      (value) => (value * 9.6 * Math.PI) / 180,
    );
    measured(points, from, direction(a, b), noise);
  }
  return { points: Float32Array.from(points) };
}

/** Sweeps of a scanner that moves sideways and forwards, in the frame of the first sweep. */
export function accumulated(places = 5) {
  const all = Array.from({ length: places }, (_, place) =>
    rosette({ count: 12_000, from: [0.1 * place, 0.15 * place, 0.02 * place], seed: 11 + place }),
  );
  return { points: Float32Array.from(all.flatMap(({ points }) => [...points])) };
}

/** A camera beside the scanner that looks along the scanner's x axis: 640x480, 70 degrees wide. */
export const VIEW = {
  rotation: [0, -1, 0, 0, 0, -1, 1, 0, 0],
  translation: [0.05, -0.08, -0.06],
  camera: { fx: 457, fy: 457, cx: 319.5, cy: 239.5 },
  width: 640,
  height: 480,
};
