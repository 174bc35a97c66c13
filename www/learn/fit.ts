/**
 * Arranges the pictures and plots of a figure so that the whole figure is in view, with the pictures as large as that allows. The style sheet
 * uses the result only where the figure stays beside the text: elsewhere the page scrolls.
 */

/** Columns of the grid, which pictures and plots share. */
const COLUMNS = 12;
const PICTURES_PER_ROW = [2, 3, 4, 6] as const;
/** Largest picture as a share of the window's height: a larger one leaves no room for its controls. */
const LARGEST = 0.38;
/** Smallest width of a picture, height of a plot and width of a plot beside a picture or another plot, px. */
const LEAST_PICTURE = 112;
const LEAST_PLOT = 130;
const NARROWEST_PLOT = 260;
/** Height of a plot for its width, and the largest one, px. */
const PLOT_SHAPE = 0.5;
const LARGEST_PLOT = 280;
/** Browsers round heights up, px. */
const ROUNDING = 1;
/** How much larger pictures in several rows have to be than those in one row, which are easier to compare. */
const ROW_BONUS = 1.15;

interface Arrangement {
  perRow: number;
  /** Columns of each plot. */
  spans: number[];
  rows: number;
  /** Rows that hold only plots. */
  plotRows: number;
}

interface Sizes {
  side: number;
  plot: number;
}

/** The columns of the plots beside and below the pictures; undefined if a picture would be alone in its row. */
function arranged(pictures: number, plots: number, perRow: number, widthOf: (span: number) => number) {
  const last = pictures % perRow;
  const rows = Math.ceil(pictures / perRow);
  const free = last === 0 ? 0 : COLUMNS - last * (COLUMNS / perRow);
  const fits = (span: number) => Number.isInteger(span) && widthOf(span) >= NARROWEST_PLOT;
  const whole = (count: number) => {
    const span = COLUMNS / count;
    return fits(span) ? Array<number>(count).fill(span) : Array<number>(count).fill(COLUMNS);
  };
  const arrangement = (spans: number[], beside: number): Arrangement => {
    const below = spans.slice(beside).reduce((sum, span) => sum + span, 0) / COLUMNS;
    return { perRow, spans, rows, plotRows: below };
  };
  if (free > 0 && plots > 0 && fits(free / plots)) return arrangement(Array<number>(plots).fill(free / plots), plots);
  if (free > 0 && plots > 0 && fits(free)) return arrangement([free, ...whole(plots - 1)].slice(0, plots), 1);
  return last === 1 && pictures > 1 ? undefined : arrangement(whole(plots), 0);
}

export class Fit {
  readonly #box: HTMLElement;
  readonly #panels: HTMLElement;
  #seen = "";
  #frame = 0;

  /** `box` scrolls if its content is higher than the window; `panels` holds the pictures and plots. */
  constructor(box: HTMLElement, panels: HTMLElement) {
    this.#box = box;
    this.#panels = panels;
    // In the next frame, because a size that changes while sizes are reported is an error of the page.
    const observer = new ResizeObserver(() => {
      cancelAnimationFrame(this.#frame);
      this.#frame = requestAnimationFrame(() => this.now());
    });
    for (const part of [box, ...box.children]) observer.observe(part);
  }

  /** Fits the figure, unless all that matters is as it was. */
  now(): void {
    // Zero while the figure is not on the page.
    if (this.#panels.clientWidth === 0 || getComputedStyle(this.#box).maxHeight === "none") return;
    const seen = this.#look();
    if (seen === this.#seen) return;
    const found = this.#best();
    if (found) this.#apply(...found);
    this.#seen = this.#look();
  }

  /** The sizes of everything except pictures and plots. */
  #look(): string {
    const others = [...this.#box.children].filter((part) => part !== this.#panels);
    const words = this.#panels.querySelectorAll(".learn-panel > :not(.learn-place, .learn-plot-box)");
    return [innerHeight, this.#panels.clientWidth, ...[...others, ...words].map((part) => part.clientHeight)].join();
  }

  #best(): [Arrangement, Sizes] | undefined {
    const plots = this.#plots.length;
    const pictures = this.#panels.childElementCount - plots;
    const gap = parseFloat(getComputedStyle(this.#panels).columnGap) || 0;
    const widthOf = (span: number) => ((this.#panels.clientWidth + gap) / COLUMNS) * span - gap;
    let best: { choice: [Arrangement, Sizes]; worth: number } | undefined;
    for (const perRow of PICTURES_PER_ROW) {
      const arrangement = arranged(pictures, plots, perRow, widthOf);
      if (!arrangement || (best && widthOf(COLUMNS / perRow) < LEAST_PICTURE)) continue;
      const { room, ...sizes } = this.#sized(arrangement, widthOf);
      const worth = room * (arrangement.rows === 1 ? ROW_BONUS : 1);
      if (!best || worth > best.worth) best = { choice: [arrangement, sizes], worth };
    }
    return best?.choice;
  }

  /**
   * The largest sizes that leave the whole figure in view: first the wanted ones, then less by what sticks out. `room` is the side that
   * pictures may have, which can be less than the smallest that is shown.
   */
  #sized(arrangement: Arrangement, widthOf: (span: number) => number): Sizes & { room: number } {
    const { perRow, rows, plotRows, spans } = arrangement;
    const side = Math.min(widthOf(COLUMNS / perRow), LARGEST * innerHeight);
    const wanted = Math.min(LARGEST_PLOT, PLOT_SHAPE * Math.max(0, ...spans.map(widthOf)));
    this.#apply(arrangement, { side, plot: wanted });
    const over = Math.max(0, this.#box.scrollHeight - this.#box.clientHeight);
    const height = rows * side + plotRows * wanted - over;
    const roomWith = (plot: number) => Math.min(side, (height - plotRows * plot) / rows - ROUNDING);
    const fair = Math.max(LEAST_PLOT, wanted * (height / (height + over)));
    // Where pictures would be too small, plots give way.
    const plot = roomWith(fair) < LEAST_PICTURE ? Math.min(fair, LEAST_PLOT) : fair;
    const room = roomWith(plot);
    return { side: Math.max(LEAST_PICTURE, Math.floor(room)), plot: Math.floor(plot), room };
  }

  get #plots(): HTMLElement[] {
    return [...this.#panels.querySelectorAll<HTMLElement>(":scope > .learn-wide")];
  }

  #apply({ perRow, spans, plotRows }: Arrangement, { side, plot }: Sizes): void {
    const { style } = this.#panels;
    this.#panels.dataset.fitted = "";
    style.setProperty("--picture-span", String(COLUMNS / perRow));
    style.setProperty("--side", `${side}px`);
    for (const [at, panel] of this.#plots.entries()) {
      // A plot beside a picture is as high as the picture, but not higher than wide.
      const isBeside = plotRows === 0 || (spans[0] !== spans.at(-1) && at === 0);
      panel.style.setProperty("--plot-span", String(spans[at] ?? COLUMNS));
      panel.style.setProperty("--plot", `${isBeside ? Math.min(side, panel.clientWidth) : plot}px`);
    }
  }
}
