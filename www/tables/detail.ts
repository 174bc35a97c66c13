/** All results of one cell, with a link to the Lab. */

import { decimals, short } from "../draw/numbers";
import { make } from "../dom";
import { inWords, markOf, whereIs } from "./heat";
import type { Panel } from "./panels";
import type { Cell, Result } from "./protocol";
import type { State } from "./runner";
import { described, obstacle, watchLink } from "./scene";

interface Fact {
  term: string;
  read(result: Result): unknown;
  show(value: number): string;
}

const degrees = (value: number): string => `${short(value)}°`;
const pixels = (value: number): string => `${short(value)} px`;

/** Values of a result besides its main number; each kind of cell has some of them. */
const lines: readonly Fact[] = [
  { term: "Bound, one sigma", read: ({ bound }) => bound, show: degrees },
  { term: "Rotation error", read: (result) => ("rivals" in result ? result.degrees : undefined), show: degrees },
  { term: "As the paper counts", read: ({ error }) => error, show: short },
  { term: "Depth error", read: ({ depthRmse }) => depthRmse, show: pixels },
  { term: "Depth error before", read: ({ before }) => before, show: pixels },
  { term: "after", read: ({ after }) => after, show: pixels },
  { term: "in former holes", read: ({ holes }) => holes, show: pixels },
  { term: "s", read: ({ scale }) => scale, show: (value) => decimals(value, 4) },
  { term: "α", read: ({ alpha }) => alpha, show: (value) => `${decimals(value, 3)}°` },
  { term: "β", read: ({ beta }) => beta, show: (value) => `${decimals(value, 3)}°` },
  { term: "γ", read: ({ gamma }) => gamma, show: (value) => `${decimals(value, 3)}°` },
  { term: "Alternative poses", read: ({ rivals }) => rivals || undefined, show: String },
  {
    term: "Iterations",
    read: ({ iterations }) => (Array.isArray(iterations) ? iterations.length : iterations),
    show: String,
  },
  { term: "Time", read: ({ milliseconds }) => milliseconds, show: (value) => `${decimals(value / 1000, 1)} s` },
];

const pair = (term: string, value: string): HTMLElement[] => [make("dt", {}, term), make("dd", {}, value)];

export class Detail {
  readonly element = make("section", { class: "panel detail", "aria-label": "Selected cell" });
  readonly #title = make("h3");
  readonly #quantity = make("p", { class: "soft" });
  readonly #outcome = make("p", { class: "outcome" });
  readonly #mark = make("p");
  readonly #message = make("p", { class: "soft" });
  readonly #scene = make("p", { class: "soft" });
  readonly #facts = make("dl");
  /** Folded where the screen is small and the detail comes before the grid. */
  readonly #more = make("details", { open: !matchMedia("(max-width: 45rem)").matches }, make("summary", {}, "Details"));
  readonly #watch = make("a", { class: "button primary" }, "Watch this run");
  readonly #obstacle = make("p", { class: "soft" });
  readonly #run = make("button", { type: "button" });
  #cell: Cell | undefined;

  constructor(onRun: (cell: Cell) => void) {
    this.#run.addEventListener("click", () => {
      if (this.#cell) onRun(this.#cell);
    });
    const actions = make("div", { class: "actions" }, this.#watch, this.#run);
    this.#more.append(this.#quantity, this.#message, this.#facts, this.#scene);
    this.element.append(this.#title, this.#outcome, this.#mark, this.#more, this.#obstacle, actions);
  }

  /** Existing elements are only updated, so that no focus or press is lost while a cell runs. */
  show(panel: Panel, cell: Cell | undefined, state: State | undefined): void {
    const moved = this.#cell !== cell;
    this.#cell = cell;
    const result = state?.kind === "done" ? state.result : undefined;
    const value = result && panel.value(result);
    const mark = markOf(state);
    this.#outcome.textContent = cell
      ? value === undefined
        ? inWords(panel, state)
        : `${short(value)}${panel.unit}`
      : "";
    this.#outcome.classList.toggle("error", state?.kind === "failed");
    this.#mark.replaceChildren(
      ...(mark
        ? [make("span", { class: "mark", "data-mark": mark.kind, "aria-hidden": "true" }, mark.glyph), ` ${mark.words}`]
        : []),
    );
    this.#message.textContent = result?.message ?? "";
    this.#run.disabled = state?.kind === "waiting" || state?.kind === "running";
    this.#run.textContent = state?.kind === "done" || state?.kind === "failed" ? "Run again" : "Run";
    if (state?.kind !== "running" || moved) this.#showFacts(panel, cell, result);
    if (moved || !cell) this.#showCell(panel, cell);
  }

  #showCell(panel: Panel, cell: Cell | undefined): void {
    this.#title.textContent = cell ? whereIs(panel, cell) : "No cell selected";
    this.#quantity.textContent = cell
      ? sentence(panel.quantity)
      : "Click a cell to run it; you can then replay it in the Lab.";
    this.#scene.textContent = cell ? `${sentence(described(cell))}.` : "";
    this.element.toggleAttribute("data-empty", cell === undefined);
    const link = cell && watchLink(cell);
    this.#watch.hidden = link === undefined;
    if (link !== undefined) this.#watch.href = link;
    this.#obstacle.textContent = (cell && obstacle(cell)) ?? "";
    this.#run.hidden = cell === undefined;
  }

  #showFacts(panel: Panel, cell: Cell | undefined, result: Result | undefined): void {
    const paper = cell && panel.paper?.(cell);
    const facts = lines.flatMap(({ term, read, show }) => {
      const found = result && read(result);
      return typeof found === "number" && Number.isFinite(found) ? pair(term, show(found)) : [];
    });
    this.#facts.replaceChildren(
      ...(paper === undefined ? [] : pair("In the paper, on its bust", `${short(paper)}${panel.unit}`)),
      ...(result?.status ? pair("Status", result.status) : []),
      ...facts,
    );
  }
}

const sentence = (words: string): string => `${words.charAt(0).toUpperCase()}${words.slice(1)}`;
