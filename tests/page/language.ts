/** The words of the page in the language of a test. The tests of Learn run in each language. */

import { readFileSync, readdirSync } from "node:fs";

const FOLDER = new URL("../../www/learn/languages/", import.meta.url);

/** The languages with a catalogue. */
export const LANGUAGES = readdirSync(FOLDER).map((name) => name.replace(".json", ""));

/** Returns the catalogue's words at a path such as "lessons.pixel.title"; in English, the given words. */
export type Say = (path: string, english: string) => string;

export const catalogueOf = (language: string): object =>
  JSON.parse(readFileSync(new URL(`${language}.json`, FOLDER), "utf8")) as object;

export function sayIn(locale = "en"): Say {
  const [language = ""] = locale.split("-");
  if (!LANGUAGES.includes(language)) return (_, english) => english;
  const catalogue = catalogueOf(language);
  return (path) => {
    // Ids of the interface contain points themselves.
    const [first = "", ...rest] = path.split(".");
    const names = first === "interface" ? [first, rest.join(".")] : [first, ...rest];
    const words = names.reduce<unknown>((at, name) => (at as Record<string, unknown> | undefined)?.[name], catalogue);
    if (typeof words !== "string") throw new Error(`${language}.json has no words for ${path}`);
    return words;
  };
}
