/**
 * Keeps the last drawing of each slide and computes that of the next one while the present one is looked at. It has a separate thread, so
 * that no drag on the present figure waits for it. A failure is not reported: the slide's own request will report it.
 */

import { type Lesson, computed } from "./lesson";
import type { Drawing, LessonId, Values } from "./protocol";
import { Session } from "./session";

interface Kept {
  values: string;
  drawing: Drawing;
}
const keyOf = (values: Values): string => JSON.stringify(values);

export class Ahead {
  readonly #kept = new Map<LessonId, Kept>();
  #wanted: { lesson: Lesson; values: Values } | undefined;
  readonly #session = new Session({
    onDrawing: (drawing, done) => {
      if (done && this.#wanted) this.keep(this.#wanted.lesson, this.#wanted.values, drawing);
    },
    onFault: () => this.#session.end(),
  });

  keep({ id }: Lesson, values: Values, drawing: Drawing): void {
    this.#kept.set(id, { values: keyOf(values), drawing });
  }

  /** The drawing of these values, if it is known. */
  drawing({ id }: Lesson, values: Values): Drawing | undefined {
    const kept = this.#kept.get(id);
    return kept?.values === keyOf(values) ? kept.drawing : undefined;
  }

  prepare(lesson: Lesson, values: Values): void {
    if (this.drawing(lesson, values)) return;
    this.#wanted = { lesson, values };
    this.#session.ask(lesson.id, computed(lesson, values));
  }

  end(): void {
    this.#session.end();
    this.#kept.clear();
  }
}
