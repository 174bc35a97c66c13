/**
 * The rows of a spinning scanner's range image: the laser that measured each point.
 *
 * Rows come from the file's rings, from the order of the points where the file stores one turn of a laser after the other (KITTI), or from
 * clusters of elevations. A row is a cone, height = tangent * radius + origin: the lasers of one scanner sit up to 0.2 m above each other, so
 * that the elevation of a laser's points, seen from the origin, changes with the distance. Points that fit no such cones have no rows.
 */
import { median } from "../statistics.js";
import { AXES, DEGREE, type Polar, TURN, type Vector, dot, frameOf, leastScatter, polarOf } from "./frame.js";

export interface Row {
  /** Tangent of the elevation. */
  tangent: number;
  /** Height of the laser on the axis, metres. */
  origin: number;
}

export interface Rows {
  how: "ring" | "order" | "elevation";
  polar: Polar;
  /** The rows from the top down. */
  rows: Row[];
  /** The row of each point; -1 for a point without one. */
  row: Int16Array;
}

const FEWEST_ROWS = 4;
const MOST_ROWS = 512;
/** Smallest number of points in a row for the fit of its cone. */
const FEWEST_POINTS = 20;
/** Largest ratio of the median distance of points from their cones to the distance of neighbouring cones; points without rows have 0.25. */
const FITTING = 0.15;
/** The limit of the same ratio for rows from rings or turns, which are known to be rows even if their cones fit poorly. */
const FITTING_RINGS = 0.5;
/** Largest number of points on which this ratio is measured. */
const LOOKED_AT = 50_000;
/** Share of points that have to lie in rows. */
const NEARLY_ALL = 0.95;

/** Scale of the Cauchy weights in the first and in the last round of a fit, radians. */
const SCALES = [0.05, 0.001] as const;
const FIT_ROUNDS = 12;

/** The cone of a row: height / radius = tangent + origin / radius by least squares with Cauchy weights, which narrow from round to round. */
function cone({ radius, height }: Polar, members: readonly number[]): Row {
  let row: Row = { tangent: median(members.map((index) => (height[index] ?? 0) / (radius[index] ?? 1))), origin: 0 };
  for (let round = 0; round < FIT_ROUNDS; round++) {
    const scale = SCALES[0] * (SCALES[1] / SCALES[0]) ** (round / (FIT_ROUNDS - 1));
    let [n, u, uu, y, uy] = [0, 0, 0, 0, 0];
    for (const index of members) {
      const inverse = 1 / Math.max(1e-6, radius[index] ?? 0);
      const slope = (height[index] ?? 0) * inverse;
      const off = (slope - row.tangent - row.origin * inverse) / scale;
      const weight = 1 / (1 + off * off);
      n += weight;
      u += weight * inverse;
      uu += weight * inverse * inverse;
      y += weight * slope;
      uy += weight * slope * inverse;
    }
    // A row whose points all have the same distance does not determine its origin; the prior draws it to zero.
    uu += n * UNKNOWN_ORIGIN;
    const determinant = n * uu - u * u;
    row = { tangent: (y * uu - uy * u) / determinant, origin: (n * uy - u * y) / determinant };
    if (Math.abs(row.origin) > MOST_ORIGIN) return { tangent: y / n, origin: 0 };
  }
  return row;
}
/** Variance of the systematic errors of elevations (0.6 mrad, of a tilted axis) over the prior variance of an origin (0.15 m). */
const UNKNOWN_ORIGIN = (0.0006 / 0.15) ** 2;
/** Largest height of a laser above the scanner's origin, metres. */
const MOST_ORIGIN = 0.5;

/** Tangent of the elevation of a row's points at this radius, metres, seen from the cloud's origin. */
const slopeOf = ({ tangent, origin }: Row, radius = 10): number => tangent + origin / radius;

/** Number of rows on either side with whose median origin a row's origin is compared. */
const AROUND = 2;
/** Smallest difference from that median, metres, at which a row's origin counts as unreliable. */
const UNSTEADY = 0.1;

