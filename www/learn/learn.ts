/** Shows Learn in one language. After a change of the language its parts are created again, with the settings of all figures. */

import { make } from "../dom";
import { placeOf } from "../place";
import { phrase } from "../words";
import { Kept } from "./kept";
import {
  LANGUAGES,
  isReady,
  languageFor,
  load,
  remember,
  shownLanguage,
  speak,
  speakEnglish,
  type Language,
} from "./language";
import { retell } from "./lessons";
import { LearnPage } from "./page";

export class Learn {
  readonly #parent: HTMLElement;
  readonly #kept = new Kept();
  #page: LearnPage | undefined;

  constructor(parent: HTMLElement) {
    this.#parent = parent;
  }

  open(hash: string): void {
    const language = languageFor(hash);
    if (isReady(language)) this.#open(language, hash);
    else void this.#load(language);
  }

  leave(): void {
    this.#page?.leave();
    speakEnglish();
  }

  recolour(): void {
    this.#page?.recolour();
  }

  download(): void {
    this.#page?.download();
  }

  async #load(language: Language): Promise<void> {
    // Without its catalogue, for example without a network, the page stays as it was or is English.
    const found = await load(language).then(
      () => language,
      () => shownLanguage(),
    );
    // A visitor who has moved on in the meantime is not brought back.
    if (placeOf(location.hash) === "learn") this.#open(found, location.hash);
  }

  #open(language: Language, hash: string): void {
    const isNew = !this.#page || language !== shownLanguage();
    speak(language);
    document.title = `${phrase("learn", "Learn")}, bimodal-stereo`;
    if (isNew) {
      this.#page?.leave();
      retell();
      this.#parent.replaceChildren();
      this.#page = new LearnPage(this.#parent, { kept: this.#kept, tools: [this.#choice()] });
    }
    this.#page?.open(hash);
  }

  #choice(): HTMLElement {
    const select = make(
      "select",
      { class: "learn-language" },
      ...LANGUAGES.map(([code, name]) =>
        make("option", { value: code, lang: code, selected: code === shownLanguage() }, name),
      ),
    );
    select.addEventListener("change", () => {
      const language = select.value as Language;
      remember(language);
      const asked = location.hash.replace(/&lang=[^&]*/, "");
      history.replaceState(null, "", `${asked}&lang=${language}`);
      // The select is made anew with the rest.
      void this.#load(language).then(() => this.#parent.querySelector<HTMLElement>(".learn-language")?.focus());
    });
    return make("label", {}, make("span", { class: "visually-hidden" }, phrase("language", "Language")), select);
  }
}
