/** Exercises on slides: each stands on the slide of the lesson to which its first link leads, after the lesson's own questions. */

import { make } from "../dom";
import { phrase } from "../words";
import { answerOf, exercises, type Exercise } from "./exercises";
import { type Lesson, valuesFrom } from "./lesson";
import { sentence } from "./maths";
import type { Values } from "./protocol";
import { translated } from "./translation";

/** A question on a slide. */
export interface Form {
  element: HTMLElement;
  /** Puts the question, without an earlier guess, or takes it away. */
  ask(isAsked: boolean): void;
  /** Shows the answer, or takes it away and returns the figure to the state of the question. */
  answer(): void;
}

const settings = (address: string) => new URLSearchParams(address.replace(/^#/, ""));
const isOf = (lesson: Lesson, address: string): boolean => settings(address).get("at") === lesson.id;

export const exercisesOf = (lesson: Lesson, set: (values: Values) => void): Form[] =>
  translated(exercises, ["exercises"])
    .filter(({ links: [first] }) => first !== undefined && isOf(lesson, first[0]))
    .map((exercise) => formOf(exercise, lesson, set));

function formOf({ title, question, links, answer }: Exercise, lesson: Lesson, set: (values: Values) => void): Form {
  const show = (address: string) => set(valuesFrom(lesson, settings(address)));
  const states = links.map(([address, words]) => {
    // Another part of the page is opened in the place of the slides.
    if (!isOf(lesson, address)) return make("a", { href: address }, words);
    const button = make("button", { type: "button" }, words);
    button.addEventListener("click", () => show(address));
    return button;
  });
  const details = answerOf(answer);
  const element = make(
    "section",
    { class: "learn-asked", "aria-label": `${phrase("exercise", "Exercise")}: ${title}` },
    make("p", {}, make("strong", {}, `${title}.`), " ", ...sentence(question)),
    make("p", { class: "learn-links" }, ...states),
    details,
  );
  const open = (isOpen: boolean) => {
    details.open = isOpen;
    element.toggleAttribute("data-open", isOpen);
  };
  const ask = (isNow: boolean) => {
    element.toggleAttribute("data-asked", isNow);
    open(false);
    const [first] = links;
    if (isNow && first) show(first[0]);
  };
  return { element, ask, answer: () => open(!details.open) };
}
