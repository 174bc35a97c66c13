/** Learn: lessons in three chapters, each a short text beside a live figure, with exercises and slides. */

import "../style/learn.css";
import "../style/embed.css";
import "../style/learn-figure.css";
import "../style/learn-print.css";
import "../style/learn-slides.css";
import { make } from "../dom";
import { saveJson } from "../save";
import { phrase } from "../words";
import { Controls } from "./controls";
import { Embed } from "./embed";
import { exerciseList } from "./exercises";
import { Figure } from "./figure";
import { Fit } from "./fit";
import { Guesses } from "./guesses";
import { languageInAddress } from "./language";
import { type Lesson, computed, followedIn, initialValues, valuesFrom } from "./lesson";
import { beside, chapters, lessonNamed, lessons } from "./lessons";
import { lightTogether } from "./lit";
import { sentence, symbolList } from "./maths";
import { TextNumbers } from "./numbers";
import { Player } from "./player";
import type { Drawing, LessonId, Values } from "./protocol";
import { Readouts } from "./readouts";
import { referencesOf } from "./references";
import { Session } from "./session";
import { Slides, type Slide } from "./slides";
import { drawingIn } from "./translation";
import { tryList } from "./tries";

/** A lesson on the page; its values stay when another one is opened. */
interface Shown {
  lesson: Lesson;
  article: HTMLElement;
  figure: Figure;
  fit: Fit;
  controls: Controls;
  readouts: Readouts;
  player: Player;
  guesses: Guesses;
  numbers: TextNumbers;
  box: HTMLElement;
  alert: HTMLElement;
  embed: Embed;
  drawing: Drawing | undefined;
}

