/** The tasks of a lesson as buttons. Each button changes the figure and shows beside it what to look for. */

import { make } from "../dom";
import type { Lesson, Try } from "./lesson";
import { sentence } from "./maths";

export interface Task {
  /** The label of the button, which says what it does. */
  action: string;
  /** The text about what to look for. */
  look: string;
}

/** A task's first sentence and the rest. */
export function taskOf(words: string): Task {
  const end = words.search(/[.!?]\s/);
  return end < 0 ? { action: words, look: "" } : { action: words.slice(0, end + 1), look: words.slice(end + 2) };
}

export function tryList({ tasks, tries }: Lesson, onTry: (what: Try, task: Task) => void): HTMLElement {
  const items = tasks.map((words, index) => {
    const task = taskOf(words);
    const button = make("button", { type: "button", class: "learn-try" }, ...sentence(task.action));
    button.addEventListener("click", () => onTry(tries[index] ?? {}, task));
    return make("li", {}, button, make("p", {}, ...sentence(task.look)));
  });
  return make("ul", { class: "learn-tries" }, ...items);
}
