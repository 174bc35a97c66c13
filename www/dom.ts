/** Helpers that build a document in plain TypeScript. */

type Attributes = Record<string, string | number | boolean | undefined>;

/** An element with attributes and children; `true` sets a bare attribute, `false` and `undefined` leave it out. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    // The page's content security policy forbids the attribute `style`.
    if (name === "style") element.style.cssText = String(value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

/** The element with this id. The document and the script belong together, so a missing element is a defect of the page. */
export function byId<T extends HTMLElement>(id: string, type: abstract new () => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`The page has no ${type.name} #${id}.`);
  return element;
}

/** Colours, cached until the theme changes, because each query may make the browser restyle the whole page. */
const inks = new Map<string, string>();
/** An element from which colours are read. It stays in the head, which has no layout, because adding it anew would restyle the page. */
const inkwell = document.head.appendChild(make("i"));

/** A colour token as the browser computes it, for canvases that cannot read custom properties. */
export function ink(token: string): string {
  const known = inks.get(token);
  if (known !== undefined) return known;
  inkwell.style.color = `var(--${token})`;
  const { color } = getComputedStyle(inkwell);
  inks.set(token, color);
  return color;
}

/** Takes the colours from a shadow root, which has its own tokens. */
export function dipInto(root: ShadowRoot): void {
  if (inkwell.getRootNode() === root) return;
  root.append(inkwell);
  inks.clear();
}

/** To be called when the theme changes, before anything is drawn in the new colours. */
export const forgetInks = (): void => inks.clear();

/** Calls back when a dialog has closed, except if it has been opened again before the browser reports its end. */
export function onClosed(dialog: HTMLDialogElement, listen: () => void): void {
  dialog.addEventListener("close", () => {
    if (!dialog.open) listen();
  });
}

let counter = 0;
/** An id that is unique on the page. */
export const freshId = (stem: string): string => `${stem}-${++counter}`;

/** Lets the browser paint and handle input before the next step. */
export const nextTask = (): Promise<void> => new Promise((go) => setTimeout(go));

/** Lets the browser style, lay out and paint all changes before the next step. */
export const nextFrame = (): Promise<void> => new Promise((go) => requestAnimationFrame(() => setTimeout(go)));
