/**
 * The columns of a spinning scanner's range image: azimuths in steps of the scanner's pulses, with each point in the cell of its row and azimuth.
 *
 * A scanner's clock is coarse. Of two points that fall into one cell, one moves to a free neighbour that keeps the order, so that neither is
 * lost.
 */
import { MOST_SIDE } from "../formats/limits.js";
import { median } from "../statistics.js";
import { DEGREE, TURN } from "./frame.js";
import type { Image } from "./image.js";
import type { Rows } from "./rows.js";

/** Smallest number of columns of a full turn. */
const FEWEST_COLUMNS = 90;
/** Azimuths that differ by less, radians, belong to one pulse. */
const ONE_PULSE = 0.008 * DEGREE;
/** Number of consecutive steps whose mean is the pace, so that the ticks of the clock average out. */
const WINDOW = 16;
/** A step is a gap if it is longer than this number of usual steps. */
const GAP = 2.5;
/** The quantile of the rows' paces, from the finest, that serves as the pace of the scan. */
const FINEST = 0.2;
/** The pace of a scan whose rows are too short to measure it, radians. */
const USUAL_PACE = 0.2 * DEGREE;

/**
 * Width of a column as a share of the pace: finer columns leave room for pulses that come early. Set on one frame of KITTI, where 0.95 to
 * 0.98 keep all points.
 */
const SLACK = 0.98;

/** The points of each row in order of azimuth. */
function sorted({ row, rows, polar: { azimuth } }: Rows): number[][] {
  const members: number[][] = rows.map(() => []);
  row.forEach((number, index) => members[number]?.push(index));
  for (const list of members) list.sort((a, b) => (azimuth[a] ?? 0) - (azimuth[b] ?? 0));
  return members;
}

/** Radians from one pulse of a row to the next; undefined for a row with too few points. */
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
    if (!window.every((step) => step < GAP * usual)) continue;
    // A step of twice the usual length contains a pulse without a return.
    const pulses = window.reduce((sum, step) => sum + Math.max(1, Math.round(step / usual)), 0);
    means.push(window.reduce((sum, step) => sum + step, 0) / pulses);
  }
  return means.length > 0 ? median(means) : usual;
}

/** The width of a column, radians, which divides a turn into whole columns. */
function stepOf(members: number[][], azimuth: Float64Array): number {
  const paces = members.flatMap((list) => paceOf(list.map((index) => azimuth[index] ?? 0)) ?? []).sort((a, b) => a - b);
  const pace = paces[Math.floor(FINEST * paces.length)] ?? USUAL_PACE;
  return TURN / Math.min(MOST_SIDE, Math.max(FEWEST_COLUMNS, Math.round(TURN / (SLACK * pace))));
}

/** Assigns the points of one row to cells in the order of their azimuths, each at most about one cell from its azimuth. */
class Line {
  readonly cells: Int32Array;
  /** The cell that was filled last. */
  #last = -1;
  readonly #due: (index: number) => number;
  readonly #range: (index: number) => number;

  constructor(width: number, due: (index: number) => number, range: (index: number) => number) {
    this.cells = new Int32Array(width).fill(-1);
    this.#due = due;
    this.#range = range;
  }

  #set(cell: number, index: number): void {
    this.cells[cell] = index;
    this.#last = cell;
  }

  #fits(cell: number, index: number): boolean {
    return cell < this.cells.length && Math.abs(cell + 0.5 - this.#due(index)) <= FARTHEST_SHIFT;
  }

  /** Puts a point into its cell; points have to come in the order of their azimuths. */
  put(index: number): void {
    const cell = Math.min(this.cells.length - 1, Math.max(0, Math.floor(this.#due(index))));
    const before = this.cells[this.#last] ?? -1;
    // A pulse with two returns keeps the nearer one.
    const isOnePulse = before >= 0 && this.#due(index) - this.#due(before) < ONE_PULSE_SHARE;
    if (!isOnePulse && cell > this.#last) this.#set(cell, index);
    else if (!isOnePulse && this.#fits(this.#last, index) && this.#shiftBack()) this.#set(this.#last, index);
    else if (!isOnePulse && this.#fits(this.#last + 1, index)) this.#set(this.#last + 1, index);
    else if (this.#range(index) < this.#range(before)) this.#set(this.#last, index);
  }

  /** Frees the cell that was filled last by shifting the points before it back by one, down to the first free cell. */
  #shiftBack(): boolean {
    let free = this.#last;
    while (free >= 0 && this.cells[free] !== -1 && this.#last - free < MOST_SHIFTED) free--;
    if (free < 0 || this.cells[free] !== -1) return false;
    for (let at = free; at < this.#last; at++) if (!this.#fits(at, this.cells[at + 1] ?? -1)) return false;
    for (let at = free; at < this.#last; at++) this.cells[at] = this.cells[at + 1] ?? -1;
    return true;
  }
}
/** Azimuths that differ by less, as a share of a cell, belong to one pulse. */
const ONE_PULSE_SHARE = 0.04;
/** Largest number of cells that shift to make room for a point. */
const MOST_SHIFTED = 64;
/** Largest number of cells between a point's azimuth and the middle of its cell; a larger shift would misplace its neighbours. */
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
