/** The values at the selected pixel, in a card of fixed size over the page, away from the pointer. */

import { byId, make } from "../dom";
import type { Opened, Probed } from "../engine/protocol";
import { decimals } from "./numbers";
import type { Probe } from "./probe";

type Units = Opened["units"];

interface Line {
  name: string;
  /** The unit of its numbers. */
  unit(units: Units): string;
  read(probed: Probed): readonly number[] | null | undefined;
}

const LOG = () => "ln";
const lines: readonly Line[] = [
  { name: "log colour", unit: LOG, read: ({ log }) => log },
  { name: "predicted", unit: LOG, read: ({ predicted }) => predicted },
  { name: "residual", unit: LOG, read: ({ values }) => values.residual },
  { name: "normal", unit: () => "", read: ({ values }) => values.imageNormals },
  { name: "prior", unit: () => "", read: ({ prior }) => prior },
  { name: "depth", unit: ({ image }) => image, read: ({ values }) => values.imageDepth },
  { name: "refined depth", unit: ({ depth }) => depth, read: ({ values }) => values.refinedDepth },
];

const DIGITS = 3;
/** Width of a window, pixels, below which the card covers more than half of it. */
const NARROW = 720;

export class Card {
  readonly #element = byId("probe", HTMLElement);
  readonly #where = make("p", { class: "where" });
  readonly #rows: readonly { line: Line; unit: HTMLElement; cells: readonly HTMLElement[] }[];
  readonly #probe: Probe;
  units: Units = { image: "px", depth: "px" };

  constructor(probe: Probe) {
    this.#probe = probe;
    this.#rows = lines.map((line) => ({
      line,
      unit: make("td", { class: "unit" }),
      cells: [make("td"), make("td"), make("td")],
    }));
    const rows = this.#rows.map(({ line, unit, cells }) =>
      make("tr", {}, make("th", { scope: "row" }, line.name), ...cells, unit),
    );
    this.#element.append(this.#where, make("table", {}, make("tbody", {}, ...rows)));
    probe.listen(() => this.#show());
    // The card lies away from the selected pixel, so that it never covers the pixel.
    document.addEventListener("pointermove", ({ clientX, clientY }) => this.#moveAway(clientX, clientY));
    // A touch sends no leave event when it ends, and scrolls if it began on a picture.
    document.addEventListener("pointercancel", () => probe.point(null));
    document.addEventListener("pointerdown", ({ target }) => {
      if (!(target instanceof HTMLCanvasElement)) probe.point(null);
    });
    document.addEventListener("focusin", ({ target }) => {
      if (!(target instanceof HTMLCanvasElement)) return;
      const { left, top, width, height } = target.getBoundingClientRect();
      this.#moveAway(left + width / 2, top + height / 2);
    });
  }

  #moveAway(x: number, y: number): void {
    this.#element.dataset.x = x < innerWidth / 2 ? "right" : "left";
    // The card avoids the top, where buttons and status are, unless there is no room beside the pointer.
    this.#element.dataset.y = innerWidth < NARROW && y >= innerHeight / 2 ? "top" : "bottom";
  }

  #show(): void {
    const { answer } = this.#probe;
    const [mine, theirs] = [this.#probe.at("image"), this.#probe.at("depth")];
    this.#element.hidden = !mine && !theirs;
    if (!answer) return;
    const name = (pixel: typeof mine) => (pixel ? `${pixel.column}, ${pixel.row}` : "none");
    this.#where.textContent = `image ${name(mine)}; depth map ${name(theirs)}`;
    for (const { line, unit, cells } of this.#rows) {
      const values = line.read(answer) ?? [];
      unit.textContent = line.unit(this.units);
      // A single number is aligned with the last of three.
      const first = values.length === 1 ? 2 : 0;
      cells.forEach((cell, c) => (cell.textContent = c < first ? "" : decimals(values[c - first], DIGITS)));
    }
  }
}
