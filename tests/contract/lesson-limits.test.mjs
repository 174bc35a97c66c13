// What the lessons say about the limits of the model, and a picture of the albedo that shows all of it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { exercises, learn, lessons } from "./lesson-figures.mjs";

const textOf = (id) => {
  const { text, tasks, guesses } = lessons.find((lesson) => lesson.id === id);
  return [...text, ...tasks, ...guesses.flatMap(({ question, answer }) => [question, answer])].join("\n");
};

test("nine numbers for the logarithm are said to be a choice, and the theorem to be about the intensity", () => {
  const orders = textOf("orders");
  assert.match(orders, /the intensity under any distant light, .*\(Ramamoorthi and Hanrahan\)/);
  assert.match(orders, /follows Barron and Malik and uses nine numbers for the logarithm/);
  assert.match(orders, /a choice, not a theorem/);
});

test("cast shadows and reflected light are said to be left out", () =>
  assert.match(
    textOf("pixel"),
    /leaves out cast shadows, highlights and light that other parts of the object reflect/,
  ));

test("where the light is known, its exposure is said to be free", () => {
  const prior = textOf("prior");
  assert.match(prior, /The light is known except for the exposure/);
  assert.match(prior, /all pixels share the exposure/);
});

test("the smallest eigenvalue divides the variance of the noise, not the noise", () => {
  const all = exercises.flatMap(({ answer }) => answer).filter((words) => /smallest eigenvalue/.test(words));
  assert.equal(all.length, 1);
  assert.match(all[0], /variance of the normal is that of the noise divided by the smallest eigenvalue/);
});

test("no panel of an albedo is clipped to white, whatever the shadow", () => {
  const lesson = lessons.find(({ id }) => id === "paint");
  for (const state of ["paint=0.8", "paint=0.8&shadow=0.9", "paint=0&shadow=0.9"]) {
    const values = learn.computed(lesson, learn.valuesFrom(lesson, new URLSearchParams(state)));
    const drawing = [...learn.paint(values)].at(-1);
    const { pixels } = drawing.panels.find(({ key }) => key === "albedo");
    const colours = Array.from({ length: pixels.length / 4 }, (_, at) => pixels.subarray(4 * at, 4 * at + 4));
    const drawn = colours.filter(([, , , alpha]) => alpha > 0);
    const white = drawn.filter(([red, green, blue]) => Math.min(red, green, blue) === 255);
    assert.ok(
      drawn.length > 1000 && white.length < 0.02 * drawn.length,
      `${state}: ${white.length} of ${drawn.length}`,
    );
  }
});
