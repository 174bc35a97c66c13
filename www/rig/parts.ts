/** Small parts that the three steps share. */

import { freshId, make } from "../dom";

/** Width of thumbnails in lists, twice the displayed size, px. */
export const THUMB = 360;

const SVG = "http://www.w3.org/2000/svg";

/** An element of a drawing. */
export function svg(
  tag: string,
  attributes: Record<string, string | number> = {},
  ...children: SVGElement[]
): SVGElement {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** Rows of a list that are kept while their items change, so that focus and open details stay. */
export class Keyed<T extends { id: number }> {
  #rows = new Map<number, { element: HTMLElement; show(thing: T): void }>();
  readonly #parent: HTMLElement;
  readonly #make: (thing: T) => { element: HTMLElement; show(thing: T): void };

  constructor(parent: HTMLElement, make: (thing: T) => { element: HTMLElement; show(thing: T): void }) {
    this.#parent = parent;
    this.#make = make;
  }

  show(things: readonly T[]): void {
    const kept = new Set(things.map(({ id }) => id));
    for (const [id, { element }] of this.#rows) {
      if (kept.has(id)) continue;
      element.remove();
      this.#rows.delete(id);
    }
    things.forEach((thing, i) => {
      let row = this.#rows.get(thing.id);
      if (!row) {
        row = this.#make(thing);
        this.#rows.set(thing.id, row);
      }
      // Moving an element that is already in its place would remove the focus.
      if (this.#parent.children[i] !== row.element)
        this.#parent.insertBefore(row.element, this.#parent.children[i] ?? null);
      row.show(thing);
    });
  }
}

export function press(
  label: string,
  action: () => void,
  attributes: Record<string, string | boolean> = {},
): HTMLButtonElement {
  const element = make("button", { type: "button", ...attributes }, label);
  element.addEventListener("click", action);
  return element;
}

/** A label above its control. */
export function labelled(label: string, control: HTMLElement, note?: HTMLElement): HTMLElement {
  const id = control.id || freshId("rig");
  control.id = id;
  if (note) {
    note.id ||= `${id}-note`;
    control.setAttribute("aria-describedby", note.id);
  }
  return make("div", { class: "rig-field" }, make("label", { for: id }, label), control, ...(note ? [note] : []));
}

/** Fills a select element and keeps its selection. */
export function fill(
  select: HTMLSelectElement,
  options: readonly { value: string; label: string }[],
  chosen: string,
): void {
  const now = JSON.stringify(options);
  if (select.dataset.options !== now) {
    select.replaceChildren(...options.map(({ value, label }) => make("option", { value }, label)));
    select.dataset.options = now;
  }
  select.value = chosen;
}

export function choose(
  options: readonly { value: string; label: string }[],
  chosen: string,
  onChange: (value: string) => void,
): HTMLSelectElement {
  const select = make("select");
  fill(select, options, chosen);
  select.addEventListener("change", () => onChange(select.value));
  return select;
}

/** A number with its unit; an empty or wrong one is NaN. */
export function numberField(
  label: string,
  unit: string,
  onChange: (value: number) => void,
): { element: HTMLElement; input: HTMLInputElement } {
  const input = make("input", { type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false" });
  input.addEventListener("input", () => {
    const value = toNumber(input.value);
    const isWrong = input.value.trim() !== "" && Number.isNaN(value);
    if (isWrong) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
    onChange(value);
  });
  const element = labelled(unit ? `${label}, ${unit}` : label, input);
  return { element, input };
}

export const toNumber = (text: string): number =>
  text.trim() === "" ? NaN : Number(text.trim().replace(",", ".").replace("−", "-"));

export const show = (input: HTMLInputElement, value: number): void => {
  if (document.activeElement !== input)
    input.value = Number.isFinite(value) ? String(Number(value.toPrecision(8))) : "";
};

/** Draws a picture into a canvas of the same size. */
export function draw(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
}

export function saveFile(name: string, content: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = make("a", { href: url, download: name });
  link.click();
  // Some browsers read the blob only after the click has returned.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
