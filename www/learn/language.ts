/**
 * The language of Learn. The address decides, then the language that is shown, then the visitor's last choice, then the browser's languages.
 * A catalogue loads when its language is first needed.
 */

import { setWords, type Words } from "../words";

/** To add a language, see docs/dev/adding-to-the-page.md. */
const CATALOGUES = {
  de: { name: "Deutsch", load: () => import("./languages/de.json") },
} as const;

export type Language = "en" | keyof typeof CATALOGUES;
const ENGLISH = ["en", "English"] as const;
/** Each language with its name in that language. */
export const LANGUAGES: readonly (readonly [Language, string])[] = [
  ENGLISH,
  ...Object.entries(CATALOGUES).map(([code, { name }]) => [code as Language, name] as const),
];

const KEY = "bimodal-stereo.language";
const loaded = new Map<Language, Words>();
let shown: Language | undefined;

const known = (code: string | null | undefined): Language | undefined => LANGUAGES.find(([each]) => each === code)?.[0];

/** Private windows may refuse storage; the choice then lasts as long as the page. */
function remembered(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

export function remember(language: Language): void {
  try {
    localStorage.setItem(KEY, language);
  } catch {
    // The choice is not stored, for the reason given above.
  }
}

/** The language of a visitor who has not asked for any. */
const ownLanguage = (): Language =>
  known(remembered()) ??
  navigator.languages.map((tag) => known(tag.split("-")[0])).find((each) => each !== undefined) ??
  "en";

/** The language in which Learn opens at this address. */
export const languageFor = (hash: string): Language =>
  known(new URLSearchParams(hash.replace(/^#/, "")).get("lang")) ?? shown ?? ownLanguage();

/** The language in which Learn is shown. */
export const shownLanguage = (): Language => shown ?? "en";

/** The part of an address with which others see the same language. It is empty if the browser would show English by itself. */
export const languageInAddress = (): { lang?: Language } =>
  shownLanguage() === "en" && ownLanguage() === "en" ? {} : { lang: shownLanguage() };

/** Whether a language can be shown at once. */
export const isReady = (language: Language): boolean => language === "en" || loaded.has(language);

export async function load(language: Language): Promise<void> {
  if (language === "en" || loaded.has(language)) return;
  const { default: words } = await CATALOGUES[language].load();
  loaded.set(language, words);
}

/** Shows the page in this language, which is ready. */
export function speak(language: Language): void {
  shown = language;
  setWords(loaded.get(language));
  document.documentElement.lang = language;
}

/** The other parts of the page are in English. */
export function speakEnglish(): void {
  setWords(undefined);
  document.documentElement.lang = "en";
}
