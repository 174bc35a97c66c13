/** The Tables: every table and figure that can be made from built-in scenes, computed in the browser cell by cell. */

import "../style/heat.css";
import "../style/tables.css";
import { make } from "../dom";
import { saveJson } from "../save";
import type { Curves } from "./curves";
import { Detail } from "./detail";
import { Heat } from "./heat";
import { legend } from "./legend";
import { elsewhere, panels, type Panel } from "./panels";
import { rowsOf, type Cell } from "./protocol";
import { Runner } from "./runner";
import { summary } from "./summary";

/** The choices in a table, kept while other tables are shown. */
interface Chosen {
  values: Record<string, string>;
  cell: Cell | undefined;
}

const first = panels[0] as Panel;
const optionsOf = ({ cells }: Panel, key: string): string[] => [...new Set(cells.map(({ row }) => String(row[key])))];

export class TablesPage {
  readonly #runner = new Runner((id) => this.#update(id));
  readonly #chosen = new Map<Panel, Chosen>();
  readonly #tabs = new Map<Panel, { button: HTMLButtonElement; count: HTMLElement }>();
  readonly #side = make("nav", { class: "tabs", "aria-label": "Tables and figures" });
  readonly #main = make("div", { class: "tables-main" });
  readonly #detail = new Detail((cell) => this.#runner.runFirst(cell));
  readonly #curvesBox = make("div");
  readonly #summary = make("div", { class: "summary" });
  readonly #progress = make("p", { role: "status", class: "progress" });
  readonly #runAll = make("button", { type: "button", class: "primary" }, "Run all");
  readonly #stop = make("button", { type: "button" }, "Stop");
  #panel = first;
  #heat: Heat | undefined;
  #curves: Curves | undefined;
  #open = false;

  constructor(parent: HTMLElement) {
    for (const panel of panels) this.#chosen.set(panel, { values: initial(panel), cell: undefined });
    this.#runAll.addEventListener("click", () => this.#runner.runAll(this.#shown()));
    this.#stop.addEventListener("click", () => this.#runner.stop());
    this.#side.append(...panels.map((panel) => this.#tab(panel)));
    parent.append(intro(), this.#side, this.#main, this.#detail.element);
  }

  /** Shows the table named in the address; without one, the table shown last. */
  open(hash: string): void {
    const asked = new URLSearchParams(hash.replace(/^#/, ""));
    const panel = panels.find(({ name }) => name === asked.get("show"));
    if (panel) {
      const { values } = this.#of(panel);
      for (const { key } of panel.choices) {
        const value = asked.get(key);
        if (value !== null && optionsOf(panel, key).includes(value)) values[key] = value;
      }
    }
    this.#open = true;
    this.#show(panel ?? this.#panel);
  }

  /** Nothing is computed for a hidden page; finished results stay. */
  leave(): void {
    this.#open = false;
    this.#runner.stop();
  }

  recolour(): void {
    this.#curves?.recolour();
  }

  /** The rows of all finished cells, under the names that the command gives them. */
  download(): void {
    const done = panels
      .map(({ name, cells }) => [name, this.#runner.results(cells)] as const)
      .filter(([, results]) => results.length > 0);
    const json = Object.fromEntries(done.map(([name, results]) => [name, rowsOf(name, results)]));
    saveJson("bimodal-stereo-tables.json", "the numbers of all finished cells", {
      format: "bimodal-stereo tables",
      version: 1,
      data: false,
      ...json,
    });
  }

  #of(panel: Panel): Chosen {
    return this.#chosen.get(panel) ?? { values: {}, cell: undefined };
  }

  #shown(): Cell[] {
    const { values } = this.#of(this.#panel);
    return this.#panel.cells.filter(({ row }) =>
      Object.entries(values).every(([key, value]) => String(row[key]) === value),
    );
  }

  #tab(panel: Panel): HTMLElement {
    const count = make("span", { class: "soft count" });
    const button = make("button", { type: "button", class: "tab" }, panel.tab, count);
    button.addEventListener("click", () => this.#show(panel));
    this.#tabs.set(panel, { button, count });
    return button;
  }

  #show(panel: Panel): void {
    this.#panel = panel;
    for (const [each, { button }] of this.#tabs) {
      if (each === panel) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    }
    const cells = this.#shown();
    const { cell } = this.#of(panel);
    this.#heat = new Heat(panel, cells, {
      onPress: (pressed) => this.#press(pressed),
      onRow: (row) => this.#runner.runAll(row),
    });
    this.#main.replaceChildren(
      make("h2", {}, `${panel.tab}: ${panel.title}`),
      make("p", { class: "soft" }, panel.words),
      make(
        "div",
        { class: "toolbar" },
        ...panel.choices.map((choice) => this.#choice(choice)),
        this.#runAll,
        this.#stop,
        this.#progress,
      ),
      make("div", { class: "heat-box" }, this.#heat.element),
      legend(panel),
      this.#curvesBox,
      this.#summary,
    );
    for (const { id } of cells) this.#heat.show(id, this.#runner.stateOf(id));
    this.#heat.choose(cells.includes(cell as Cell) ? cell?.id : undefined);
    this.#showDetail();
    this.#showProgress();
    this.#showSummary();
    this.#showTab();
    this.#writeAddress();
  }

