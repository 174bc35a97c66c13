/** A table as a grid of buttons, coloured by their numbers. One of them is in the tab order; arrow keys move to the others. */

import { short } from "../draw/numbers";
import { make } from "../dom";
import type { Axis, Panel } from "./panels";
import { isConfidentlyWrong, isFound, type Cell } from "./protocol";
import { colourOf, wantsBlack } from "./ramp";
import type { State } from "./runner";

/** The status of a result: a shape, and the same in words. */
export interface Mark {
  kind: "ambiguous" | "doubted" | "lost" | "stopped" | "wrong";
  glyph: string;
  words: string;
}

export const marks: readonly Mark[] = [
  { kind: "ambiguous", glyph: "?", words: "ambiguous: other poses fit equally well" },
  { kind: "doubted", glyph: "~", words: "correct (within 3°) but flagged as uncertain" },
  { kind: "lost", glyph: "×", words: "lost, and flagged as such" },
  { kind: "stopped", glyph: "=", words: "stopped at the maximum number of iterations" },
  { kind: "wrong", glyph: "!", words: "more than 3° off and not flagged" },
];

/** A wrong pose that is not flagged is worse than a flagged one, so its mark has priority. */
export function markOf(state: State | undefined): Mark | undefined {
  if (state?.kind !== "done") return undefined;
  const { result } = state;
  // A pose that was not estimated is neither right nor wrong. A loop without a stopping rule always ends at its maximum.
  if (!("rivals" in result)) return undefined;
  const kind = isConfidentlyWrong(result)
    ? "wrong"
    : result.status === "max-iterations"
      ? "stopped"
      : result.status === "lost" && isFound(result)
        ? "doubted"
        : result.status;
  return marks.find((mark) => mark.kind === kind);
}

/** The text of a state for screen readers. */
export function inWords(panel: Panel, state: State | undefined): string {
  switch (state?.kind) {
    case undefined:
      return "not run";
    case "waiting":
      return "waiting";
    case "running":
      return `running, ${state.words}`;
    case "failed":
      return `failed: ${state.message}`;
    case "done": {
      const value = panel.value(state.result);
      const mark = markOf(state);
      return `${value === undefined ? "no value" : `${brief(value)}${panel.unit}`}${mark ? `, ${mark.words}` : ""}`;
    }
  }
}

/** A cell's place in its table. */
export const whereIs = ({ down, across, where }: Panel, cell: Cell): string =>
  where?.(cell) ?? [down, across].map((axis) => `${axis.label} ${axis.name(axis.of(cell))}`.trim()).join(", ");

const values = (axis: Axis, cells: readonly Cell[]): (string | number)[] => [
  ...new Set(cells.map((cell) => axis.of(cell))),
];

/** Numbers are sorted by size, words in the protocol's order. */
const ordered = (axis: Axis, cells: readonly Cell[]): (string | number)[] => {
  const all = values(axis, cells);
  return all.every((value) => typeof value === "number") ? all.sort((a, b) => a - b) : all;
};

export interface HeatHooks {
  onPress(cell: Cell): void;
  /** Called when the heading of a row is pressed. */
  onRow(cells: readonly Cell[]): void;
}

export class Heat {
  readonly element: HTMLElement;
  readonly #panel: Panel;
  readonly #buttons: (HTMLButtonElement | undefined)[][] = [];
  readonly #byId = new Map<string, { cell: Cell; button: HTMLButtonElement }>();

