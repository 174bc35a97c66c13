/** The settings in which a visitor left each lesson. They outlast a change of the language. */

import { type Lesson, initialValues } from "./lesson";
import { lessonNamed } from "./lessons";
import type { LessonId, Values } from "./protocol";

export class Kept {
  readonly #values = new Map<LessonId, Values>();

  of(lesson: Lesson): Values {
    return this.#values.get(lesson.id) ?? initialValues(lesson);
  }

  keep({ id }: Lesson, values: Values): void {
    this.#values.set(id, values);
  }

  forget(): void {
    this.#values.clear();
  }

  /** A lesson with its settings, and more, as a part of an address. */
  inAddress(id: LessonId, more: Record<string, string> = {}): URLSearchParams {
    const lesson = lessonNamed(id);
    const state = new URLSearchParams({ at: id });
    if (lesson) {
      const start = initialValues(lesson);
      for (const [key, value] of Object.entries(this.of(lesson)))
        if (value !== start[key]) state.set(key, String(value));
    }
    for (const [key, value] of Object.entries(more)) state.set(key, value);
    return state;
  }
}