/** Rows with unreliable origins replaced by the median of their neighbours'; a row that sees only the ground does not determine its origin. */
function steadied<T extends { row: Row; radius: number }>(found: T[]): T[] {
  return found.map((each, index) => {
    const { row, radius } = each;
    const around = found.slice(Math.max(0, index - AROUND), index + AROUND + 1);
    const origin = median(around.map((other) => other.row.origin));
    if (Math.abs(row.origin - origin) < UNSTEADY) return each;
    return { ...each, row: { tangent: row.tangent + (row.origin - origin) / radius, origin } };
  });
}

/** The rows of groups of points, from the top down; undefined where the groups do not form cones. */
function fitted(polar: Polar, group: ArrayLike<number>, how: Rows["how"]): Rows | undefined {
  const members = new Map<number, number[]>();
  for (let index = 0; index < group.length; index++) {
    const key = group[index] ?? -1;
    if (!(key >= 0)) continue;
    const list = members.get(key);
    if (list) list.push(index);
    else members.set(key, [index]);
  }
  const found = [...members.values()]
    .filter((list) => list.length >= FEWEST_POINTS)
    .map((list) => {
      const radius = median(list.map((index) => polar.radius[index] ?? 0));
      return { list, radius, row: cone(polar, list) };
    })
    .sort((a, b) => slopeOf(b.row, b.radius) - slopeOf(a.row, a.radius));
  if (found.length < FEWEST_ROWS || found.length > MOST_ROWS) return undefined;
  const steady = steadied(found).sort((a, b) => slopeOf(b.row) - slopeOf(a.row));
  const row = new Int16Array(group.length).fill(-1);
  steady.forEach(({ list }, number) => {
    for (const index of list) row[index] = number;
  });
  const rows = steady.map((each) => each.row);
  return isFit({ how, polar, rows, row }) ? { how, polar, rows, row } : undefined;
}

/** Whether the points are much nearer to their own row than neighbouring rows are to each other. */
function isFit({ how, polar: { radius, height }, rows, row }: Rows): boolean {
  const offs: number[] = [];
  const stride = Math.max(1, Math.floor(row.length / LOOKED_AT));
  for (let index = 0; index < row.length; index += stride) {
    const own = rows[row[index] ?? -1];
    if (own) offs.push(Math.abs((height[index] ?? 0) / (radius[index] ?? 1) - slopeOf(own, radius[index])));
  }
  const spacing = median(rows.slice(1).map((below, at) => slopeOf(rows[at] as Row) - slopeOf(below)));
  const most = (how === "elevation" ? FITTING : FITTING_RINGS) * spacing;
  return offs.length >= (NEARLY_ALL * row.length) / stride && median(offs) <= most;
}

/**
 * An axis of the frame counts as the scanner's axis if directions scatter along it at most this many times as much as along the best axis.
 */
const AS_GOOD = 1.5;
/** Cosine of the largest angle between an axis of the frame and a scanner's axis that counts as the same: 1.5 degrees. */
const NEAR = 0.99966;

/** Rows from the file's rings, about the axis along which the directions of each ring scatter least. */
export function byRing(points: Float32Array, ring: ArrayLike<number>, forward: Vector): Rows | undefined {
  const { axis, along } = leastScatter(points, ring);
  const own = AXES.find((each) => Math.abs(dot(each, axis)) > NEAR && along(each) < AS_GOOD * along(axis) + 1e-8);
  return fitted(polarOf(points, frameOf(own ?? upwards(axis), forward)), ring, "ring");
}

/** The axis, negated if it points away from the nearest axis of the frame. */
function upwards(axis: Vector): Vector {
  const nearest = AXES.reduce((best, each) => (Math.abs(dot(each, axis)) > Math.abs(dot(best, axis)) ? each : best));
  return dot(nearest, axis) < 0 ? [-axis[0], -axis[1], -axis[2]] : axis;
}

