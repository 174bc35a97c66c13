/** All lessons in their order. */

import type { Lesson } from "../lesson";
import { translated } from "../translation";
import type { LessonId } from "../protocol";
import { colours, grey, pixel } from "./light";
import { failure, paint } from "./limits";
import { pose, sensor } from "./pose";
import { prior, surface } from "./shape";

const english: readonly Lesson[] = [pixel, grey, colours, surface, prior, pose, sensor, paint, failure];
/** In the language of the page. */
export let lessons = english;

/** Takes the words of the catalogue in use. */
export function retell(): void {
  lessons = english.map((lesson) => translated(lesson, ["lessons", lesson.id]));
}

export function lessonNamed(name: string | null): Lesson | undefined {
  return lessons.find(({ id }) => id === name);
}

/** The neighbour of a lesson; the first and the last have only one. */
export function beside(id: LessonId, by: 1 | -1): Lesson | undefined {
  return lessons[lessons.findIndex((lesson) => lesson.id === id) + by];
}