export class LearnPage {
  readonly #session = new Session({
    onDrawing: (drawing, done) => this.#draw(drawing, done),
    onFault: ({ message }) => this.#complain(message),
  });
  readonly #kept: Map<LessonId, Values>;
  readonly #links = new Map<LessonId, HTMLAnchorElement>();
  readonly #contents = make("div", { class: "learn-chapters" });
  readonly #main = make("div", { class: "learn-main" });
  readonly #exercises = exerciseList();
  readonly #exerciseLink = make("a", { href: "#learn&at=exercises" }, phrase("exercises", "Exercises"));
  readonly #slides: Slides;
  #shown: Shown | undefined;
  #isOpen = false;
  /** The figure alone, in a frame of another page. */
  #isEmbedded = false;

  /** `tools` stand below the contents. */
  constructor(parent: HTMLElement, { kept, tools }: { kept: Map<LessonId, Values>; tools: HTMLElement[] }) {
    this.#kept = kept;
    for (const chapter of chapters) {
      const list = make("ol", { "aria-label": chapter.title });
      for (const { id, title } of chapter.lessons) {
        const link = make("a", { href: `#learn&at=${id}` }, title);
        this.#links.set(id, link);
        list.append(make("li", {}, link));
      }
      this.#contents.append(make("p", { class: "learn-chapter" }, chapter.title), list);
    }
    const nav = make(
      "nav",
      { class: "learn-contents", "aria-label": phrase("lessons", "Lessons") },
      this.#contents,
      make("p", {}, this.#exerciseLink),
      ...tools,
    );
    this.#slides = new Slides(
      (by) => this.#go(by),
      () => this.#endSlides(),
    );
    parent.append(nav, this.#main, this.#slides.element);
  }

  /** Shows the lesson named in the address with its settings; without one, the lesson shown last. */
  open(hash: string): void {
    this.#isOpen = true;
    const asked = new URLSearchParams(hash.replace(/^#/, ""));
    this.#isEmbedded = asked.has("embed");
    if (asked.get("at") === "exercises") return this.#showExercises();
    const lesson = lessonNamed(asked.get("at")) ?? this.#shown?.lesson ?? (lessons[0] as Lesson);
    const isTold = lesson.controls.some(({ key }) => asked.has(key));
    const values = isTold ? valuesFrom(lesson, asked) : (this.#kept.get(lesson.id) ?? initialValues(lesson));
    this.#show(lesson, values);
    if (asked.has("slides")) this.#startSlides();
    // Returns from the slides to the lesson at which they were opened.
    else this.#slides.close();
    this.#writeAddress();
  }

  /** Nothing is computed for a hidden page. */
  leave(): void {
    if (!this.#isOpen) return;
    this.#isOpen = false;
    this.#shown?.player.stop();
    this.#session.end();
    this.#slides.close();
  }

  recolour(): void {
    const shown = this.#shown;
    if (shown?.drawing) shown.figure.show(drawingIn(shown.lesson.id, shown.drawing));
  }

  /** The numbers of the figure, with the values of its controls. */
  download(): void {
    // With the exercises on the page there is no figure to export.
    if (!this.#shown?.article.isConnected) return;
    const { lesson, controls, drawing } = this.#shown;
    saveJson(`bimodal-stereo-lesson-${lesson.id}.json`, phrase("saved.lesson", "settings and numbers of this figure"), {
      format: "bimodal-stereo lesson",
      version: 1,
      lesson: lesson.id,
      values: controls.values,
      numbers: drawing?.numbers,
      words: drawing?.words,
    });
  }

  #show(lesson: Lesson, values: Values): void {
    if (this.#shown?.lesson === lesson) {
      this.#shown.controls.show(values);
      if (!this.#slides.isOpen && this.#shown.article.parentElement !== this.#main)
        this.#main.replaceChildren(this.#shown.article);
    } else {
      const before = this.#shown;
      before?.player.stop();
      this.#shown = this.#make(lesson, values);
      if (this.#slides.isOpen) this.#slides.take(slideOf(this.#shown));
      else this.#main.replaceChildren(this.#shown.article);
      // The link to this lesson is at the end of the previous one, so the page has to scroll up.
      if (before) scrollTo(0, 0);
    }
    this.#mark(lesson.id);
    this.#ask();
  }

  #showExercises(): void {
    this.#shown?.player.stop();
    this.#session.end();
    this.#slides.close();
    this.#main.replaceChildren(this.#exercises);
    this.#mark(undefined);
  }

  #mark(id: LessonId | undefined): void {
    for (const [each, link] of [...this.#links, [undefined, this.#exerciseLink] as const]) {
      if (each === id) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    }
    // On small screens the contents are a row to be swiped; the page itself must not move.
    const link = id ? this.#links.get(id) : this.#exerciseLink;
    const nav = this.#contents.parentElement;
    if (link && nav) nav.scrollLeft = link.offsetLeft - nav.offsetLeft - nav.clientWidth / 4;
  }

  #make(lesson: Lesson, values: Values): Shown {
    const figure = new Figure(new Set(Object.keys(lesson.drags)), followedIn(lesson), (key, x, y) =>
      this.#drag(key, x, y),
    );
    const controls = new Controls(lesson, values, () => this.#ask());
    const player = new Player(lesson, controls);
    const readouts = new Readouts(lesson.readouts);
    const alert = make("p", { class: "alert", role: "alert", hidden: true });
    const look = make("p", { class: "learn-look", role: "status" });
    const box = make(
      "section",
      { class: "card learn-figure", "aria-label": phrase("figure", "Figure"), "aria-busy": "true" },
      alert,
      controls.element,
      look,
      readouts.element,
      figure.element,
    );
    const embed = new Embed(titleOf(lesson));
    box.append(embed.source);
    const guesses = new Guesses(lesson, {
      set: (at) => controls.set(at),
      reveal: (what, done) => {
        showFigure(box);
        player.play(what, done);
      },
    });
    const tries = tryList(lesson, (what, task) => {
      look.replaceChildren(
        ...(task.look ? [make("strong", {}, phrase("look", "Look for this:")), " ", ...sentence(task.look)] : []),
      );
      showFigure(box);
      player.play(what);
    });
    const text = this.#text(lesson, embed, guesses.elements, tries);
    const numbers = new TextNumbers(text, lesson, controls);
    const article = make("article", { class: "learn-lesson", "data-lesson": lesson.id }, text, box);
    lightTogether(article);
    const parts = { figure, fit: new Fit(box, figure.element), controls, readouts, player, guesses, numbers, embed };
    return { ...parts, lesson, article, box, alert, drawing: undefined };
  }

  #text(lesson: Lesson, embed: Embed, guesses: readonly HTMLElement[], tries: HTMLElement): HTMLElement {
    const formula = make(
      "div",
      { class: "learn-formula", role: "group", tabindex: "0", "aria-label": lesson.formulaWords },
      lesson.formula(),
    );
    const slides = make("button", { type: "button", class: "learn-slides-button" }, phrase("slides", "Slides"));
    slides.addEventListener("click", () => {
      this.#startSlides();
      this.#writeAddress("another");
    });
    return make(
      "div",
      { class: "learn-text" },
      make("div", { class: "learn-head" }, make("h2", { tabindex: "-1" }, titleOf(lesson)), embed.button, slides),
      embed.element,
      make("p", { class: "learn-gist" }, lesson.gist),
      formula,
      symbolList(formula),
      ...lesson.text.map((words) => make("p", {}, ...sentence(words))),
      make("h3", {}, phrase("guess", "Predict, then look")),
      ...guesses,
      make("h3", {}, phrase("try", "Try")),
      tries,
      make(
        "div",
        { class: "learn-can" },
        make("p", {}, make("strong", {}, `${phrase("short", "In short")}: `), lesson.gist),
        make("p", {}, make("strong", {}, `${phrase("can", "Now")}: `), lesson.can),
      ),
      make("h3", {}, phrase("more", "More")),
      referencesOf(lesson.more),
      this.#ends(lesson),
    );
  }

  #ends({ id }: Lesson): HTMLElement {
    const [before, after] = [beside(id, -1), beside(id, 1)];
    return make(
      "p",
      { class: "learn-ends" },
      ...(before ? [make("a", { href: `#learn&at=${before.id}` }, `← ${before.title}`)] : []),
      after
        ? make("a", { href: `#learn&at=${after.id}` }, `${after.title} →`)
        : make("a", { href: "#learn&at=exercises" }, `${phrase("exercises", "Exercises")} →`),
    );
  }

  /** Sets the two sliders of a panel's axes from a place on it, given as shares of its sides. */
  #drag(key: string, x: number, y: number): void {
    const shown = this.#shown;
    const axes = shown?.lesson.drags[key];
    if (!shown || !axes) return;
    const along = (name: string, share: number): [string, number][] => {
      const control = shown.lesson.controls.find((each) => each.key === name);
      if (control?.kind !== "slider") return [];
      const value = control.min + share * (control.max - control.min);
      return [[name, Number((Math.round(value / control.step) * control.step).toFixed(6))]];
    };
    shown.controls.set(Object.fromEntries([...along(axes.x, x), ...along(axes.y, y)]));
  }

  #ask(): void {
    const shown = this.#shown;
    if (!shown) return;
    this.#kept.set(shown.lesson.id, shown.controls.values);
    shown.numbers.show(shown.controls.values);
    shown.box.setAttribute("aria-busy", "true");
    shown.figure.wait();
    shown.readouts.wait();
    this.#session.ask(shown.lesson.id, computed(shown.lesson, shown.controls.values));
    this.#writeAddress();
  }

  #draw(drawing: Drawing, done: boolean): void {
    const shown = this.#shown;
    if (!shown) return;
    shown.drawing = drawing;
    shown.alert.hidden = true;
    const inWords = drawingIn(shown.lesson.id, drawing);
    shown.figure.show(inWords);
    shown.readouts.show(inWords);
    shown.fit.now();
    if (done && !shown.player.isPlaying) shown.guesses.drawn(drawing, shown.controls.values);
    shown.embed.fit(drawing.panels.some(({ kind }) => kind === "plot"));
    shown.box.setAttribute("aria-busy", String(!done));
  }

  #complain(message: string): void {
    const shown = this.#shown;
    if (!shown) return;
    const again = make("button", { type: "button" }, phrase("recompute", "Recompute"));
    again.addEventListener("click", () => this.#ask());
    shown.alert.replaceChildren(message, " ", again);
    shown.alert.hidden = false;
    shown.box.setAttribute("aria-busy", "false");
  }

  #go(by: 1 | -1): void {
    const next = this.#shown && beside(this.#shown.lesson.id, by);
    if (!next) return;
    // Before the lesson is shown, because that writes the address of its values.
    this.#writeAddress("another");
    this.#show(next, this.#kept.get(next.id) ?? initialValues(next));
    this.#writeAddress();
  }

  #startSlides(): void {
    if (!this.#shown || this.#slides.isOpen) return;
    this.#slides.open(slideOf(this.#shown));
  }

  #endSlides(): void {
    const shown = this.#shown;
    if (!shown || !this.#isOpen) return;
    this.#main.replaceChildren(shown.article);
    shown.article.querySelector("h2")?.focus();
    this.#writeAddress();
  }

  /** Replaces the present entry of the browser's history; a new slide adds an entry, so that Back returns to the previous slide. */
  #writeAddress(entry: "same" | "another" = "same"): void {
    const shown = this.#shown;
    if (!shown || !this.#isOpen) return;
    const start = initialValues(shown.lesson);
    const changed = Object.entries(shown.controls.values).filter(([key, value]) => value !== start[key]);
    const state = new URLSearchParams({
      at: shown.lesson.id,
      ...Object.fromEntries(changed.map(([key, value]) => [key, String(value)])),
      ...languageInAddress(),
    });
    shown.embed.show(`#learn&${state}`);
    const address = `#learn&${state}${this.#slides.isOpen ? "&slides" : ""}${this.#isEmbedded ? "&embed" : ""}`;
    if (entry === "same") history.replaceState(null, "", address);
    else history.pushState(null, "", address);
  }
}

const titleOf = (lesson: Lesson): string => `${lessons.indexOf(lesson) + 1}. ${lesson.title}`;

/** On a phone the figure may be out of view when a button below it is pressed. */
function showFigure(box: HTMLElement): void {
  const { top, height } = box.getBoundingClientRect();
  if (top < 0 || top + Math.min(height, innerHeight / 2) > innerHeight) box.scrollIntoView({ block: "start" });
}

const slideOf = ({ article, lesson: { id, title } }: Shown): Slide => ({
  article,
  title,
  hasBeside: (by) => beside(id, by) !== undefined,
});
