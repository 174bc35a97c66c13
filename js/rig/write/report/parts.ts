/** Parts that any report is made of. */
import type { CheckVerdict } from "../../../types/index.js";
import { fault, like } from "../built.js";
import type { Picture, ReportInput } from "./contents.js";
import { type Markup, type Part, html } from "./markup.js";

/** A tick, a cross or a question mark, since colour alone is lost in print. */
const SIGNS: Readonly<Record<CheckVerdict, string>> = {
  consistent: "M9 20.5l7 7 15-16",
  off: "M12 12l16 16M28 12l-16 16",
  undecided: "M13.5 15.5a6.5 6.5 0 1 1 9.5 5.8c-2 1.1-3 2-3 4.2M20 30.5v.5",
};

export const sign = (verdict: CheckVerdict): Markup =>
  html`<svg class="sign" viewBox="0 0 40 40" aria-hidden="true"><circle cx="20" cy="20" r="18"/><path d="${SIGNS[verdict]}"/></svg>`;

export const section = (title: string, ...parts: Part[]): Markup => html`<section><h2>${title}</h2>${parts}</section>`;

export const fact = (name: string, value: string, more?: string): Markup =>
  html`<div><dt>${name}</dt><dd>${value}${more === undefined ? undefined : html` <span class="soft">${more}</span>`}</dd></div>`;

/** A cell that states its column itself, for narrow screens on which the table's head is hidden. */
export const cell = (column: string, value: Part): Markup => html`<td data-column="${column}">${value}</td>`;

export const table = (kind: string, columns: readonly string[], rows: Part): Markup =>
  html`<table class="${kind}"><thead><tr>${columns.map((column) => html`<th scope="col">${column}</th>`)}</tr></thead><tbody>${rows}</tbody></table>`;

/** Text of any length, of which a printed page shows only the first lines. */
export const clamped = (text: Part): Markup => html`<div class="clamp">${text}</div>`;

/** Only pictures embedded in the file are accepted; SVG may load other files. */
export const isPicture = (dataUrl: unknown): boolean =>
  /^data:image\/(?:png|jpeg|webp|avif|gif);base64,[A-Za-z0-9+/]+={0,2}$/.test(String(dataUrl));

export function pictureSection(pictures: readonly Picture[]): Markup | undefined {
  if (pictures.length === 0) return undefined;
  const figures = pictures.map(({ title, dataUrl }, index) => {
    if (!isPicture(dataUrl))
      throw fault("type", `pictures[${index}].dataUrl`, "must be a data URL of a PNG, JPEG, WebP, AVIF or GIF");
    return html`<figure><img src="${dataUrl}" alt="${title}"><figcaption>${title}</figcaption></figure>`;
  });
  return section("Pictures", html`<div class="pictures">${figures}</div>`);
}

/** The first items of a list, and a remark on the number of omitted items. */
export function firstOf<T>(
  all: readonly T[],
  most: number,
  show: (each: T) => Markup,
  rest: (words: string) => Markup,
): Markup[] {
  const shown = all.slice(0, most).map(show);
  return all.length > most ? [...shown, rest(`and ${all.length - most} more, in the JSON`)] : shown;
}

/**
 * How many files fit on a page of a printed report: on the first page with two lines for each file, on the first page with one line for
 * each, and on a second page.
 */
const [FEW, BESIDE, ON_A_PAGE] = [5, 10, 60];

function inputRow({ name, says, bytes, notes = [], sha256 }: ReportInput): Markup {
  like([], notes, "options.inputs.notes");
  const read = [says ?? "", ...(bytes === undefined ? [] : [`${bytes} bytes`])].filter(Boolean).join(", ");
  return html`<tr><th scope="row">${clamped(name)}</th>${cell("Read as", clamped([read, notes.length > 0 ? html` <em>${notes.join(", ")}</em>` : undefined]))}${cell("SHA-256", html`<code>${sha256 ?? "not taken"}</code>`)}</tr>`;
}

export function inputTable(inputs: readonly ReportInput[]): Markup | undefined {
  if (inputs.length === 0) return undefined;
  const rows = firstOf(inputs, ON_A_PAGE, inputRow, (words) => html`<tr><td colspan="3">${words}</td></tr>`);
  const isApart = inputs.length > BESIDE;
  const kind = isApart ? "inputs stacks many apart" : inputs.length > FEW ? "inputs stacks many" : "inputs stacks";
  return section(isApart ? `Files, ${inputs.length}` : "Files", table(kind, ["File", "Read as", "SHA-256"], rows));
}
