/** The text of a lesson: its formula, its paragraphs with the questions before their answers, its tasks and its links. */

import { make } from "../dom";
import { phrase } from "../words";
import type { Embed } from "./embed";
import type { Guesses } from "./guesses";
import type { Lesson } from "./lesson";
import { beside, titleOf } from "./lessons";
import { sentence, symbolList } from "./maths";
import { referencesOf } from "./references";

interface Parts {
  embed: Embed;
  slides: HTMLButtonElement;
  guesses: Guesses;
  answers: HTMLButtonElement;
  tries: HTMLElement;
  /** The address of another lesson in the state in which it was left. */
  linkTo(lesson: Lesson): string;
}

export function proseOf(lesson: Lesson, { embed, slides, guesses, answers, tries, linkTo }: Parts): HTMLElement {
  const formula = make(
    "div",
    { class: "learn-formula", role: "group", tabindex: "0", "aria-label": lesson.formulaWords },
    lesson.formula(),
  );
  return make(
    "div",
    { class: "learn-text" },
    make("div", { class: "learn-head" }, make("h2", { tabindex: "-1" }, titleOf(lesson)), embed.button, slides),
    embed.element,
    make("p", { class: "learn-gist" }, lesson.gist),
    formula,
    symbolList(formula, lesson.symbols),
    ...(lesson.stages ? [loopOf(lesson.stages)] : []),
    ...paragraphs(lesson, guesses.elements),
    answers,
    ...guesses.exercises,
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
    ends(lesson, linkTo),
  );
}

/** Each question stands before the paragraph that answers it. */
const paragraphs = ({ text, guesses }: Lesson, forms: readonly HTMLElement[]): HTMLElement[] =>
  text.flatMap((words, at) => [
    ...forms.filter((_, index) => guesses[index]?.before === at),
    make("p", {}, ...sentence(words)),
  ]);

/** The stages of a loop; the style sheet draws the arrows, the last one back to the first stage. */
const loopOf = (stages: readonly string[]): HTMLElement =>
  make("ol", { class: "learn-loop" }, ...stages.map((stage) => make("li", {}, stage)));

function ends({ id }: Lesson, linkTo: Parts["linkTo"]): HTMLElement {
  const [before, after] = [beside(id, -1), beside(id, 1)];
  return make(
    "p",
    { class: "learn-ends" },
    ...(before ? [make("a", { href: linkTo(before) }, `← ${before.title}`)] : []),
    after
      ? make("a", { href: linkTo(after) }, `${after.title} →`)
      : make("a", { href: "#learn&at=exercises" }, `${phrase("exercises", "Exercises")} →`),
  );
}