/** Largest backward step of azimuth within a turn, radians. */
const BACKWARDS = 20 * DEGREE;
/** Smallest share of steps between consecutive points that must be short and in the scanner's direction of rotation. */
const MOSTLY = 0.8;
/** The longest short step, radians. */
const SHORT = 3 * DEGREE;
/** Radians on either side of the seam within which a new turn may begin. */
const SEAM = 4 * DEGREE;

/** Rows from turns: the file stores all points of one laser in order of azimuth, then those of the next laser. */
export function byOrder(polar: Polar): Rows | undefined {
  const count = polar.azimuth.length;
  const steps = new Float64Array(count);
  let rightwards = 0;
  for (let index = 1; index < count; index++) {
    const step = (polar.azimuth[index] ?? 0) - (polar.azimuth[index - 1] ?? 0);
    steps[index] = step - TURN * Math.round(step / TURN);
    rightwards += Math.sign(steps[index] ?? 0);
  }
  const way = Math.sign(rightwards) || 1;
  const short = steps.reduce((sum, step) => sum + (way * step > -SHORT / 10 && way * step < SHORT ? 1 : 0), 0);
  if (short < MOSTLY * count) return undefined;
  // The azimuth unwrapped: a long step back is a gap up to the next turn.
  const travelled = new Float64Array(count);
  for (let index = 1; index < count; index++) {
    const step = way * (steps[index] ?? 0);
    travelled[index] = (travelled[index - 1] ?? 0) + (step < -BACKWARDS ? step + TURN : step);
  }
  const turns = ((travelled[count - 1] ?? 0) - (travelled[0] ?? 0)) / TURN;
  if (turns < FEWEST_ROWS - 1 || turns > MOST_ROWS) return undefined;
  const { turn, isSeam } = turnsOf(polar, travelled);
  const coarse = fitted(polar, turn, "order");
  return coarse && refined(coarse, isSeam);
}

/** Two points whose distances differ by a smaller share lie on one surface, on which elevations jump only between lasers. */
const LEVEL = 0.05;

/** The change of the slope from each point's predecessor on the same surface; 0 where the two lie on different surfaces. */
function jumpsOf({ radius, height }: Polar): Float64Array {
  const slopes = radius.map((each, index) => (height[index] ?? 0) / each);
  return slopes.map((slope, index) => {
    const [here = NaN, before = NaN] = [radius[index], radius[index - 1]];
    return Math.abs(here / before - 1) < LEVEL ? Math.abs(slope - (slopes[index - 1] ?? 0)) : 0;
  });
}

/** The turn of each point. The seam is at the azimuth where the median over all turns of the jump in elevation is largest. */
function turnsOf(polar: Polar, travelled: Float64Array): { turn: Int32Array; isSeam: (index: number) => boolean } {
  const jumps = jumpsOf(polar);
  const breaks = (phase: number): { at: number[]; usual: number; phase: number } => {
    const best = new Map<number, number>();
    for (let index = 1; index < jumps.length; index++) {
      const place = ((travelled[index] ?? 0) - phase) / TURN;
      const turn = Math.round(place);
      const isAcross = Math.floor(place) > Math.floor(((travelled[index - 1] ?? 0) - phase) / TURN);
      // A gap that spans the seam begins the turn by itself.
      const key = isAcross ? Math.floor(place) : turn;
      if (!isAcross && Math.abs(place - turn) * TURN > SEAM) continue;
      const rival = best.get(key);
      if (rival === undefined || (jumps[index] ?? 0) > (jumps[rival] ?? 0)) best.set(key, index);
    }
    const at = [...best.values()].sort((a, b) => a - b);
    return { at, usual: median(at.map((index) => jumps[index] ?? 0)), phase };
  };
  let best = breaks(0);
  for (let phase = SEAM; phase < TURN; phase += SEAM) {
    const other = breaks(phase);
    if (other.usual > best.usual) best = other;
  }
  const turn = new Int32Array(travelled.length);
  best.at.forEach((from, number) => {
    turn.fill(number + 1, from);
  });
  const { phase } = best;
  const isSeam = (index: number) => {
    const place = ((travelled[index] ?? 0) - phase) / TURN;
    return Math.abs(place - Math.round(place)) * TURN < SEAM;
  };
  return { turn, isSeam };
}

