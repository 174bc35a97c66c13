/** One figure at a time in large type for presenting to a class. Keys turn the slides, ask the lesson's questions and show answers. */

import { make } from "../dom";
import { phrase } from "../words";
import type { Answers } from "./answers";
import type { Chosen } from "./chosen";
import { Overview, type OverviewHooks } from "./overview";
import type { LessonId } from "./protocol";

/** Elements that use the arrow keys themselves. */
const MOVED_BY_ARROWS = "input:not([type=checkbox]), select, textarea";
/** Elements in which letters are typed or choose an option. */
const TAKES_LETTERS = "input[type=number], select";
/** Elements that keep the focus after a press of the pointer and would then take the arrow keys. */
const KEEPS_FOCUS = "input:is([type=range], [type=radio]), label";

export interface Slide {
  article: HTMLElement;
  id: LessonId;
  title: string;
  /** The slides of the show, in their order. */
  chosen: Chosen;
  /** The number of the lesson's questions. */
  questions: number;
  /** Puts a question in the place of the lesson's sentence; with none, the sentence returns. */
  ask(index: number | undefined): void;
}

export interface SlidesHooks extends OverviewHooks {
  turn(by: 1 | -1): void;
  close(): void;
}

export class Slides {
  readonly element: HTMLDialogElement;
  readonly #holder = make("div", { class: "learn-slide" });
  readonly #turns: readonly { by: 1 | -1; button: HTMLButtonElement }[];
  readonly #question = make(
    "button",
    { type: "button", "aria-pressed": "false" },
    phrase("slides.ask", "Question (Q)"),
  );
  readonly #overview: Overview;
  readonly #hooks: SlidesHooks;
  readonly #answers: Answers;
  #slide: Slide | undefined;
  #asked: number | undefined;

  constructor(answers: Answers, hooks: SlidesHooks) {
    this.#answers = answers;
    this.#hooks = hooks;
    this.#overview = new Overview(hooks);
    this.#turns = (
      [
        [phrase("slides.previous", "Previous lesson"), -1, "←"],
        [phrase("slides.next", "Next lesson"), 1, "→"],
      ] as const
    ).map(([words, by, sign]) => {
      const button = make("button", { type: "button", "aria-label": words }, sign);
      button.addEventListener("click", () => hooks.turn(by));
      return { by, button };
    });
    this.element = make("dialog", { class: "learn-slides" }, this.#holder, this.#bar());
    this.element.addEventListener("keydown", (event) => this.#key(event));
    // After a press of the pointer the arrow keys turn slides again; a control that the Tab key reached keeps them.
    this.element.addEventListener("click", ({ target, detail }) => {
      if (detail > 0 && target instanceof Element && target.matches(KEEPS_FOCUS)) this.#focus();
    });
    // After a typed guess the keys are commands again.
    this.element.addEventListener("submit", () => this.#focus());
    this.element.addEventListener("close", () => {
      if (document.fullscreenElement) void document.exitFullscreen();
      hooks.close();
    });
  }

  #bar(): HTMLElement {
    const close = make("button", { type: "button" }, phrase("slides.close", "Close (Esc)"));
    close.addEventListener("click", () => this.close());
    const canFill = document.fullscreenEnabled;
    const whole = make("button", { type: "button", hidden: !canFill }, phrase("slides.fill", "Full screen (F)"));
    whole.addEventListener("click", () => this.#fill());
    this.#question.addEventListener("click", () => this.#ask());
    const [previous, next] = this.#turns.map(({ button }) => button);
    const count = [this.#overview.button, this.#overview.element];
    const turning = [previous, ...count, next].filter((each) => each !== undefined);
    const answers = this.#answers.button(" (A)");
    return make("div", { class: "learn-slide-bar" }, ...turning, this.#question, answers, whole, close);
  }

  get isOpen(): boolean {
    return this.element.open;
  }

  open(slide: Slide): void {
    this.element.showModal();
    this.take(slide);
  }

  take(slide: Slide): void {
    const isAnother = this.#slide !== slide;
    this.#slide = slide;
    this.element.setAttribute("aria-label", phrase("slides.slide", "Slide: {title}", { title: slide.title }));
    this.#question.hidden = slide.questions === 0;
    this.#put(undefined);
    this.count(slide.chosen);
    if (!isAnother && slide.article.parentElement === this.#holder) return;
    this.#holder.replaceChildren(slide.article);
    this.#holder.scrollTop = 0;
    // A removed control loses the focus, and then the keys would have no target.
    this.#focus();
  }

  /** Counts among these slides. */
  count(chosen: Chosen): void {
    const { id } = this.#slide ?? {};
    if (!id) return;
    const at = chosen.indexOf(id);
    for (const { by, button } of this.#turns) button.disabled = chosen[at + by] === undefined;
    this.#overview.show(chosen, id);
  }

  #focus(): void {
    this.#holder.querySelector("h2")?.focus({ preventScroll: true });
  }

  close(): void {
    if (this.element.open) this.element.close();
  }

  /** The next question of the slide; after the last one, none. */
  #ask(): void {
    const next = (this.#asked ?? -1) + 1;
    this.#put(next < (this.#slide?.questions ?? 0) ? next : undefined);
    this.#focus();
  }

  #put(index: number | undefined): void {
    this.#asked = index;
    this.#question.setAttribute("aria-pressed", String(index !== undefined));
    this.#slide?.ask(index);
  }

  /** At an exercise, opens its answer or closes it; elsewhere, shows all answers or hides them. */
  #answer(): void {
    const fold = this.#holder.querySelector<HTMLDetailsElement>(".learn-asked[data-asked] details");
    if (!fold) return this.#answers.toggle();
    const isOpen = fold.open && !this.#answers.areHidden;
    if (this.#answers.areHidden) this.#answers.toggle();
    fold.open = !isOpen;
  }

  /** The page as a whole, because no browser gives the screen to a dialog. Where it refuses, the slide stays in the window. */
  #fill(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => {});
  }

  #key(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const within = (selector: string) => event.target instanceof Element && event.target.closest(selector) !== null;
    if (!event.repeat && !within(TAKES_LETTERS)) {
      if (event.key === "f") return this.#fill();
      if (event.key === "q") return this.#ask();
      if (event.key === "a") return this.#answer();
    }
    const by = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 }[event.key] as 1 | -1 | undefined;
    if (by === undefined) return;
    if (event.key.startsWith("Arrow") && within(MOVED_BY_ARROWS)) return;
    event.preventDefault();
    this.#hooks.turn(by);
  }
}
