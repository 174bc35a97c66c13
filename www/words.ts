/**
 * The words of the interface in the language of the page. The English words are in the code and in index.html, each beside its id. Another
 * language is a catalogue with the same ids (www/learn/languages/); words missing there stay English.
 */

import { decimals } from "./draw/numbers";

/** Words by their path. They are nested like the parts of a lesson. */
export interface Words {
  readonly [name: string]: string | Words | readonly (string | Words)[];
}
/** Values that replace {names} in a text. */
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

/** Replaces {name} and {name:digits} by details. */
export const filled = (words: string, details: Details): string =>
  words.replace(/\{(\w+)(?::(\d))?\}/g, (all, name: string, digits?: string) => {
    const detail = details[name];
    if (typeof detail !== "number") return detail ?? all;
    return inFigures(digits === undefined ? String(detail) : decimals(detail, Number(digits)));
  });

/** A number with the decimal sign of the language. */
export const inFigures = (number: string): string => number.replace(".", phrase("decimal-sign", "."));