/** Width of a bin of the histogram of elevations, radians. */
const BIN = 0.02 * DEGREE;
/** Smallest distance from the axis, metres, of the points in the histogram. Nearer points would blur the clusters. */
const BLURRED = 2;
/** Smallest ratio of the height of a cluster to that of the highest ones; it is low, because rays into the sky do not return. */
const LEAST_CLUSTER = 0.05;
/** Number of bins that count as the highest ones. */
const HIGHEST_BINS = 5 * FEWEST_ROWS;
/** Largest ratio of the height of a valley between two clusters to that of the lower cluster. */
const VALLEY = 0.5;

/** Rows from clusters of elevations. */
export function byElevation(polar: Polar): Rows | undefined {
  const count = polar.azimuth.length;
  const elevation = (index: number) => Math.atan2(polar.height[index] ?? 0, polar.radius[index] ?? 1);
  const bins = new Float64Array(Math.ceil(Math.PI / BIN) + 5);
  const binOf = (index: number) => Math.floor((elevation(index) + Math.PI / 2) / BIN) + 2;
  for (let index = 0; index < count; index++)
    if ((polar.radius[index] ?? 0) > BLURRED) bins[binOf(index)] = (bins[binOf(index)] ?? 0) + 1;
  const smooth = bins.map(
    (_, at) => [-2, -1, 0, 1, 2].reduce((sum, by) => sum + (bins[at + by] ?? 0) * (3 - Math.abs(by)), 0) / 9,
  );
  const highest = [...smooth].sort((a, b) => b - a)[HIGHEST_BINS] ?? 0;
  const valleys = valleysOf(smooth, Math.max(FEWEST_POINTS / 4, LEAST_CLUSTER * highest));
  if (valleys.length < FEWEST_ROWS - 1 || valleys.length > MOST_ROWS) return undefined;
  const group = new Int16Array(bins.length);
  let number = 0;
  for (let bin = 0; bin < bins.length; bin++) {
    if (bin === valleys[number]) number++;
    group[bin] = number;
  }
  const coarse = fitted(
    polar,
    Int16Array.from({ length: count }, (_, index) => group[binOf(index)] ?? 0),
    "elevation",
  );
  // These points are near ones, which the histogram leaves out, and points in the tails of two clusters.
  return coarse && refined(coarse, () => true);
}

/** The lowest bin between each two neighbouring clusters, in order. */
function valleysOf(smooth: Float64Array, least: number): number[] {
  const valleys: number[] = [];
  let [isRising, top, bottom, place] = [true, 0, 0, 0];
  smooth.forEach((value, bin) => {
    if (isRising) {
      top = Math.max(top, value);
      if (top < least || value > VALLEY * top) return;
      [isRising, bottom, place] = [false, value, bin];
    } else if (value < bottom) [bottom, place] = [value, bin];
    else if (value >= least && bottom <= VALLEY * value) {
      valleys.push(place);
      [isRising, top] = [true, value];
    }
  });
  return valleys;
}

/** Moves each uncertain point to the nearest of three rows: its own and the two next to it. */
function refined(rows: Rows, isDoubtful: (index: number) => boolean): Rows | undefined {
  const { radius, height } = rows.polar;
  const group = rows.row.map((own, index) => {
    if (own < 0 || !isDoubtful(index)) return own;
    const slope = (height[index] ?? 0) / (radius[index] ?? 1);
    let [best, least] = [own, Infinity];
    for (let number = Math.max(0, own - 2); number <= Math.min(rows.rows.length - 1, own + 2); number++) {
      const off = Math.abs(slope - slopeOf(rows.rows[number] as Row, radius[index]));
      if (off < least) [best, least] = [number, off];
    }
    return best;
  });
  return fitted(rows.polar, group, rows.how);
}
