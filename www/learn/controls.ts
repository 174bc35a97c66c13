/** The controls of a lesson: native inputs with their values beside them. */

import { freshId, make } from "../dom";
import { phrase } from "../words";
import { labelOf, shown, type Control, type Lesson } from "./lesson";
import type { Values } from "./protocol";

/** Characters of the longest choice that fit a select of one column. */
const SHORT = 15;

interface Field {
  control: Control;
  element: HTMLElement;
  show(value: number | string, values: Values): void;
}

export class Controls {
  readonly element: HTMLElement;
  #values: Values;
  readonly #fields: Field[];
  readonly #onChange: (values: Values) => void;

  constructor(lesson: Lesson, values: Values, onChange: (values: Values) => void) {
    this.#values = values;
    this.#onChange = onChange;
    this.#fields = lesson.controls.map((control) => this.#field(control));
    this.element = make(
      "div",
      { class: "learn-controls", role: "group", "aria-label": phrase("controls", "Controls of the figure") },
      ...this.#fields.map(({ element }) => element),
    );
    this.show(values);
  }

  get values(): Values {
    return this.#values;
  }

  /** Sets several at once, as a drag does. */
  set(changed: Values): void {
    this.show({ ...this.#values, ...changed });
    this.#onChange(this.#values);
  }

  show(values: Values): void {
    this.#values = values;
    for (const { control, element, show } of this.#fields) {
      show(values[control.key] ?? control.initial, values);
      element.hidden = control.when?.(values) === false;
    }
  }

  #field(control: Control): Field {
    switch (control.kind) {
      case "slider":
        return this.#slider(control);
      case "choice":
        return this.#choice(control);
      case "box":
        return this.#box(control);
    }
  }

  #slider(control: Extract<Control, { kind: "slider" }>): Field {
    const id = freshId("learn");
    const { min, max, step } = control;
    const input = make("input", { id, type: "range", min, max, step, name: control.key });
    const output = make("output", { for: id });
    input.addEventListener("input", () => this.set({ [control.key]: input.valueAsNumber }));
    const label = make("label", { for: id });
    const show = (value: number | string, values: Values) => {
      label.textContent = labelOf(control, values);
      input.value = String(value);
      output.textContent = shown(control, Number(value), values);
      input.setAttribute("aria-valuetext", output.textContent);
    };
    return {
      control,
      element: make("div", { class: "learn-slider" }, label, output, input, ...hint(control, input)),
      show,
    };
  }

  #choice(control: Extract<Control, { kind: "choice" }>): Field {
    const id = freshId("learn");
    const select = make(
      "select",
      { id, name: control.key },
      ...control.choices.map(([value, label]) => make("option", { value }, label)),
    );
    select.addEventListener("change", () => this.set({ [control.key]: select.value }));
    return {
      control,
      element: make(
        "div",
        { class: control.choices.some(([, label]) => label.length > SHORT) ? "learn-choice wide" : "learn-choice" },
        make("label", { for: id }, labelOf(control, this.#values)),
        select,
        ...hint(control, select),
      ),
      show: (value) => (select.value = String(value)),
    };
  }

  #box(control: Extract<Control, { kind: "box" }>): Field {
    const box = make("input", { type: "checkbox", name: control.key });
    box.addEventListener("change", () => this.set({ [control.key]: box.checked ? 1 : 0 }));
    return {
      control,
      element: make(
        "div",
        { class: "learn-box" },
        make("label", {}, box, labelOf(control, this.#values)),
        ...hint(control, box),
      ),
      show: (value) => (box.checked = value === 1),
    };
  }
}

function hint({ hint }: Control, input: HTMLElement): HTMLElement[] {
  if (!hint) return [];
  const id = freshId("learn-hint");
  input.setAttribute("aria-describedby", id);
  return [make("p", { class: "soft learn-hint", id }, hint)];
}
