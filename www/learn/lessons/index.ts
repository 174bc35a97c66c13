/** All lessons in their order, and their chapters. */

import type { Lesson } from "../lesson";
import { translated } from "../translation";
import type { LessonId } from "../protocol";
import { relief, strips } from "./classical";
import { lambert, normal } from "./first";
import { colours, grey, pixel } from "./light";
import { failure, paint } from "./limits";
import { loop, sensor } from "./loop";
import { orders } from "./orders";
import { pose } from "./pose";
import { prior, surface } from "./shape";

interface Chapter {
  /** A name for its words in other languages. */
  id: string;
  title: string;
  lessons: readonly Lesson[];
}

const english: readonly Chapter[] = [
  { id: "pixel", title: "One pixel", lessons: [normal, lambert, relief, strips, orders, pixel, grey, colours] },
  { id: "surface", title: "A surface", lessons: [surface, prior] },
  { id: "views", title: "Two views", lessons: [pose, loop, sensor, paint, failure] },
];

/** In the language of the page. */
export let chapters = english;
export let lessons: readonly Lesson[] = english.flatMap((chapter) => chapter.lessons);

/** Takes the words of the catalogue in use. */
export function retell(): void {
  chapters = english.map(({ id, title, lessons }) => ({
    id,
    title: translated(title, ["chapters", id]),
    lessons: lessons.map((lesson) => translated(lesson, ["lessons", lesson.id])),
  }));
  lessons = chapters.flatMap((chapter) => chapter.lessons);
}

export function lessonNamed(name: string | null): Lesson | undefined {
  return lessons.find(({ id }) => id === name);
}

/** The title of a lesson after its number. */
export const titleOf = (lesson: Lesson): string => `${lessons.indexOf(lesson) + 1}. ${lesson.title}`;

/** The neighbour of a lesson; the first and the last have only one. */
export function beside(id: LessonId, by: 1 | -1): Lesson | undefined {
  return lessons[lessons.findIndex((lesson) => lesson.id === id) + by];
}
