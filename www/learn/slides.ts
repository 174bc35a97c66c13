/** One figure at a time in large type for presenting to a class. Keys turn the slides, ask the lesson's questions and show answers. */

import { make, onClosed } from "../dom";
import { phrase } from "../words";
import type { Chosen } from "./chosen";
import type { Guesses } from "./guesses";
import { Overview, type OverviewHooks } from "./overview";
import type { LessonId } from "./protocol";

/** The least height of a panel (picture, title and legend) below a list of symbols, as a share of the slide's. */
const LEAST_PANEL = 0.405;
/** Elements that use the arrow keys themselves. */
const MOVED_BY_ARROWS = "input:not([type=checkbox]), select, textarea";
/** Elements in which letters choose an option. A field for a number takes no letter that is a command. */
const TAKES_LETTERS = "select";
/** Elements to which the Enter key belongs. */
const TAKES_ENTER = "button, a, summary, input, select, textarea";
/** Elements that keep the focus after a press of the pointer and would then take the arrow keys. */
const KEEPS_FOCUS = "input:is([type=range], [type=radio]), label";

export interface Slide {
  article: HTMLElement;
  id: LessonId;
  title: string;
  /** The slides of the show, in their order. */
  chosen: Chosen;
  /** The questions, which take the place of the lesson's sentence. */
  guesses: Guesses;
  /** Whether the slide begins with its first question. */
  asksFirst: boolean;
}

export interface SlidesHooks extends OverviewHooks {
  turn(by: 1 | -1): void;
  close(): void;
}

export class Slides {
  readonly element: HTMLDialogElement;
  readonly #holder = make("div", { class: "learn-slide" });
  readonly #turns: readonly { by: 1 | -1; button: HTMLButtonElement }[];
  readonly #question = make("button", { type: "button" });
  readonly #overview: Overview;
  readonly #hooks: SlidesHooks;
  readonly #answer = make("button", { type: "button" }, `${phrase("answer", "Answer")} (A)`);
  #slide: Slide | undefined;
  #asked: number | undefined;
  #chosen: Chosen = [];
  /** What the pointer pressed, if no key has been pressed since. */
  #pressed: EventTarget | null = null;

  constructor(hooks: SlidesHooks) {
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
    // A list that the pointer opened keeps the focus until its choice is made.
    this.element.addEventListener("pointerdown", ({ target }) => (this.#pressed = target));
    this.element.addEventListener("change", ({ target }) => {
      if (target === this.#pressed && target instanceof HTMLSelectElement) this.#focus();
    });
    // After a typed guess the keys are commands again.
    this.element.addEventListener("submit", () => this.#focus());
    this.element.addEventListener("click", () => this.#blank(false));
    new ResizeObserver(() => this.#explain()).observe(this.#holder);
    onClosed(this.element, () => {
      this.#blank(false);
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
    this.#answer.addEventListener("click", () => this.#slide?.guesses.answer());
    return make("div", { class: "learn-slide-bar" }, ...turning, this.#question, this.#answer, whole, close);
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
    this.#put(undefined);
    this.count(slide.chosen);
    if (!isAnother && slide.article.parentElement === this.#holder) return;
    this.#holder.replaceChildren(slide.article);
    this.#holder.scrollTop = 0;
    this.#explain();
    if (slide.asksFirst) this.#put(0);
    // A removed control loses the focus, and then the keys would have no target.
    this.#focus();
  }

  /** Counts among these slides. */
  count(chosen: Chosen): void {
    const { id } = this.#slide ?? {};
    if (!id) return;
    this.#chosen = chosen;
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
  get #next(): number | undefined {
    const next = (this.#asked ?? -1) + 1;
    return next < (this.#slide?.guesses.names.length ?? 0) ? next : undefined;
  }

  #ask(): void {
    this.#put(this.#next);
    const field = this.#holder.querySelector<HTMLInputElement>(".learn-guess[data-asked] input[type=number]");
    if (field) field.focus({ preventScroll: true });
    else this.#focus();
  }

  #put(index: number | undefined): void {
    this.#asked = index;
    this.#answer.hidden = index === undefined;
    const next = this.#next;
    const sentence = phrase("slides.sentence", "Sentence (Q)");
    this.#question.textContent = (next === undefined ? undefined : this.#slide?.guesses.names[next]) ?? sentence;
    this.#slide?.guesses.ask(index);
  }

  /**
   * Lists the symbols of the formula if their lines leave enough height to the pictures. Measures panels, because their height is the same
   * before and after their pictures are drawn.
   */
  #explain(): void {
    this.#holder.removeAttribute("data-terse");
    const { clientHeight = 0 } = this.#holder.querySelector(".learn-panel") ?? {};
    this.#holder.toggleAttribute("data-terse", clientHeight < LEAST_PANEL * this.#holder.clientHeight);
  }

  /** The page as a whole, because no browser gives the screen to a dialog. Where it refuses, the slide stays in the window. */
  #fill(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => {});
  }

  /** Covers the slide, so that the class looks at the lecturer. */
  #blank(isBlank: boolean): void {
    this.element.toggleAttribute("data-blank", isBlank);
  }

  #key(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    this.#pressed = null;
    if (this.element.hasAttribute("data-blank")) return this.#wake(event);
    const within = (selector: string) => event.target instanceof Element && event.target.closest(selector) !== null;
    const isNumber = event.target instanceof HTMLInputElement && event.target.matches("[type=number]");
    const isTyped = isNumber && (event.target.value !== "" || event.target.validity.badInput);
    const isPoint = event.key === "." && isTyped;
    if (!within(TAKES_LETTERS) && !isPoint && this.#command(event)) return event.preventDefault();
    if (event.key === "Enter" && !within(TAKES_ENTER)) return this.#compare();
    if (/^(Arrow|Home|End)/.test(event.key) && within(MOVED_BY_ARROWS) && (isTyped || !isNumber)) return;
    const end = { Home: this.#chosen[0], End: this.#chosen.at(-1) }[event.key];
    const by = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 }[event.key] as 1 | -1 | undefined;
    if (end === undefined && by === undefined) return;
    event.preventDefault();
    if (by !== undefined) this.#hooks.turn(by);
    else if (end !== undefined && end !== this.#slide?.id) this.#hooks.jump(end);
  }

  /** The first key on a black screen does nothing else. A key that is held down since then is not another one. */
  #wake(event: KeyboardEvent): void {
    event.preventDefault();
    if (!event.repeat) this.#blank(false);
  }

  #compare(): void {
    this.#holder.querySelector<HTMLFormElement>(".learn-guess[data-asked]")?.requestSubmit();
  }

  /** Whether the key is a command's. */
  #command({ key, repeat }: KeyboardEvent): boolean {
    const commands: Record<string, () => void> = {
      f: () => this.#fill(),
      q: () => this.#ask(),
      a: () => this.#slide?.guesses.answer(),
      b: () => this.#blank(true),
      ".": () => this.#blank(true),
    };
    const run = commands[key];
    if (!repeat) run?.();
    return run !== undefined;
  }
}
