/**
 * Which laser of a spinning scanner measured each point: the rows of its range image.
 *
 * By the file's ring, or by the order of its points where each laser's whole turn follows the last one's (KITTI), or by elevations that
 * cluster. A row is a cone, height = tangent * radius + origin: lasers of one scanner sit up to 0.2 m above each other, so that a laser's
 * elevation as the origin sees it changes with the distance. What fits no such cones is no spinning scanner's, or no longer: no rows.
 */
import { type Polar, type Vector, AXES, frameOf, leastScatter, polarOf } from "./frame.js";

export interface Row {
  /** Tangent of the elevation. */
  tangent: number;
  /** Where the laser sits on the axis, metres. */
  origin: number;
}

export interface Rows {
  how: "ring" | "order" | "elevation";
  polar: Polar;
  /** From the top down. */
  rows: Row[];
  /** Each point's row; -1 none. */
  row: Int16Array;
}

const FEWEST_ROWS = 4;
const MOST_ROWS = 512;
/** Of a row's points, for its cone to be known. */
const FEWEST_POINTS = 20;
/** Mean distance of points from their cones over that of neighbouring cones: points without any rows have 0.25. */
const FITTING = 0.15;
/** .. where a file names its rings, which are rows even where they waver. */
const FITTING_RINGS = 0.5;
/** Points that are looked at for it. */
const LOOKED_AT = 50_000;
/** Share of points that have to lie in rows. */
const NEARLY_ALL = 0.95;

export const median = (values: ArrayLike<number>): number =>
  Float64Array.from(values).sort()[values.length >> 1] ?? NaN;

/** Radians from the cone within which a point counts fully for its fit, at first and at last. */
const SCALES = [0.05, 0.001] as const;
const FIT_ROUNDS = 12;

/** The cone of a row: slope + origin / radius by weighted least squares, in angles, with Cauchy's weights. */
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
    // Of a row at one distance alone the origin is unknown, and zero is the likeliest.
    uu += n * UNKNOWN_ORIGIN;
    const determinant = n * uu - u * u;
    row = { tangent: (y * uu - uy * u) / determinant, origin: (n * uy - u * y) / determinant };
    if (Math.abs(row.origin) > MOST_ORIGIN) return { tangent: y / n, origin: 0 };
  }
  return row;
}
/** Variance of an elevation that is no noise (0.6 mrad: a tilted axis) over that of an origin (0.15 m). */
const UNKNOWN_ORIGIN = (0.0006 / 0.15) ** 2;
/** Metres between the lasers of one scanner and its origin, at most. */
const MOST_ORIGIN = 0.5;

/** Tangent of the elevation, seen from the cloud's origin, of what a row measures so far from the axis; metres, 10 are usual. */
export const slopeOf = ({ tangent, origin }: Row, radius = 10): number => tangent + origin / radius;

/** Rows around one that say where its laser sits, and how far from theirs it may seem to, metres. */
const AROUND = 2;
const UNSTEADY = 0.1;

/** Cones whose origin is that of the lasers beside them, where the own points say another: those of a row that sees the ground alone may. */
function steadied<T extends { row: Row; radius: number }>(found: T[]): T[] {
  return found.map((each, index) => {
    const { row, radius } = each;
    const around = found.slice(Math.max(0, index - AROUND), index + AROUND + 1);
    const origin = median(around.map((other) => other.row.origin));
    if (Math.abs(row.origin - origin) < UNSTEADY) return each;
    return { ...each, row: { tangent: row.tangent + (row.origin - origin) / radius, origin } };
  });
}

/** Rows of groups of points, from the top down; nothing where they are no cones. */
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

/** Whether points lie much nearer to their own row than rows to each other. */
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

/** How much more the directions of a ring may scatter along an axis of the frame than along the best one, for that to be the axis. */
const AS_GOOD = 1.5;
/** Cosine of 1.5 degrees. */
const NEAR = 0.99966;

/** Rows by the file's own rings, about the axis along which the directions of a ring scatter least. */
export function byRing(points: Float32Array, ring: ArrayLike<number>, forward: Vector): Rows | undefined {
  const { axis, along } = leastScatter(points, ring);
  const own = AXES.find(
    (each) =>
      Math.abs(each[0] * axis[0] + each[1] * axis[1] + each[2] * axis[2]) > NEAR &&
      along(each) < AS_GOOD * along(axis) + 1e-8,
  );
  return fitted(polarOf(points, frameOf(own ?? upwards(axis), forward)), ring, "ring");
}

/** The axis's end that lies towards that of the frame's axes. */
function upwards(axis: Vector): Vector {
  const nearest = AXES.reduce((best, each) =>
    Math.abs(inner(each, axis)) > Math.abs(inner(best, axis)) ? each : best,
  );
  return inner(nearest, axis) < 0 ? [-axis[0], -axis[1], -axis[2]] : axis;
}
const inner = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const TURN = 2 * Math.PI;
const degrees = Math.PI / 180;
/** Radians that azimuths may go back within a turn. */
const BACKWARDS = 20 * degrees;
/** Share of steps from point to point that go the scanner's way and are short. */
const MOSTLY = 0.8;
const SHORT = 3 * degrees;
/** Radians around the seam in which a new turn may begin. */
const SEAM = 4 * degrees;

/** Rows by turns: the points of one laser after those of the other, each in order of azimuth. */
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
  // Ahead all the way: a jump back by much is a gap up to the next turn.
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

/** Ranges of two pulses that differ by less, as a share, are of one surface, where elevations jump from laser to laser alone. */
const LEVEL = 0.05;

/** How much the slope changes from each point's predecessor of the same surface. */
function jumpsOf({ radius, height }: Polar): Float64Array {
  const slopes = radius.map((each, index) => (height[index] ?? 0) / each);
  return slopes.map((slope, index) => {
    const [here = NaN, before = NaN] = [radius[index], radius[index - 1]];
    return Math.abs(here / before - 1) < LEVEL ? Math.abs(slope - (slopes[index - 1] ?? 0)) : 0;
  });
}

/** Number of the turn of each point. The seam lies where elevations jump most from point to point, in most turns. */
function turnsOf(polar: Polar, travelled: Float64Array): { turn: Int32Array; isSeam: (index: number) => boolean } {
  const jumps = jumpsOf(polar);
  const breaks = (phase: number): { at: number[]; usual: number; phase: number } => {
    const best = new Map<number, number>();
    for (let index = 1; index < jumps.length; index++) {
      const place = ((travelled[index] ?? 0) - phase) / TURN;
      const turn = Math.round(place);
      const isAcross = Math.floor(place) > Math.floor(((travelled[index - 1] ?? 0) - phase) / TURN);
      // A gap that is longer than the seam begins the turn by itself.
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

/** Of the histogram of elevations, radians. */
const BIN = 0.02 * degrees;
/** Points nearer than this from the axis, metres, blur the clusters. */
const BLURRED = 2;
/** Of a cluster that may be one, over the higher ones: rays into the sky do not come back. */
const LEAST_CLUSTER = 0.05;
/** A valley between two clusters has at most this share of the lower one. */
const VALLEY = 0.5;

/** Rows by clusters of elevation. */
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
  const highest = [...smooth].sort((a, b) => b - a)[FEWEST_ROWS * 5] ?? 0;
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
  // Elevations of near points blur.
  return coarse && refined(coarse, () => true);
}

/** Bins between clusters, in order. */
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

/** Points in doubt in the row whose cone is nearest to them, of those about their own. */
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
