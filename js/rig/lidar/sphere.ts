/**
 * The range image of points without rows: a z-buffer over azimuths and elevations at the density of the cloud.
 *
 * This image serves scanners without rows (Livox, MEMS) and clouds of many sweeps. The nearest point of a cell stays; other points of the
 * same surface move to a free cell beside it. Points seen through the gaps of a nearer surface are hidden and left out.
 */
import { MOST_SIDE } from "../formats/limits.js";
import { DEGREE, type Polar } from "./frame.js";
import { type Image, LEAST_SIDE } from "./image.js";

/** The smallest and the largest cell, radians. */
const FINEST = 0.02 * DEGREE;
const COARSEST = 4 * DEGREE;
/** Points per occupied cell at the wanted density of two random points per three cells: x / (1 - exp(-x)) at x = 2/3. */
const FILLED = 1.37;
/** Two points lie on one surface if their ranges differ by less than this share. */
const ONE_SURFACE = 0.02;
/** Difference of ranges, in metres, below which two points also lie on one surface. */
const ONE_SURFACE_LEAST = 0.03;
/** Bisection steps for the logarithm of the cell. */
const STEPS = 9;

const isBehind = (range: number, other: number): boolean =>
  range - other > Math.max(ONE_SURFACE_LEAST, ONE_SURFACE * other);

interface Sphere {
  azimuth: Float64Array;
  elevation: Float64Array;
  range: Float64Array;
}

interface Extent {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The range of azimuths and elevations of these points, radians. */
function extent({ azimuth, elevation }: Sphere, points: Uint32Array): Extent {
  let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const index of points) {
    left = Math.min(left, azimuth[index] ?? 0);
    right = Math.max(right, azimuth[index] ?? 0);
    bottom = Math.min(bottom, elevation[index] ?? 0);
    top = Math.max(top, elevation[index] ?? 0);
  }
  return { left, top, width: right - left, height: top - bottom };
}

/** Points per occupied cell. */
function filling(sphere: Sphere, points: Uint32Array, { left, top, width, height }: Extent, step: number): number {
  const columns = Math.floor(width / step) + 1;
  const cells = new Uint8Array(columns * (Math.floor(height / step) + 1));
  let taken = 0;
  for (const index of points) {
    const column = Math.floor(((sphere.azimuth[index] ?? 0) - left) / step);
    const cell = Math.floor((top - (sphere.elevation[index] ?? 0)) / step) * columns + column;
    if (cells[cell] === 0) taken++;
    cells[cell] = 1;
  }
  return points.length / Math.max(1, taken);
}

/** The cell at which the points have the wanted density, radians. */
function stepOf(sphere: Sphere, points: Uint32Array, area: Extent): number {
  const least = Math.max(FINEST, area.width / (MOST_SIDE - 1), area.height / (MOST_SIDE - 1));
  if (filling(sphere, points, area, least) >= FILLED) return least;
  let [low, high] = [Math.log(least), Math.log(Math.max(least, COARSEST))];
  for (let round = 0; round < STEPS; round++) {
    const middle = (low + high) / 2;
    if (filling(sphere, points, area, Math.exp(middle)) < FILLED) low = middle;
    else high = middle;
  }
  return Math.exp(high);
}

/** The first cell, the width of a cell in radians, and the number of cells. */
interface Grid {
  left: number;
  top: number;
  step: number;
  width: number;
  height: number;
}

/** A z-buffer that is being filled. */
class Buffer {
  readonly cells: Int32Array;
  hidden = 0;
  readonly #sphere: Sphere;
  readonly #grid: Grid;

  constructor(sphere: Sphere, grid: Grid) {
    this.#sphere = sphere;
    this.#grid = grid;
    this.cells = new Int32Array(grid.width * grid.height).fill(-1);
  }

