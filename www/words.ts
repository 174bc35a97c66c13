/**
 * The words of the interface in the language of the page. English stands in the code and in index.html, beside its id; another language is a
 * catalogue with the same ids (www/learn/languages/), and what it lacks stays English.
 */

import { decimals } from "./draw/numbers";

/** Words by their path: nested, because a lesson is nested. */
export interface Words {
  readonly [name: string]: string | Words | readonly (string | Words)[];
}
/** What stands in the place of {names}. */
export type Details = Readonly<Record<string, number | string>>;

let current: Words | undefined;

/** Has an event "changed" whenever the language has changed. */
export const language = new EventTarget();

/** Without a catalogue the page is English. */
export function setWords(words: Words | undefined): void {
  if (words === current) return;
  current = words;
  language.dispatchEvent(new Event("changed"));
}

/** The words at a path of the catalogue in use. */
export const wordsAt = (path: readonly string[]): unknown =>
  path.reduce<unknown>((at, name) => (at as Words | undefined)?.[name], current);

/** The words with this id, which are the English ones unless the catalogue has others. */
export function phrase(id: string, english: string, details: Details = {}): string {
  const said = wordsAt(["interface", id]);
  return filled(typeof said === "string" ? said : english, details);
}

/** Words in which {name} and {name:digits} stand for details. */
export const filled = (words: string, details: Details): string =>
  words.replace(/\{(\w+)(?::(\d))?\}/g, (all, name: string, digits?: string) => {
    const detail = details[name];
    if (typeof detail !== "number") return detail ?? all;
    return inFigures(digits === undefined ? String(detail) : decimals(detail, Number(digits)));
  });

/** A number as the language writes it. */
export const inFigures = (number: string): string => number.replace(".", phrase("decimal-sign", "."));
