/** Questions before a surprise: a guess is chosen or typed, then the figure shows the answer. */

import { freshId, make } from "../dom";
import { inFigures, phrase } from "../words";
import type { Guess, Lesson, Try } from "./lesson";
import { sentence } from "./maths";
import { decimals, withUnit } from "./digits";
import { exercisesOf, type Form } from "./asked";
import type { Drawing, Values } from "./protocol";

interface Hooks {
  /** Sets the state that a question is about. */
  set(values: Values): void;
  /** The present state. */
  values(): Values;
  /** Reveals the answer; `last` is called just before the figure goes to its last state, whose drawing may be known. */
  reveal(what: Try, last: () => void): void;
  /** Whether answers are hidden at present. */
  areHidden(): boolean;
  /** Hides a panel of the figure on a slide, or none. */
  cover(panel: string | undefined): void;
}

export class Guesses {
  readonly elements: readonly HTMLElement[];
  /** The exercises that begin at this lesson, for its slide. */
  readonly exercises: readonly HTMLElement[];
  /** What the slide's button says about each question before it is put. */
  readonly names: readonly string[];
  readonly #guesses: readonly Guess[];
  readonly #forms: readonly Form[];
  readonly #hooks: Hooks;
  /** Called with the next complete drawing. */
  #waiting: ((drawing: Drawing, values: Values) => void) | undefined;
  /** Reveals the answer to the last guess that was made while answers were hidden. */
  #held: (() => void) | undefined;
  /** The question on a slide. */
  #asked: Form | undefined;
  /** The state of the figure before the first question on a slide. */
  #before: Values | undefined;

  constructor(lesson: Lesson, hooks: Hooks) {
    this.#hooks = hooks;
    const forms = lesson.guesses.map((guess) => this.#form(guess));
    const exercises = exercisesOf(lesson, (values) => hooks.set(values));
    this.elements = forms.map(({ element }) => element);
    this.exercises = exercises.map(({ element }) => element);
    this.#forms = [...forms, ...exercises];
    this.#guesses = lesson.guesses;
    this.names = [
      ...forms.map((_, at) => phrase("slides.ask", "Question {number} (Q)", { number: at + 1 })),
      ...exercises.map(() => phrase("slides.exercise", "Exercise (Q)")),
    ];
  }

  /** The state in which a slide was before its questions, while one of them is asked. */
  get before(): Values | undefined {
    return this.#before;
  }

  /** Puts one question or exercise on a slide, or none. After the questions the figure returns to the state that the lecturer prepared. */
  ask(index: number | undefined): void {
    this.#held = undefined;
    this.#waiting = undefined;
    const before = (this.#before ??= index === undefined ? undefined : this.#hooks.values());
    this.#asked = index === undefined ? undefined : this.#forms[index];
    for (const form of this.#forms) form.ask(form === this.#asked);
    this.#hooks.cover(index === undefined ? undefined : this.#guesses[index]?.covers);
    if (this.#asked) return;
    this.#before = undefined;
    if (before) this.#hooks.set(before);
  }

  /** Shows the answer of the question on a slide, or takes it away. */
  answer(): void {
    this.#asked?.answer();
  }

  /** Answers are no longer hidden. */
  release(): void {
    this.#held?.();
    this.#held = undefined;
  }

  /** Takes the drawing of the present values. */
  drawn(drawing: Drawing, values: Values): void {
    this.#waiting?.(drawing, values);
    this.#waiting = undefined;
  }

  #form(guess: Guess): Form {
    const { form, field, compare, noted, answer } = partsOf(guess);
    const empty = () => {
      noted.replaceChildren();
      answer.replaceChildren();
    };
    const reveal = (given: number | undefined) => {
      empty();
      form.toggleAttribute("data-open", true);
      this.#hooks.cover(undefined);
      // A search takes seconds.
      noted.append(phrase("figure.computing", "Computing"));
      // The answer is about the state of the question, even if the visitor has moved something since.
      this.#hooks.set(guess.at);
      this.#hooks.reveal(guess.reveal, () => {
        this.#waiting = (drawing, values) => {
          noted.replaceChildren();
          if (given === undefined) delete answer.dataset.right;
          else answer.dataset.right = String(isRight(guess, given, drawing, values));
          answer.replaceChildren(...verdict(guess, given, drawing, values));
        };
      });
    };
    let isAsked = false;
    form.addEventListener("input", () => {
      compare.disabled = field.value() === undefined;
      // Once, so that a guess can be changed while the figure shows something else.
      if (!isAsked) this.#hooks.set(guess.at);
      isAsked = true;
    });
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const given = field.value();
      if (given === undefined) return;
      // On a slide the lecturer may have shown this answer.
      if (!this.#hooks.areHidden() || form.matches("[data-asked][data-open]")) return reveal(given);
      empty();
      noted.append(phrase("guess.noted", "Your guess is noted. The answer is still hidden."));
      this.#held = () => reveal(given);
    });
    const ask = (isNow: boolean) => {
      form.toggleAttribute("data-asked", isNow);
      form.removeAttribute("data-open");
      empty();
      if (!isNow) return;
      form.reset();
      compare.disabled = true;
      isAsked = true;
      this.#hooks.set(guess.at);
    };
    const toggle = () => {
      if (!form.hasAttribute("data-open")) return reveal(field.value());
      form.removeAttribute("data-open");
      empty();
      this.#waiting = undefined;
      this.#hooks.cover(guess.covers);
      this.#hooks.set(guess.at);
    };
    return { element: form, ask, answer: toggle };
  }
}

