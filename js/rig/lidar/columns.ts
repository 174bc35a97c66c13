/**
 * Columns of a spinning scanner's range image: azimuths in steps of its own pace, and each point in the cell of its row and azimuth.
 *
 * A scanner's clock is coarse: of two points that are due in one cell one moves to a free neighbour, in their order, so that neither is lost.
 */
import type { Image } from "./image.js";
import { type Rows, median } from "./rows.js";

const TURN = 2 * Math.PI;
const degrees = Math.PI / 180;
/** Columns of a full turn, at most: the widest image of the package. */
const MOST_COLUMNS = 4096;
const FEWEST_COLUMNS = 90;
/** Azimuths nearer to each other than this are those of one pulse. */
const ONE_PULSE = 0.008 * degrees;
/** Steps in a row of which the mean is the pace: a clock's ticks average out. */
const WINDOW = 16;
/** A step longer than this many usual ones is a gap. */
const GAP = 2.5;
/** Rows finer than the usual one have a say: the pace is that of the finest fifth of the rows. */
const FINEST = 0.2;

/** Columns are finer than the pace by a fiftieth, so that pulses that come early find room. Set on one KITTI frame: 0.95 to 0.98 keep all. */
const SLACK = 0.98;

/** Members of each row in order of azimuth. */
function sorted({ row, rows, polar: { azimuth } }: Rows): number[][] {
  const members: number[][] = rows.map(() => []);
  row.forEach((number, index) => members[number]?.push(index));
  for (const list of members) list.sort((a, b) => (azimuth[a] ?? 0) - (azimuth[b] ?? 0));
  return members;
}

/** Radians from one pulse of a row to the next; nothing for a row of too few. */
function paceOf(azimuths: number[]): number | undefined {
  const steps = azimuths
    .slice(1)
    .map((azimuth, index) => azimuth - (azimuths[index] ?? 0))
    .filter((step) => step > ONE_PULSE);
  if (steps.length < 2 * WINDOW) return undefined;
  const usual = median(steps);
  const means: number[] = [];
  for (let from = 0; from + WINDOW <= steps.length; from += WINDOW / 2) {
    const window = steps.slice(from, from + WINDOW);
    if (window.every((step) => step < GAP * usual)) means.push(window.reduce((sum, step) => sum + step, 0) / WINDOW);
  }
  return means.length > 0 ? median(means) : usual;
}

/** Radians of a column: a whole number of them makes a turn. */
function stepOf(members: number[][], azimuth: Float64Array): number {
  const paces = members.flatMap((list) => paceOf(list.map((index) => azimuth[index] ?? 0)) ?? []).sort((a, b) => a - b);
  const pace = paces[Math.floor(FINEST * paces.length)] ?? 0.2 * degrees;
  return TURN / Math.min(MOST_COLUMNS, Math.max(FEWEST_COLUMNS, Math.round(TURN / (SLACK * pace))));
}

/** A row's points in its cells, each at most a cell from where it belongs. */
class Line {
  readonly cells: Int32Array;
  readonly #due: (index: number) => number;
  readonly #range: (index: number) => number;

  constructor(width: number, due: (index: number) => number, range: (index: number) => number) {
    this.cells = new Int32Array(width).fill(-1);
    this.#due = due;
    this.#range = range;
  }

  #isFree(cell: number): boolean {
    return cell >= 0 && cell < this.cells.length && this.cells[cell] === -1;
  }

  /** Points come in the order of their azimuths. */
  put(index: number): void {
    const cell = Math.min(this.cells.length - 1, Math.max(0, Math.floor(this.#due(index))));
    // A pulse with two returns has one place, and the nearer of them.
    const before = this.cells[cell] === -1 ? (this.cells[cell - 1] ?? -1) : (this.cells[cell] ?? -1);
    if (before >= 0 && this.#due(index) - this.#due(before) < ONE_PULSE_SHARE) {
      const place = this.cells[cell] === before ? cell : cell - 1;
      if (this.#range(index) < this.#range(before)) this.cells[place] = index;
      return;
    }
    if (this.#isFree(cell)) this.cells[cell] = index;
    else if (!this.#shiftBack(cell, index)) {
      if (this.#isFree(cell + 1)) this.cells[cell + 1] = index;
      else this.#nearest(cell, index);
    }
  }

  /** Makes room at a cell by moving what is there back by one, and what is there in turn. */
  #shiftBack(cell: number, index: number): boolean {
    let free = cell;
    while (free >= 0 && this.cells[free] !== -1 && cell - free < MOST_SHIFTED) free--;
    if (!this.#isFree(free)) return false;
    for (let at = free; at < cell; at++) {
      const moved = this.cells[at + 1] ?? -1;
      // Farther than a cell from where it belongs a point would misplace its neighbours.
      if (Math.abs(at + 0.5 - this.#due(moved)) > FARTHEST_SHIFT) return false;
    }
    for (let at = free; at < cell; at++) this.cells[at] = this.cells[at + 1] ?? -1;
    this.cells[cell] = index;
    return true;
  }

  #nearest(cell: number, index: number): void {
    const there = this.cells[cell] ?? -1;
    if (this.#range(index) < this.#range(there)) this.cells[cell] = index;
  }
}
/** Share of a cell within which two azimuths are one pulse's. */
const ONE_PULSE_SHARE = 0.04;
/** Cells that may move to make room. */
const MOST_SHIFTED = 12;
/** Cells from a point's azimuth to the middle of its cell, at most. */
const FARTHEST_SHIFT = 1.1;

/** The range image of a full turn, with the seam behind `forward`. */
export function spun(scan: Rows): Image {
  const { polar, rows } = scan;
  const { azimuth, radius, height } = polar;
  const members = sorted(scan);
  const step = stepOf(members, azimuth);
  const width = Math.round(TURN / step);
  const cells = new Int32Array(width * rows.length);
  members.forEach((list, number) => {
    const line = new Line(
      width,
      (index) => ((azimuth[index] ?? 0) + Math.PI) / step,
      (index) => Math.hypot(radius[index] ?? 0, height[index] ?? 0),
    );
    for (const index of list) line.put(index);
    cells.set(line.cells, number * width);
  });
  return {
    how: scan.how,
    width,
    height: rows.length,
    cells,
    frame: polar.frame,
    rows,
    first: -Math.PI,
    step,
    hidden: 0,
  };
}
