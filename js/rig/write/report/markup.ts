/**
 * HTML from templates that escape all inserted values, in text and in attributes alike, because names come from other people's files. Only
 * markup made by such a template is inserted unchanged.
 */
export class Markup {
  readonly #text: string;

  constructor(text: string) {
    this.#text = text;
  }

  toString(): string {
    return this.#text;
  }
}

export type Part = Markup | string | number | undefined | readonly Part[];

const ENTITIES: Readonly<Record<string, string>> = {
  "&": "&amp;",
  "<": "&lt;",
  ">": "&gt;",
  '"': "&quot;",
  "'": "&#39;",
};

const escaped = (text: string): string => text.replace(/[&<>"']/g, (letter) => ENTITIES[letter] ?? "");

function written(part: Part): string {
  if (part instanceof Markup) return String(part);
  return Array.isArray(part) ? part.map(written).join("") : escaped(String(part ?? ""));
}

/** A template whose values are escaped. Attributes that hold a value must be in double quotes. */
export const html = (parts: TemplateStringsArray, ...values: readonly Part[]): Markup =>
  new Markup(parts.map((text, index) => text + written(values[index])).join(""));
