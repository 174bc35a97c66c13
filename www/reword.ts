/** The words of index.html in the language of the page: an element's data-say is the id of its text, data-say-label that of its label. */

import { language, phrase } from "./words";

/** The English words of elements of index.html. */
const english = new WeakMap<HTMLElement, { text: string; label: string }>();

/** Gives an element of index.html its words in the language of the page. */
export function reword(element: HTMLElement): void {
  const { say, sayLabel } = element.dataset;
  const known = english.get(element) ?? {
    text: element.textContent,
    label: element.getAttribute("aria-label") ?? "",
  };
  english.set(element, known);
  if (say) element.textContent = phrase(say, known.text);
  if (sayLabel) element.setAttribute("aria-label", phrase(sayLabel, known.label));
}

language.addEventListener("changed", () => {
  for (const element of document.querySelectorAll<HTMLElement>("[data-say], [data-say-label]")) reword(element);
});
