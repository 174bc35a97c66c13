/** The files with a description of how each was read, and controls to correct it. */

import { make } from "../dom";
import { choose, draw, fill, Keyed, press, THUMB } from "./parts";
import type { Kind } from "./protocol";
import type { Item, Rig } from "./rig";

const kinds: readonly { value: Kind; label: string }[] = [
  { value: "colour", label: "colour image" },
  { value: "depth", label: "depth map" },
  { value: "mask", label: "mask" },
  { value: "cameras", label: "camera parameters" },
  { value: "poses", label: "calibration" },
];
const units = [
  { value: "0.001", label: "millimetres" },
  { value: "1", label: "metres" },
  { value: "0.0002", label: "1/5000 m (TUM)" },
  { value: "0.0001", label: "0.1 mm" },
  { value: "0.00025", label: "0.25 mm" },
  { value: "0.01", label: "centimetres" },
];

export const unitName = (metres: number): string =>
  units.find(({ value }) => Number(value) === metres)?.label ?? `${metres} m`;

export class FileList {
  readonly element = make("ul", { class: "rig-files", "aria-label": "Files" });
  readonly #rig: Rig;
  readonly #rows: Keyed<Item>;

  constructor(rig: Rig) {
    this.#rig = rig;
    this.#rows = new Keyed(this.element, (item) => this.#row(item));
  }

  show(): void {
    this.#rows.show(this.#rig.items);
    this.element.hidden = this.#rig.items.length === 0;
  }

  #row(item: Item): { element: HTMLElement; show(item: Item): void } {
    const canvas = make("canvas", { class: "rig-thumb", "aria-hidden": "true", hidden: true });
    const says = make("p", { class: "soft" });
    const notes = make("ul", { class: "rig-notes" });
    const error = make("p", { class: "rig-error", role: "alert", hidden: true });
    const kind = choose([], "", (value) => {
      item.as = value as Kind;
      delete item.unit;
      void this.#rig.reread(item);
    });
    const unit = choose([], "", (value) => void this.#rig.setUnit(item, Number(value)));
    const kindBox = make("label", { class: "rig-choice" }, make("span", {}, "Kind"), kind);
    const unitBox = make("label", { class: "rig-choice" }, make("span", {}, "Unit"), unit);
    const remove = press("×", () => this.#rig.remove(item), { class: "icon", "aria-label": `Remove ${item.name}` });
    const element = make(
      "li",
      { class: "rig-file" },
      canvas,
      make("div", { class: "rig-file-words" }, make("strong", {}, item.name), says, error, notes),
      make("div", { class: "rig-row rig-corrections" }, kindBox, unitBox, remove),
    );
    let drawn = "";
    return {
      element,
      show: () => {
        const { summary, state } = item;
        element.dataset.state = state;
        says.textContent = state === "reading" ? "reading" : (summary?.says ?? "");
        error.textContent = item.error ?? "";
        error.hidden = state !== "failed";
        const warnings = summary?.warnings ?? [];
        const isSaid = warnings.some(({ code }) => code === "unit-guessed");
        const guessed = (isSaid ? [] : (summary?.guessed ?? [])).map(
          (what) => `The ${what} was guessed. Correct it here, or select it to confirm it.`,
        );
        notes.replaceChildren(
          ...[...warnings.map(({ message }) => message), ...guessed].map((words) => make("li", {}, words)),
        );
        kindBox.hidden = !item.blob || summary?.kind === "recording" || summary?.kind === "robot";
        fill(
          kind,
          summary ? kinds : [{ value: "", label: "not recognised" }, ...kinds],
          item.as ?? summary?.kind ?? "",
        );
        unitBox.hidden = summary?.kind !== "depth" || summary.organised === true;
        const now = String(item.unit ?? summary?.unit ?? 1);
        const listed = units.some(({ value }) => Number(value) === Number(now))
          ? units
          : [...units, { value: now, label: `${now} m` }];
        const isGuess = summary?.guessed.includes("unit") ?? false;
        fill(
          unit,
          isGuess
            ? [
                { value: "", label: `guessed: ${listed.find(({ value }) => Number(value) === Number(now))?.label}` },
                ...listed,
              ]
            : listed,
          isGuess ? "" : (listed.find(({ value }) => Number(value) === Number(now))?.value ?? now),
        );
        const wanted = state === "read" && summary?.width ? `${summary.kind} ${summary.says}` : "";
        if (wanted === drawn) return;
        drawn = wanted;
        canvas.hidden = wanted === "";
        if (wanted)
          void this.#rig.session.call("picture", { file: item.id, width: THUMB }).then(
            (bitmap) => draw(canvas, bitmap),
            () => (canvas.hidden = true),
          );
      },
    };
  }
}