  /** On small screens the tabs are a row to be swiped; the page itself must not move. */
  #showTab(): void {
    const tab = this.#tabs.get(this.#panel)?.button;
    if (tab) this.#side.scrollLeft = tab.offsetLeft - this.#side.offsetLeft - this.#side.clientWidth / 4;
  }

  #choice({ key, label, name }: Panel["choices"][number]): HTMLElement {
    const { values } = this.#of(this.#panel);
    const options = optionsOf(this.#panel, key).map((value) => make("option", { value }, name(value)));
    const select = make("select", {}, ...options);
    select.value = values[key] ?? "";
    select.addEventListener("change", () => {
      values[key] = select.value;
      this.#follow();
      this.#show(this.#panel);
      this.#main.querySelector<HTMLSelectElement>(`label[data-key="${key}"] select`)?.focus();
    });
    return make("label", { class: "choice", "data-key": key }, make("span", {}, label), select);
  }

  /** The chosen place is kept when the same table is shown under another light. */
  #follow(): void {
    const chosen = this.#of(this.#panel);
    const { down, across } = this.#panel;
    const before = chosen.cell;
    chosen.cell =
      before &&
      this.#shown().find((cell) => down.of(cell) === down.of(before) && across.of(cell) === across.of(before));
  }

  /** A cell without a result runs at once. */
  #press(cell: Cell): void {
    this.#of(this.#panel).cell = cell;
    this.#heat?.choose(cell.id);
    if (this.#runner.stateOf(cell.id)?.kind !== "done") this.#runner.runFirst(cell);
    this.#showDetail();
  }

  #update(id: string): void {
    const state = this.#runner.stateOf(id);
    this.#heat?.show(id, state);
    if (this.#of(this.#panel).cell?.id === id) this.#showDetail();
    if (state?.kind === "running" && this.#stop.disabled === false) return;
    this.#showProgress();
    if (state?.kind !== "running") this.#showSummary();
  }

  #showDetail(): void {
    const { cell } = this.#of(this.#panel);
    this.#detail.show(this.#panel, cell, cell && this.#runner.stateOf(cell.id));
  }

  #showProgress(): void {
    for (const [panel, { count }] of this.#tabs) {
      const done = this.#runner.results(panel.cells).length;
      count.textContent = `${done} of ${panel.cells.length}`;
    }
    const cells = this.#shown();
    const done = this.#runner.results(cells).length;
    const failed = cells.filter(({ id }) => this.#runner.stateOf(id)?.kind === "failed").length;
    this.#progress.textContent = `${done} of ${cells.length}${failed > 0 ? `, ${failed} failed` : ""}`;
    this.#runAll.disabled = done === cells.length;
    this.#stop.disabled = !this.#runner.busy;
  }

  #showSummary(): void {
    const done = this.#runner.results(this.#shown());
    // Opened aims stay open while more results arrive.
    const open = this.#summary.querySelector("details")?.open ?? false;
    this.#summary.replaceChildren(...summary(this.#panel, done));
    this.#summary.querySelector("details")?.toggleAttribute("open", open);
    void this.#showCurves();
  }

  async #showCurves(): Promise<void> {
    if (this.#panel.curves && !this.#curves) {
      const { Curves } = await import("./curves");
      this.#curves ??= new Curves();
      this.#curvesBox.replaceChildren(this.#curves.element);
    }
    // While it loaded, another table may have been opened.
    const cells = this.#shown();
    this.#curves?.show(this.#panel, this.#runner.results(cells), cells);
  }

  #writeAddress(): void {
    if (!this.#open) return;
    const state = new URLSearchParams({ show: this.#panel.name, ...this.#of(this.#panel).values });
    history.replaceState(null, "", `#tables&${state}`);
  }
}

function initial(panel: Panel): Record<string, string> {
  return Object.fromEntries(panel.choices.map(({ key }) => [key, optionsOf(panel, key)[0] ?? ""]));
}

function intro(): HTMLElement {
  return make(
    "section",
    { class: "intro" },
    make("h2", {}, "The paper's tables, computed here"),
    make(
      "p",
      {},
      "Each cell is a scene with a known answer, rendered and solved in your browser. The paper's surface, a bust of Mozart, is not part of this project: ",
      make("strong", {}, "our built-in bust stands in for it"),
      " under built-in lights. The paper's figures, small below ours, are for reference.",
    ),
    make(
      "details",
      {},
      make("summary", {}, "Not available in the browser"),
      make(
        "p",
        {},
        "The same protocols run on the command line, ",
        make("code", {}, "npm run tables"),
        ". These need recordings that the project may not redistribute:",
      ),
      make("ul", {}, ...elsewhere.map((title) => make("li", {}, title))),
    ),
  );
}