function partsOf(guess: Guess) {
  const answer = make("p", { class: "learn-answer", role: "status" });
  const noted = make("p", { class: "soft learn-noted", "aria-live": "polite" });
  const compare = make("button", { type: "submit", disabled: true }, phrase("guess.compare", "Compare"));
  const field = guess.choices ? choicesOf(guess.choices) : numberOf(guess);
  const form = make(
    "form",
    { class: "learn-guess" },
    make("p", { class: "soft learn-guess-head" }, phrase("guess", "Predict, then look")),
    make("fieldset", {}, make("legend", {}, ...sentence(guess.question)), field.element),
    compare,
    noted,
    answer,
  );
  return { form, field, compare, noted, answer };
}

interface Field {
  element: HTMLElement;
  value(): number | undefined;
}

function choicesOf(choices: readonly string[]): Field {
  const name = freshId("learn-guess");
  const inputs = choices.map((_, index) => make("input", { type: "radio", name, value: index }));
  return {
    element: make(
      "div",
      { class: "learn-choices" },
      ...choices.map((words, index) => make("label", {}, inputs[index] as Node, ...sentence(words))),
    ),
    value: () => {
      const at = inputs.findIndex(({ checked }) => checked);
      return at < 0 ? undefined : at;
    },
  };
}

function numberOf({ number }: Guess): Field {
  const input = make("input", { type: "number", step: "any", inputmode: "decimal" });
  return {
    element: make(
      "label",
      { class: "learn-typed" },
      phrase("guess.yours", "Your guess"),
      input,
      number?.unit?.trim() ?? "",
    ),
    value: () => (Number.isFinite(input.valueAsNumber) ? input.valueAsNumber : undefined),
  };
}

const numberShown = ({ number }: Guess, { numbers }: Drawing, values: Values): number =>
  number ? (numbers[number.key] ?? Number(values[number.key])) : NaN;

function isRight(guess: Guess, given: number, drawing: Drawing, values: Values): boolean {
  if (guess.choices) return given === guess.right;
  return Math.abs(given - numberShown(guess, drawing, values)) <= (guess.number?.within ?? 0);
}

/** The answer; with a guess, what it was and whether it is right. */
function verdict(guess: Guess, given: number | undefined, drawing: Drawing, values: Values): (Node | string)[] {
  if (given === undefined) return sentence(guess.answer);
  const good = isRight(guess, given, drawing, values);
  const shows = numberShown(guess, drawing, values);
  const { digits = 0, unit } = guess.number ?? {};
  const said = guess.choices?.[given] ?? withUnit(inFigures(String(given)), unit?.trim());
  const near = Math.abs(shows) < 10 ** -digits / 2 ? 0 : shows;
  const head = good
    ? guess.choices || decimals(given, digits) === decimals(near, digits)
      ? phrase("guess.right", "Right.")
      : phrase("guess.near", "Close.")
    : phrase("guess.wrong", "Not quite.");
  const chosen = phrase("guess.chose", "You guessed: {guess}.", { guess: said });
  // The answer to a right choice begins with that choice. On a slide the choice is still in view.
  const words =
    good && guess.choices ? [] : [make("span", { class: guess.choices ? "learn-chose" : undefined }, ` ${chosen}`)];
  return [make("strong", {}, head), ...words, " ", ...sentence(guess.answer)];
}
