/**
 * A range image of points in no rows: a z-buffer over azimuths and elevations at the cloud's own density.
 *
 * For scanners without rows (Livox, MEMS) and for clouds of many sweeps. The nearest point of a cell wins; others of its surface move to a
 * free cell beside it, and what lies behind the surfaces around it, seen through the gaps between their points, is hidden.
 */
import type { Image } from "./image.js";
import type { Polar } from "./frame.js";

const degrees = Math.PI / 180;
/** Finest and coarsest cell that is tried. */
const FINEST = 0.02 * degrees;
const COARSEST = 4 * degrees;
/** Points to each cell that holds any, of points at random that are two thirds as many as the cells they fall on. */
const FILLED = 1.37;
const MOST_SIDE = 4096;
const LEAST_SIDE = 4;
/** Points are of one surface where their ranges differ by less than this share of them .. */
const ONE_SURFACE = 0.02;
/** .. or by this, metres. */
const ONE_SURFACE_LEAST = 0.03;
/** Steps of a bisection in the logarithm. */
const STEPS = 14;

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

/** Azimuths and elevations of these points, and how far they reach. */
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

/** Points to each cell that holds any. */
function filling(sphere: Sphere, points: Uint32Array, { left, top, width }: Extent, step: number): number {
  const columns = Math.floor(width / step) + 1;
  const cells = new Set<number>();
  for (const index of points) {
    const column = Math.floor(((sphere.azimuth[index] ?? 0) - left) / step);
    const row = Math.floor((top - (sphere.elevation[index] ?? 0)) / step);
    cells.add(row * columns + column);
  }
  return points.length / cells.size;
}

/** Points that suffice for the density, of those that lie around any of them. */
function stepOf(sphere: Sphere, points: Uint32Array, area: Extent): number {
  const least = Math.max(FINEST, area.width / (MOST_SIDE - 1), area.height / (MOST_SIDE - 1));
  let [low, high] = [Math.log(least), Math.log(COARSEST)];
  for (let round = 0; round < STEPS; round++) {
    const middle = (low + high) / 2;
    if (filling(sphere, points, area, Math.exp(middle)) < FILLED) low = middle;
    else high = middle;
  }
  return Math.exp(high);
}

/** A z-buffer that is being filled. */
class Buffer {
  readonly cells: Int32Array;
  hidden = 0;
  readonly #sphere: Sphere;
  readonly #grid: { left: number; top: number; step: number; width: number; height: number };

  constructor(sphere: Sphere, grid: { left: number; top: number; step: number; width: number; height: number }) {
    this.#sphere = sphere;
    this.#grid = grid;
    this.cells = new Int32Array(grid.width * grid.height).fill(-1);
  }

  #range(index: number): number {
    return this.#sphere.range[index] ?? 0;
  }

  #place(index: number): [column: number, row: number] {
    const { left, top, step, width, height } = this.#grid;
    const { azimuth, elevation } = this.#sphere;
    const inside = (value: number, size: number) => Math.min(size - 1e-6, Math.max(0, value));
    return [
      inside(((azimuth[index] ?? 0) - left) / step, width),
      inside((top - (elevation[index] ?? 0)) / step, height),
    ];
  }

  fill(points: Uint32Array): void {
    const { width } = this.#grid;
    const late: number[] = [];
    for (const index of points) {
      const [column, row] = this.#place(index);
      const cell = Math.floor(row) * width + Math.floor(column);
      const there = this.cells[cell] ?? -1;
      if (there < 0 || this.#range(index) < this.#range(there)) this.cells[cell] = index;
      else late.push(index);
      if (there >= 0 && this.cells[cell] === index) late.push(there);
    }
    this.#hide();
    for (const index of late) this.#beside(index);
  }

  /** Indices of the eight cells around one, -1 beyond the border. */
  #around(cell: number): number[] {
    const { width, height } = this.#grid;
    const [column, row] = [cell % width, Math.floor(cell / width)];
    return AROUND.map(([right, down]) => {
      const [x, y] = [column + right, row + down];
      return x < 0 || y < 0 || x >= width || y >= height ? -1 : y * width + x;
    });
  }

  /** Takes away what is seen through the gaps of a nearer surface. */
  #hide(): void {
    const hidden: number[] = [];
    this.cells.forEach((index, cell) => {
      if (index < 0) return;
      const others = this.#around(cell).flatMap((at) =>
        at >= 0 && (this.cells[at] ?? -1) >= 0 ? [this.cells[at] ?? 0] : [],
      );
      const before = others.filter((other) => isBehind(this.#range(index), this.#range(other))).length;
      if (before >= FEWEST_BEFORE && before >= MOSTLY_BEFORE * others.length) hidden.push(cell);
    });
    this.hidden += hidden.length;
    for (const cell of hidden) this.cells[cell] = -1;
  }

  /** A point whose cell is taken: into the nearest free cell beside it, if it belongs to the surface that took it. */
  #beside(index: number): void {
    const { width } = this.#grid;
    const [column, row] = this.#place(index);
    const own = Math.floor(row) * width + Math.floor(column);
    const there = this.cells[own] ?? -1;
    if (there >= 0 && isBehind(this.#range(index), this.#range(there))) {
      this.hidden++;
      return;
    }
    const far = (cell: number) => Math.hypot((cell % width) + 0.5 - column, Math.floor(cell / width) + 0.5 - row);
    let best = there < 0 ? own : -1;
    if (best < 0)
      for (const cell of this.#around(own))
        if (cell >= 0 && this.cells[cell] === -1 && (best < 0 || far(cell) < far(best))) best = cell;
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
/** Neighbours that are nearer, for a point to be behind their surface: at a straight edge three of eight are. */
const FEWEST_BEFORE = 4;
const MOSTLY_BEFORE = 0.75;

/** The range image of these points. */
export function buffered(polar: Polar, points: Uint32Array): Image {
  const { azimuth, radius, height, frame } = polar;
  const sphere: Sphere = {
    azimuth,
    elevation: radius.map((each, index) => Math.atan2(height[index] ?? 0, each)),
    range: radius.map((each, index) => Math.hypot(each, height[index] ?? 0)),
  };
  const area = extent(sphere, points);
  const step = stepOf(sphere, points, area);
  const grid = {
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
