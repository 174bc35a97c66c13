/** Fields made from the settings' description, each with its label, unit, hint and a place for its error. */

import { byId, freshId, make } from "../dom";
import {
  fields,
  isOff,
  valueOf,
  type ChoiceField,
  type Field,
  type Group,
  type ListField,
  type NumberField,
} from "./fields";
import { isLightText, type Origin, type Settings, type Value } from "./settings";
import type { Store } from "./store";

const groups: readonly Group[] = ["sample", "colour", "depth", "method", "weights", "loop"];

interface Control {
  field: Field;
  row: HTMLElement;
  note: HTMLElement;
  remark: HTMLElement;
  inputs: HTMLElement[];
  show(value: Value): void;
}

export class Form {
  #controls = new Map<string, Control>();
  readonly #store: Store;

  constructor(store: Store) {
    this.#store = store;
    store.listen((settings) => this.#showAll(settings));
  }

  /** Builds the fields into the boxes of their groups. */
  mount(): void {
    for (const group of groups) this.#mount(group, byId(`fields-${group}`, HTMLElement));
  }

  #mount(group: Group, parent: HTMLElement): void {
    for (const field of fields.filter((each) => each.group === group)) {
      const control = this.#build(field);
      this.#controls.set(field.key, control);
      control.show(this.#store.settings[field.key] ?? null);
      parent.append(control.row);
    }
  }

  /** Shows only the fields that apply to this source, with remarks on their present values. */
  adapt(settings: Settings, source: Origin): void {
    for (const { field, row, remark, inputs, show } of this.#controls.values()) {
      const select = inputs[0];
      if (field.kind === "choice" && field.only && select instanceof HTMLSelectElement) {
        for (const option of select.options) option.disabled = isOff(field, option.value, source);
        show(valueOf(field, settings, source));
      }
      row.hidden = !(field.when?.(settings, source) ?? true);
      remark.textContent = field.remark?.(settings[field.key] ?? null, source) ?? "";
    }
  }

  /** The choices that only the library knows. */
  offer(key: string, values: readonly string[]): void {
    const control = this.#controls.get(key);
    const select = control?.inputs[0];
    if (!control || !(select instanceof HTMLSelectElement)) return;
    select.replaceChildren(...values.map((value) => make("option", { value }, value)));
    control.show(this.#store.settings[key] ?? null);
  }

  /** Shows an error beside its field and returns that field; nothing if no field has this path. */
  complain(path: string, message: string): string | undefined {
    const shown = [...this.#controls.values()].filter(({ row }) => !row.hidden);
    const candidates = shown.filter(({ field }) => path === field.path || path.startsWith(`${field.path}.`));
    // An error of several fields together, such as angles, is shown beside the first of them.
    const control =
      candidates.sort((a, b) => b.field.path.length - a.field.path.length)[0] ??
      shown.find(({ field }) => field.path.startsWith(`${path}.`));
    if (!control) return undefined;
    mark(control, message, "error");
    let folded = control.row.closest("details");
    for (; folded; folded = folded.parentElement?.closest("details") ?? null) folded.open = true;
    // Scrolls only within the settings, which may be longer than their sheet.
    control.row.scrollIntoView({ block: "nearest" });
    return control.field.label;
  }

  /** A remark other than an error, such as a guess. */
  remark(path: string, message: string): void {
    const control = [...this.#controls.values()].find(({ field }) => field.path === path);
    if (control) mark(control, message, "note");
  }

  clearMessages(): void {
    for (const control of this.#controls.values()) mark(control, "", "note");
  }

  #showAll(settings: Settings): void {
    for (const { field, show } of this.#controls.values()) show(settings[field.key] ?? null);
  }

  #build(field: Field): Control {
    const id = freshId("field");
    const note = make("p", { class: "note", id: `${id}-note`, hidden: true });
    const change: Change = (value, live = false, gesture) => this.#store.change({ [field.key]: value }, live, gesture);
    const built = build(field, id, change);
    const remark = make("p", { class: "note" });
    const heading = make("span", { class: "heading" }, make("label", { for: id }, field.label));
    const row = make("div", { class: `field ${field.kind}`, "data-key": field.key }, heading, ...built.inputs);
    if (field.kind === "number" && field.unit) row.append(make("span", { class: "unit" }, field.unit));
    for (const input of built.inputs) input.setAttribute("aria-describedby", note.id);
    if (field.hint) {
      const hint = make("p", { class: "note", id: `${id}-hint`, hidden: true }, field.hint);
      heading.append(hintButton(field.label, hint));
      row.append(hint);
      for (const input of built.inputs) input.setAttribute("aria-description", field.hint);
    }
    row.append(remark, note);
    return { field, row, note, remark, ...built };
  }
}

/** A title attribute is not accessible by touch, so the hint unfolds below its field. */
function hintButton(label: string, hint: HTMLElement): HTMLButtonElement {
  const button = make(
    "button",
    {
      type: "button",
      class: "quiet hint",
      "aria-expanded": "false",
      "aria-controls": hint.id,
      "aria-label": `What is "${label}"?`,
    },
    "?",
  );
  button.addEventListener("click", () => {
    hint.hidden = !hint.hidden;
    button.setAttribute("aria-expanded", String(!hint.hidden));
  });
  return button;
}

function mark({ note, inputs }: Control, message: string, tone: "error" | "note"): void {
  note.textContent = message;
  note.hidden = message === "";
  note.classList.toggle("error", tone === "error" && message !== "");
  for (const input of inputs) input.toggleAttribute("aria-invalid", tone === "error" && message !== "");
}

/** Reports a value; `live` while its control is being moved, with the same `gesture` until the control is released. */
type Change = (value: Value, live?: boolean, gesture?: object) => void;
type Built = Pick<Control, "inputs" | "show">;

function build(field: Field, id: string, change: Change): Built {
  switch (field.kind) {
    case "number":
      return numbers(field, id, change);
    case "choice":
      return choice(field, id, change);
    case "list":
      return list(field, id, change);
    case "flag":
      return flag(id, change);
  }
}

/** How long, in milliseconds, a slider has to rest before its value takes effect. */
const REST = 200;

function numbers(field: NumberField, id: string, change: Change): Built {
  // The library checks the numbers and has better messages than the browser, so the inputs have no limits.
  const exact = make("input", { id, type: "number", step: "any", inputmode: "decimal", placeholder: field.empty });
  // This change counts as that of a slider that has stopped, so a run that was playing plays again.
  const read = (input: HTMLInputElement) => change(input.value === "" ? null : input.valueAsNumber, true);
  exact.addEventListener("change", () => read(exact));
  if (!field.slider) return { inputs: [exact], show: (value) => (exact.value = value === null ? "" : String(value)) };
  const { log = false, ...range } = field.slider;
  const slider = make("input", { type: "range", ...range, "aria-label": field.label });
  // A slider over many decades counts powers of ten.
  const valueOf = () => (log ? Number((10 ** slider.valueAsNumber).toPrecision(2)) : slider.valueAsNumber);
  let resting: ReturnType<typeof setTimeout> | undefined;
  let gesture = {};
  const rest = () => {
    clearTimeout(resting);
    change(valueOf(), true, gesture);
  };
  slider.addEventListener("input", () => {
    exact.value = String(valueOf());
    clearTimeout(resting);
    resting = setTimeout(rest, REST);
  });
  slider.addEventListener("change", () => {
    rest();
    gesture = {};
  });
  return {
    inputs: [exact, slider],
    show(value) {
      exact.value = value === null ? "" : String(value);
      slider.value = log ? String(Math.log10(Number(value ?? field.initial ?? 1))) : exact.value;
    },
  };
}

function choice(field: ChoiceField, id: string, change: Change): Built {
  const options = field.choices ?? [[field.initial, field.initial]];
  const select = make("select", { id }, ...options.map(([value, label]) => make("option", { value }, label)));
  select.addEventListener("change", () => change(select.value));
  return {
    inputs: [select],
    show(value) {
      const wanted = String(value);
      if (![...select.options].some((option) => option.value === wanted))
        select.append(make("option", { value: wanted }, isLightText(wanted) ? "own coefficients" : wanted));
      select.value = wanted;
    },
  };
}

function list(field: ListField, id: string, change: Change): Built {
  const line = make("input", { id, type: "text", placeholder: field.empty, spellcheck: "false", autocomplete: "off" });
  line.addEventListener("change", () => change(line.value.trim()));
  return { inputs: [line], show: (value) => (line.value = String(value ?? "")) };
}

function flag(id: string, change: Change): Built {
  const box = make("input", { id, type: "checkbox" });
  box.addEventListener("change", () => change(box.checked));
  return { inputs: [box], show: (value) => (box.checked = value === true) };
}