  constructor(panel: Panel, cells: readonly Cell[], { onPress, onRow }: HeatHooks) {
    this.#panel = panel;
    const { down, across } = panel;
    const rows = ordered(down, cells);
    const columns = ordered(across, cells);
    const corner = make(
      "th",
      { scope: "col" },
      down.label,
      ...(across.label ? [make("span", { class: "soft" }, ` \\ ${across.label}`)] : []),
    );
    const head = make(
      "thead",
      {},
      make("tr", {}, corner, ...columns.map((column) => make("th", { scope: "col" }, across.name(column)))),
    );
    const body = make("tbody");
    for (const row of rows) {
      const line = columns.map((column) => {
        const cell = cells.find((each) => down.of(each) === row && across.of(each) === column);
        return cell && this.#button(cell, onPress);
      });
      const heading = make(
        "button",
        {
          type: "button",
          class: "quiet",
          tabindex: -1,
          "aria-label": `Run row ${down.label} ${down.name(row)}`,
          title: "Run this row",
        },
        down.name(row),
      );
      this.#buttons.push([heading, ...line]);
      heading.addEventListener("click", () => onRow(cells.filter((cell) => down.of(cell) === row)));
      body.append(
        make("tr", {}, make("th", { scope: "row" }, heading), ...line.map((button) => make("td", {}, button ?? ""))),
      );
    }
    const attributes = {
      class: "heat",
      role: "grid",
      "aria-label": `${panel.tab}: ${panel.quantity}`,
      style: `--columns: ${columns.length}`,
    };
    this.element = make("table", { ...attributes, "data-two-lines": panel.paper !== undefined }, head, body);
    this.element.addEventListener("keydown", (event) => this.#move(event));
    const [first] = this.#byId.values();
    if (first) first.button.tabIndex = 0;
  }

  show(id: string, state: State | undefined): void {
    const found = this.#byId.get(id);
    if (!found) return;
    const { cell, button } = found;
    const value = state?.kind === "done" ? this.#panel.value(state.result) : undefined;
    const mark = markOf(state);
    button.dataset.state = state?.kind ?? "idle";
    button.toggleAttribute("data-absent", state?.kind === "done" && value === undefined);
    button.style.setProperty("--heat", value === undefined ? "transparent" : colourOf(value));
    button.style.setProperty("--on-heat", value === undefined ? "" : wantsBlack(value) ? "#000" : "#fff");
    if (value === undefined) delete button.dataset.value;
    else button.dataset.value = String(value);
    const paper = this.#panel.paper?.(cell);
    button.replaceChildren(
      make("span", { class: "heat-value" }, caption(state, value)),
      ...(paper === undefined ? [] : [make("span", { class: "heat-paper", "data-shown": short(paper) })]),
      ...(mark ? [make("span", { class: "mark", "data-mark": mark.kind, "aria-hidden": "true" }, mark.glyph)] : []),
    );
    const where = whereIs(this.#panel, cell);
    const reference = paper === undefined ? "" : `; the paper: ${short(paper)}${this.#panel.unit}`;
    button.setAttribute("aria-label", `${where}: ${inWords(this.#panel, state)}${reference}`);
    button.title = `${inWords(this.#panel, state)}${reference}`;
  }

  /** The chosen cell is the one in the tab order. */
  choose(id: string | undefined): void {
    const chosen = id === undefined ? undefined : this.#byId.get(id)?.button;
    for (const { button } of this.#byId.values()) button.setAttribute("aria-pressed", String(button === chosen));
    if (chosen) this.#enter(chosen);
  }

  #button(cell: Cell, onPress: (cell: Cell) => void): HTMLButtonElement {
    const button = make("button", {
      type: "button",
      class: "heat-cell",
      tabindex: -1,
      "data-cell": cell.id,
      "aria-pressed": "false",
    });
    button.addEventListener("click", () => onPress(cell));
    this.#byId.set(cell.id, { cell, button });
    return button;
  }

  #enter(button: HTMLButtonElement): void {
    for (const each of this.#buttons.flat()) if (each) each.tabIndex = -1;
    button.tabIndex = 0;
  }

  #move(event: KeyboardEvent): void {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    const row = this.#buttons.findIndex((line) => line.some((button) => button === event.target));
    const column = this.#buttons[row]?.findIndex((button) => button === event.target) ?? -1;
    if (!step || column < 0) return;
    event.preventDefault();
    const target = this.#buttons[row + (step[0] ?? 0)]?.[column + (step[1] ?? 0)];
    if (!target) return;
    this.#enter(target);
    target.focus();
  }
}

/** A missing result is a dash, never a zero. */
/** In the narrow cells of a phone an exponent has room for one digit; the text for screen readers agrees with the visible one. */
const brief = (value: number): string => (value > 0 && value < 1e-3 ? value.toExponential(0) : short(value));

function caption(state: State | undefined, value: number | undefined): string {
  switch (state?.kind) {
    case "waiting":
      return "···";
    case "running":
      return state.share || "···";
    case "failed":
      return "failed";
    case "done":
      return value === undefined ? "none" : brief(value);
    case undefined:
      return "–";
  }
}