  #range(index: number): number {
    return this.#sphere.range[index] ?? 0;
  }

  /** The fractional column of a point. */
  #column(index: number): number {
    const { left, step, width } = this.#grid;
    return Math.min(width - 1e-6, Math.max(0, ((this.#sphere.azimuth[index] ?? 0) - left) / step));
  }

  /** The fractional row of a point. */
  #row(index: number): number {
    const { top, step, height } = this.#grid;
    return Math.min(height - 1e-6, Math.max(0, (top - (this.#sphere.elevation[index] ?? 0)) / step));
  }

  #cell(index: number): number {
    return Math.floor(this.#row(index)) * this.#grid.width + Math.floor(this.#column(index));
  }

  fill(points: Uint32Array): void {
    const late = new Uint32Array(points.length);
    let count = 0;
    for (const index of points) {
      const cell = this.#cell(index);
      const there = this.cells[cell] ?? -1;
      const wins = there < 0 || this.#range(index) < this.#range(there);
      if (wins) this.cells[cell] = index;
      if (there >= 0) late[count++] = wins ? there : index;
    }
    this.#hide();
    for (let at = 0; at < count; at++) this.#beside(late[at] ?? 0);
  }

  /** The point in one of the eight cells around a cell: -1 for an empty cell, -2 beyond the border. */
  #around(cell: number, way: number): number {
    const { width, height } = this.#grid;
    const [right, down] = AROUND[way] ?? [0, 0];
    const column = (cell % width) + right;
    const row = Math.floor(cell / width) + down;
    if (column < 0 || row < 0 || column >= width || row >= height) return -2;
    return this.cells[row * width + column] ?? -1;
  }

  /** Removes points that are seen through the gaps of a nearer surface. */
  #hide(): void {
    const hidden: number[] = [];
    for (let cell = 0; cell < this.cells.length; cell++) {
      const index = this.cells[cell] ?? -1;
      if (index < 0) continue;
      let [before, others] = [0, 0];
      for (let way = 0; way < AROUND.length; way++) {
        const other = this.#around(cell, way);
        if (other < 0) continue;
        others++;
        if (isBehind(this.#range(index), this.#range(other))) before++;
      }
      if (before >= FEWEST_BEFORE && before >= MOSTLY_BEFORE * others) hidden.push(cell);
    }
    this.hidden += hidden.length;
    for (const cell of hidden) this.cells[cell] = -1;
  }

  /** Puts a point whose cell is taken into the nearest free cell beside it, if it lies on the surface of the point that took it. */
  #beside(index: number): void {
    const { width } = this.#grid;
    const [column, row] = [this.#column(index), this.#row(index)];
    const own = this.#cell(index);
    const there = this.cells[own] ?? -1;
    if (there < 0) {
      this.cells[own] = index;
      return;
    }
    if (isBehind(this.#range(index), this.#range(there))) {
      this.hidden++;
      return;
    }
    let [best, least] = [-1, Infinity];
    for (let way = 0; way < AROUND.length; way++) {
      if (this.#around(own, way) !== -1) continue;
      const [right, down] = AROUND[way] ?? [0, 0];
      const [x, y] = [(own % width) + right + 0.5 - column, Math.floor(own / width) + down + 0.5 - row];
      if (x * x + y * y < least) [best, least] = [own + down * width + right, x * x + y * y];
    }
    if (best >= 0) this.cells[best] = index;
  }
}
const AROUND = [
  [-1, -1],
  [0, -1],
  [1, -1],
  [-1, 0],
  [1, 0],
  [-1, 1],
  [0, 1],
  [1, 1],
] as const;
/** Smallest number of nearer neighbours that hide a point; at a straight edge, three of eight are nearer. */
const FEWEST_BEFORE = 4;
/** Smallest share of the neighbours that must be nearer to hide a point. */
const MOSTLY_BEFORE = 0.75;

/** The range image of these points. */
export function buffered(polar: Polar, points: Uint32Array): Image {
  const { azimuth, radius, height, frame } = polar;
  const sphere: Sphere = {
    azimuth,
    elevation: radius.map((each, index) => Math.atan2(height[index] ?? 0, each)),
    range: radius.map((each, index) => Math.sqrt(each * each + (height[index] ?? 0) ** 2)),
  };
  const area = extent(sphere, points);
  const step = stepOf(sphere, points, area);
  const grid: Grid = {
    left: area.left,
    top: area.top,
    step,
    width: Math.max(LEAST_SIDE, Math.floor(area.width / step) + 1),
    height: Math.max(LEAST_SIDE, Math.floor(area.height / step) + 1),
  };
  const buffer = new Buffer(sphere, grid);
  buffer.fill(points);
  const rows = Array.from({ length: grid.height }, (_, row) => ({
    tangent: Math.tan(area.top - (row + 0.5) * step),
    origin: 0,
  }));
  const size = { width: grid.width, height: grid.height };
  return { how: "sphere", ...size, cells: buffer.cells, frame, rows, first: area.left, step, hidden: buffer.hidden };
}
