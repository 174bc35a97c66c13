// The frames of figures, which the page shows before it computes them, against the figures.
import assert from "node:assert/strict";
import { test } from "node:test";
import { learn, lessons } from "./lesson-figures.mjs";

test("lesson 11 keeps its curve while it registers, and marks the error that is left", () => {
  const panels = [...learn.pose({ run: "register", light: "window", offset: 20 })].map((each) => each.panels);
  const curves = panels.map((all) => all.find(({ key }) => key === "curve"));
  assert.ok(curves.every((curve) => curve !== undefined));
  assert.equal(curves.at(-1).series[0].points.length, 26);
  assert.ok(Math.abs(curves[0].at - 20) < 0.01 && Math.abs(curves.at(-1).at) < 1);
});

test("lesson 10 shows its curve only once a share is given, because the curve answers its question", () => {
  const lesson = lessons.find(({ id }) => id === "prior");
  const points = (share) => {
    const asked = new URLSearchParams(share === undefined ? [] : [["share", String(share)]]);
    const drawings = [...learn.prior(learn.computed(lesson, learn.valuesFrom(lesson, asked)))];
    return drawings.at(-1).panels.find(({ key }) => key === "figure5").series[0].points;
  };
  assert.equal(points().length, 2);
  assert.equal(points(20).length, 16);
});

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
