/** All lessons in their order, and their chapters. */

import type { Lesson } from "../lesson";
import type { LessonId } from "../protocol";
import { relief, strips } from "./classical";
import { lambert, normal } from "./first";
import { colours, grey, pixel } from "./light";
import { failure, paint } from "./limits";
import { orders } from "./orders";
import { pose, sensor } from "./pose";
import { prior, surface } from "./shape";

interface Chapter {
  title: string;
  lessons: readonly Lesson[];
}

export const chapters: readonly Chapter[] = [
  { title: "One pixel", lessons: [normal, lambert, relief, strips, orders, pixel, grey, colours] },
  { title: "A surface", lessons: [surface, prior] },
  { title: "Two views", lessons: [pose, sensor, paint, failure] },
];

export const lessons: readonly Lesson[] = chapters.flatMap((chapter) => chapter.lessons);

export function lessonNamed(name: string | null): Lesson | undefined {
  return lessons.find(({ id }) => id === name);
}

/** The neighbour of a lesson; the first and the last have only one. */
export function beside(id: LessonId, by: 1 | -1): Lesson | undefined {
  return lessons[lessons.findIndex((lesson) => lesson.id === id) + by];
}
