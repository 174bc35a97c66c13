/** Learn: lessons in three chapters, each a short text beside a live figure, with exercises and slides. */

import "../style/learn.css";
import "../style/learn-prose.css";
import "../style/embed.css";
import "../style/learn-figure.css";
import "../style/learn-marks.css";
import "../style/learn-blank.css";
import "../style/learn-print.css";
import "../style/learn-slides.css";
import "../style/learn-symbols.css";
import { make } from "../dom";
import { saveJson } from "../save";
import { phrase } from "../words";
import { Address } from "./address";
import { Ahead } from "./ahead";
import { Answers } from "./answers";
import { type Chosen, chosenBy, slidesInAddress } from "./chosen";
import { Controls } from "./controls";
import { Embed } from "./embed";
import { exerciseList } from "./exercises";
import { Figure, showFigure } from "./figure";
import { Fit } from "./fit";
import { FRAMES } from "./frames";
import { Guesses } from "./guesses";
import type { Kept } from "./kept";
import { languageInAddress } from "./language";
import { type Lesson, computed, followedIn, valuesFrom } from "./lesson";
import { chapters, lessonNamed, lessons, titleOf } from "./lessons";
import { lightTogether } from "./lit";
import { sentence } from "./maths";
import { TextNumbers } from "./numbers";
import { Player } from "./player";
import { proseOf } from "./prose";
import type { Drawing, LessonId, Values } from "./protocol";
import { Readouts } from "./readouts";
import { teachersLink } from "./references";
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
    onEarlier: (drawing) => this.#follow(drawing),
    onFault: ({ message }) => this.#complain(message),
  });
  readonly #ahead = new Ahead();
  readonly #kept: Kept;
  readonly #links = new Map<LessonId, HTMLAnchorElement>();
  readonly #contents = make("div", { class: "learn-chapters" });
  readonly #main = make("div", { class: "learn-main" });
  readonly #answers: Answers;
  readonly #exercises: HTMLElement;
  readonly #exerciseLink = make(
    "a",
    { href: "#learn&at=exercises", "data-to": "exercises" },
    phrase("exercises", "Exercises"),
  );
  readonly #slides: Slides;
  readonly #address = new Address();
  #chosen: Chosen = chosenBy("");
  /** Whether slides begin with their questions. */
  #asksFirst = false;
  #shown: Shown | undefined;
  #isOpen = false;
  /** The figure alone, in a frame of another page. */
  #isEmbedded = false;

  /** `tools` stand below the contents. */
  constructor(parent: HTMLElement, { kept, tools }: { kept: Kept; tools: HTMLElement[] }) {
    this.#kept = kept;
    for (const chapter of chapters) {
      const list = make("ol", { "aria-label": chapter.title });
      for (const { id, title } of chapter.lessons) {
        const link = make("a", { "data-to": id }, title);
        this.#links.set(id, link);
        this.#point(id);
        list.append(make("li", {}, link));
      }
      this.#contents.append(make("p", { class: "learn-chapter" }, chapter.title), list);
    }
    const nav = make(
      "nav",
      { class: "learn-contents", "aria-label": phrase("lessons", "Lessons") },
      this.#contents,
      make("p", {}, this.#exerciseLink),
      make("p", {}, teachersLink()),
      ...tools,
    );
    this.#answers = new Answers(parent, () => this.#toggleAnswers());
    this.#exercises = exerciseList(this.#answers.button());
    this.#slides = new Slides({
      turn: (by) => this.#turn(by),
      jump: (id) => this.#turnTo(id),
      choose: (chosen) => this.#choose(chosen),
      close: () => this.#endSlides(),
    });
    parent.append(nav, this.#main, this.#slides.element);
  }

  /**
   * Shows the lesson named in the address with the address's settings, whatever a visitor has set before; without one, the lesson shown last.
   * The page's own links contain what the visitor has set.
   */
  open(hash: string): void {
    this.#isOpen = true;
    this.#address.read();
    const asked = new URLSearchParams(hash.replace(/^#/, ""));
    this.#isEmbedded = asked.has("embed");
    if (asked.get("answers") === "hidden") this.#answers.hide();
    if (asked.get("at") === "exercises") return this.#showExercises();
    const slides = asked.get("slides");
    const lesson = this.#lessonIn(asked);
    const named = lessonNamed(asked.get("at")) ?? (slides ? lesson : undefined);
    // Slides that a link opens all begin with their own settings.
    if (slides !== null && !this.#slides.isOpen) this.#forget();
    if (slides !== null) this.#asksFirst = asked.has("ask");
    this.#show(lesson, named ? valuesFrom(lesson, asked) : this.#kept.of(lesson));
    if (slides !== null) this.#startSlides();
    // Returns from the slides to the lesson at which they were opened.
    else this.#slides.close();
    this.#writeAddress();
  }

  /** The lesson of an address, which has to be one of its slides. */
  #lessonIn(asked: URLSearchParams): Lesson {
    const lesson = lessonNamed(asked.get("at")) ?? this.#shown?.lesson ?? (lessons[0] as Lesson);
    const slides = asked.get("slides");
    if (slides === null) return lesson;
    this.#chosen = chosenBy(slides);
    const isAmong = this.#chosen.includes(lesson.id) && (slides === "" || asked.has("at"));
    return isAmong ? lesson : (lessonNamed(this.#chosen[0] ?? null) ?? lesson);
  }

  #forget(): void {
    this.#kept.forget();
    for (const id of this.#links.keys()) this.#point(id);
  }

  /** Nothing is computed for a hidden page. */
  leave(): void {
    if (!this.#isOpen) return;
    this.#isOpen = false;
    this.#shown?.player.stop();
    this.#session.end();
    this.#ahead.end();
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
    const before = this.#shown;
    before?.player.stop();
    if (before?.lesson === lesson) {
      before.controls.show(values);
      if (!this.#slides.isOpen && before.article.parentElement !== this.#main)
        this.#main.replaceChildren(before.article);
    } else {
      // Slides that have just closed still hold it.
      before?.article.remove();
      this.#shown = this.#make(lesson, values);
      if (this.#slides.isOpen) this.#slides.take(this.#slideOf(this.#shown));
      else this.#main.replaceChildren(this.#shown.article);
      // The link to this lesson is at the end of the previous one, so the page has to scroll up.
      if (before) scrollTo(0, 0);
    }
    this.#mark(lesson.id);
    this.#ask();
  }

  #showExercises(): void {
    this.#shown?.player.stop();
    this.#shown?.guesses.ask(undefined);
    this.#session.end();
    this.#slides.close();
    this.#main.replaceChildren(this.#exercises);
    this.#mark(undefined);
    this.#writeExercises();
  }

  #writeExercises(): void {
    const state = new URLSearchParams({ at: "exercises", ...this.#answers.inAddress, ...languageInAddress() });
    this.#address.write(`#learn&${state}`);
  }

  #toggleAnswers(): void {
    if (this.#exercises.isConnected) return this.#writeExercises();
    if (!this.#answers.areHidden) this.#shown?.guesses.release();
    this.#writeAddress();
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
    figure.outline(FRAMES[lesson.id]);
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
      set: (at) => {
        player.stop();
        controls.set(at);
      },
      values: () => controls.values,
      areHidden: () => this.#answers.areHidden,
      cover: (panel) => (box.dataset.covers = panel ?? ""),
      reveal: (what, last) => {
        showFigure(box);
        player.play(what, last);
      },
    });
    const tries = tryList(lesson, (what, task) => {
      look.replaceChildren(
        ...(task.look ? [make("strong", {}, phrase("look", "Look for this:")), " ", ...sentence(task.look)] : []),
      );
      showFigure(box);
      player.play(what);
    });
    const text = this.#text(lesson, embed, guesses, tries);
    const numbers = new TextNumbers(text, lesson, controls);
    const article = make("article", { class: "learn-lesson", "data-lesson": lesson.id }, text, box);
    lightTogether(article);
    const parts = { figure, fit: new Fit(box, figure.element), controls, readouts, player, guesses, numbers, embed };
    return { ...parts, lesson, article, box, alert, drawing: undefined };
  }

  #text(lesson: Lesson, embed: Embed, guesses: Guesses, tries: HTMLElement): HTMLElement {
    const slides = make("button", { type: "button", class: "learn-slides-button" }, phrase("slides", "Slides"));
    slides.addEventListener("click", () => {
      // A choice stays, because it was made for this class; a lesson outside it is shown among all.
      if (!this.#chosen.includes(lesson.id)) this.#chosen = chosenBy("");
      this.#startSlides();
      this.#writeAddress("another");
    });
    const linkTo = ({ id }: Lesson) => `#learn&${this.#kept.inAddress(id)}`;
    return proseOf(lesson, { embed, slides, guesses, answers: this.#answers.button(), tries, linkTo });
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
    const { lesson, controls } = shown;
    this.#kept.keep(lesson, controls.values);
    this.#point(lesson.id);
    shown.numbers.show(controls.values);
    shown.box.setAttribute("aria-busy", "true");
    shown.figure.wait();
    shown.readouts.wait();
    this.#writeAddress();
    const known = this.#slides.isOpen ? this.#ahead.drawing(lesson, controls.values) : undefined;
    if (!known) return this.#session.ask(lesson.id, computed(lesson, controls.values));
    // An answer under way is about other values.
    this.#session.forget();
    this.#draw(known, true);
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
    if (done && this.#slides.isOpen) this.#prepare(shown, drawing);
  }

  /** Pictures and numbers follow a drag, marked as earlier ones. */
  #follow(drawing: Drawing): void {
    const shown = this.#shown;
    if (!shown) return;
    const inWords = drawingIn(shown.lesson.id, drawing);
    shown.figure.follow(inWords);
    shown.readouts.show(inWords);
    shown.readouts.wait();
  }

  /** The next slide is computed while this one is looked at. */
  #prepare({ lesson, controls }: Shown, drawing: Drawing): void {
    this.#ahead.keep(lesson, controls.values, drawing);
    const next = lessonNamed(this.#chosen[this.#chosen.indexOf(lesson.id) + 1] ?? null);
    const question = this.#asksFirst ? next?.guesses[0]?.at : {};
    if (next) this.#ahead.prepare(next, { ...this.#kept.of(next), ...question });
  }

  #complain(message: string): void {
    const shown = this.#shown;
    if (!shown) return;
    const again = make("button", { type: "button" }, phrase("recompute", "Recompute"));
    again.addEventListener("click", () => this.#ask());
    shown.alert.replaceChildren(message, " ", again);
    shown.alert.hidden = false;
    shown.figure.outline([]);
    shown.box.setAttribute("aria-busy", "false");
  }

  #turn(by: 1 | -1): void {
    const next = this.#shown && this.#chosen[this.#chosen.indexOf(this.#shown.lesson.id) + by];
    if (next) this.#turnTo(next);
  }

  #turnTo(id: LessonId): void {
    const lesson = lessonNamed(id);
    if (!lesson) return;
    this.#recall();
    // Before the lesson is shown, because that writes the address of its values.
    this.#writeAddress("another");
    this.#show(lesson, this.#kept.of(lesson));
    this.#writeAddress();
  }

  /** A slide that is left at a question is found again in the state from before its questions. */
  #recall(): void {
    const { lesson, guesses } = this.#shown ?? {};
    if (!lesson || !guesses?.before) return;
    this.#kept.keep(lesson, guesses.before);
    this.#point(lesson.id);
    this.#writeAddress();
  }

  #choose(chosen: Chosen): void {
    this.#chosen = chosen;
    this.#slides.count(chosen);
    this.#writeAddress();
  }

  #startSlides(): void {
    const shown = this.#shown;
    if (!shown) return;
    if (this.#slides.isOpen) return this.#slides.count(this.#chosen);
    this.#slides.open(this.#slideOf(shown));
    if (shown.drawing && shown.box.getAttribute("aria-busy") === "false") this.#prepare(shown, shown.drawing);
  }

  #slideOf({ article, lesson: { id, title }, guesses }: Shown): Slide {
    return { article, id, title, guesses, chosen: this.#chosen, asksFirst: this.#asksFirst };
  }

  #endSlides(): void {
    const shown = this.#shown;
    // An address may have brought the exercises before this.
    if (!shown || !this.#isOpen || this.#exercises.isConnected) return;
    this.#main.replaceChildren(shown.article);
    shown.guesses.ask(undefined);
    shown.article.querySelector("h2")?.focus();
    this.#writeAddress();
  }

  /** Replaces the present entry of the browser's history; a new slide adds an entry, so that Back returns to the previous slide. */
  #writeAddress(entry: "same" | "another" = "same"): void {
    const shown = this.#shown;
    if (!shown || !this.#isOpen) return;
    const state = this.#kept.inAddress(shown.lesson.id, languageInAddress());
    shown.embed.show(`#learn&${state}`);
    for (const [key, value] of Object.entries(this.#answers.inAddress)) state.append(key, value);
    const slides = this.#slides.isOpen ? slidesInAddress(this.#chosen, this.#asksFirst) : "";
    const address = `#learn&${state}${slides}${this.#isEmbedded ? "&embed" : ""}`;
    this.#address.write(address, entry);
  }

  #point(id: LessonId): void {
    const link = this.#links.get(id);
    if (link) link.href = `#learn&${this.#kept.inAddress(id)}`;
  }
}
