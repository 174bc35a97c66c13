// The frames of figures, which the page shows before it computes them, against the figures.
import assert from "node:assert/strict";
import { test } from "node:test";
import { learn, lessons } from "./lesson-figures.mjs";

test("the frame of each lesson has the panels of its figure in their order", () => {
  for (const lesson of lessons) {
    const drawings = learn[lesson.id](learn.computed(lesson, learn.valuesFrom(lesson, new URLSearchParams())));
    const { panels } = drawings.next().value;
    drawings.return();
    assert.deepEqual(
      learn.FRAMES[lesson.id],
      panels.map(({ kind }) => kind),
      lesson.id,
    );
  }
});
