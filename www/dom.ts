/** The few lines that make building a document in plain TypeScript pleasant. */

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
    // As an attribute the page's own policy would refuse it.
    if (name === "style") element.style.cssText = String(value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

/** The element with this id; the document and the script belong together, so its absence is a mistake of ours. */
export function byId<T extends HTMLElement>(id: string, type: abstract new () => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`The page has no ${type.name} #${id}.`);
  return element;
}

/** Cache of colours until the theme changes, because each query may make the browser style the whole page first. */
const inks = new Map<string, string>();
/** In the head, where nothing is laid out. It stays there, because adding and removing it would restyle the page. */
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

/** Call it when the theme changes, before anything is drawn in the new colours. */
export const forgetInks = (): void => inks.clear();

let counter = 0;
/** An id that nothing else on the page has. */
export const freshId = (stem: string): string => `${stem}-${++counter}`;

/** Lets the browser paint and answer what was pressed before what follows. */
export const nextTask = (): Promise<void> => new Promise((go) => setTimeout(go));

/** Lets the browser style, lay out and paint what has changed before what follows. */
export const nextFrame = (): Promise<void> => new Promise((go) => requestAnimationFrame(() => setTimeout(go)));
