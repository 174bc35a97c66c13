// The texts of the lessons and the answers of the exercises, against what their figures compute.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { claims } from "./lesson-claims.mjs";
import { chapters, contour, exercises, figure, learn, lessons, taskOf } from "./lesson-figures.mjs";
import { LONG } from "./long.mjs";

/** All sentences of a lesson, or of an exercise, under the name that a claim gives it. */
const texts = new Map([
  ...lessons.map(({ id, gist, text, tasks, guesses }) => [
    id,
    [gist, ...text, ...tasks, ...guesses.flatMap(({ question, answer }) => [question, answer])].join("\n"),
  ]),
  ...exercises.map(({ title, question, answer }) => [title, [question, ...answer].join("\n")]),
]);

/** The pattern of a claim, whose one group is the word or number to be checked, and the words that the group may be. */
function patternOf({ words }) {
  const escaped = (part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  const [before, options, after] = /^(.*)\[(.*)\](.*)$/s.exec(words).slice(1);
  const choices = options === "#" ? undefined : options.split("|");
  const group = choices ? choices.map(escaped).join("|") : "\\d+(?:\\.\\d+)?";
  return { choices, pattern: new RegExp(`${escaped(before)}(${group})${escaped(after)}`) };
}

/** The word or number that the text has where the claim's group is. */
function saidIn(text, claim) {
  const { pattern } = patternOf(claim);
  const found = pattern.exec(text);
  assert.ok(found, `"${claim.words}" is not in the text of ${claim.where}`);
  return found[1];
}

/** A number is right up to one unit of its last digit. */
function bears(said, right) {
  if (typeof right !== "number") return said === right;
  const digits = said.split(".")[1]?.length ?? 0;
  return Math.abs(Number(said) - right) <= 1.001 * 10 ** -digits;
}

/** A copy of the text with a wrong word or number in this claim. */
function turned(text, claim) {
  const { choices, pattern } = patternOf(claim);
  const said = saidIn(text, claim);
  const other = choices ? choices.find((word) => word !== said) : String(2 * Number(said) + 3);
  return text.replace(pattern, (all) => all.replace(said, other));
}

function check(text, claim) {
  const [said, right] = [saidIn(text, claim), claim.holds()];
  assert.ok(bears(said, right), `${claim.where}: "${claim.words}" says ${said}, and the figure ${right}`);
}

/** Lessons whose figures take over three seconds. */
const SLOW = new Set(["prior", "pose", "loop", "failure", "When minima merge", "A rotation that cannot be seen"]);

describe("what the text says, the figure shows", () => {
  for (const where of new Set(claims.map((claim) => claim.where)))
    test(where, SLOW.has(where) ? LONG : {}, () => {
      for (const claim of claims.filter((each) => each.where === where)) {
        check(texts.get(where), claim);
        assert.throws(() => check(turned(texts.get(where), claim), claim), assert.AssertionError, claim.words);
      }
    });
});

/** Tasks that only say what to do. */
const INSTRUCTIONS = ["Walk across the ball from left to right.", "Move the pixel across the bump."];

test("each lesson has claims, and each of its tasks has one unless it only says what to do", () => {
  for (const { id, tasks } of lessons) {
    const own = claims.filter(({ where }) => where === id);
    assert.ok(own.length >= 3, id);
    for (const task of tasks) {
      const isClaimed = own.some((claim) => patternOf(claim).pattern.test(task));
      assert.ok(isClaimed || INSTRUCTIONS.some((words) => task.startsWith(words)), `${id}: ${task}`);
    }
  }
});

test("each answer with a measured number has a claim", () => {
  for (const { title, answer } of exercises) {
    const numbers = answer.join(" ").match(/\d+\.\d+(?=°| of| px)/g) ?? [];
    const own = claims.filter(({ where }) => where === title);
    assert.ok(numbers.length === 0 || own.length >= numbers.length, title);
  }
});

test("there are at most fifteen lessons in three chapters, each with a summary and what one can do after it", () => {
  assert.deepEqual(
    chapters.map(({ title }) => title),
    ["One pixel", "A surface", "Two views"],
  );
  assert.ok(lessons.length <= 15 && lessons.length === chapters.flatMap((chapter) => chapter.lessons).length);
  for (const { id, gist, can } of lessons) assert.ok(/[.]$/.test(gist) && /^You can .+[.]$/.test(can), id);
});

/** Whether an action names controls of its lesson and values that they can have. */
function checkAction(lesson, { set = {}, sweep }) {
  const values = { ...set, ...(sweep ? { [sweep.key]: sweep.to } : {}) };
  const asked = new URLSearchParams(Object.entries(values).map(([key, value]) => [key, String(value)]));
  const taken = learn.valuesFrom(lesson, asked);
  for (const [key, value] of Object.entries(values)) assert.equal(taken[key], value, `${lesson.id}: ${key}`);
  if (sweep) assert.equal(lesson.controls.find(({ key }) => key === sweep.key).kind, "slider");
}

test("each task has a button that sets the figure, and says what to look for", () => {
  for (const lesson of lessons) {
    assert.equal(lesson.tries.length, lesson.tasks.length, lesson.id);
    for (const [index, task] of lesson.tasks.entries()) {
      const { action, look } = taskOf(task);
      assert.ok(action.length > 10 && look.length > 10, `${lesson.id}: ${task}`);
      checkAction(lesson, lesson.tries[index]);
    }
  }
});

test("each lesson has a guess before its surprise, which the figure answers", () => {
  for (const lesson of lessons) {
    assert.ok(lesson.guesses.length > 0, lesson.id);
    for (const { at, choices, right, number, reveal, answer } of lesson.guesses) {
      checkAction(lesson, { set: at });
      checkAction(lesson, reveal);
      assert.ok((choices === undefined) !== (number === undefined), lesson.id);
      // The answer repeats the beginning of the right choice and of no other choice.
      const begins = (words) => answer.startsWith(words.split(" ").slice(0, 3).join(" ").replace(/,$/, ""));
      if (choices)
        assert.deepEqual(
          choices.map(begins),
          choices.map((_, index) => index === right),
          answer,
        );
      assert.ok(answer.length > 20);
    }
  }
});

/** Words of a lesson that answer its questions, in the order of the questions. */
const ANSWERS = {
  normal: ["the nose before and after"],
  lambert: ["half of the intensity is left"],
  relief: ["together with another albedo", "It needs no other albedo"],
  strips: ["has its slopes somewhere on one isophote"],
  orders: ["moved from the zeroth order to the squares"],
  pixel: ["all three logarithms fall by the same number"],
  grey: ["by half a turn"],
  colours: ["Its three curves almost coincide"],
  surface: ["are unaffected by it"],
  prior: ["at first more than proportionally"],
  pose: ["the status is ambiguous"],
  loop: ["the minimum moves away from the true normal"],
  sensor: ["gives slopes from pixel to pixel"],
  paint: ["takes nearly all of it for albedo"],
  failure: ["No method can detect that rotation"],
};

test("each question stands before the paragraph that answers it, and nothing above gives the answer", () => {
  for (const { id, gist, text, guesses } of lessons)
    for (const [index, { before }] of guesses.entries()) {
      const words = ANSWERS[id]?.[index] ?? "";
      assert.ok(words !== "" && text[before]?.includes(words), `${id}: "${words}" is not in paragraph ${before}`);
      assert.ok(![gist, ...text.slice(0, before)].join("\n").includes(words), `${id}: "${words}" stands above`);
    }
});

test("no lamp is reported to have moved while it stays where it was", () => {
  assert.ok(figure("relief&stretch=0.4&lamp=0").lamp < 0.1);
  assert.ok(figure("relief&stretch=0.4&lamp=1").lamp > 10);
});

test("a line of equal value lies where the value is, and leaves out what is not known", () => {
  const side = 64;
  const distance = Float32Array.from({ length: side * side }, (_, at) =>
    Math.hypot(((at % side) + 0.5) / side - 0.5, (Math.floor(at / side) + 0.5) / side - 0.5),
  );
  const points = contour(distance, side, side, 0.3);
  let length = 0;
  for (let at = 0; at < points.length; at += 6) {
    for (const from of [at, at + 2])
      assert.ok(Math.abs(Math.hypot(points[from] - 0.5, points[from + 1] - 0.5) - 0.3) < 1e-3);
    assert.ok(Number.isNaN(points[at + 4]) && Number.isNaN(points[at + 5]));
    length += Math.hypot(points[at + 2] - points[at], points[at + 3] - points[at + 1]);
  }
  assert.ok(Math.abs(length - 2 * Math.PI * 0.3) < 0.01, `${length}`);
  const half = distance.map((value, at) => (at % side < side / 2 ? value : NaN));
  const left = contour(half, side, side, 0.3);
  assert.ok(left.length > 0 && left.every((value, at) => at % 2 === 1 || !(value > 0.5)));
  assert.deepEqual(contour(distance, side, side, 2), []);
});

test("the ambiguity of a grey picture is not said to be removed by a light or a depth map alone", () => {
  const grey = texts.get("grey");
  for (const words of ["Cast shadows", "occluding contours", "light comes from above"])
    assert.ok(grey.includes(words), words);
  assert.ok(!/almost zero|only a known light/i.test(grey));
});

test("each formula's albedo is in it or said to be constant, and the order of the lessons is as their texts say", () => {
  const at = (id) => 1 + lessons.findIndex((lesson) => lesson.id === id);
  assert.match(texts.get("grey"), new RegExp(`to lesson ${at("paint") - 1} the whole object has one albedo`));
  assert.match(
    texts.get("orders"),
    new RegExp(
      `\\(albedo 1\\).+Lesson ${at("pixel")} adds the albedo, lesson ${at("grey")} puts it into \\{M\\}, and lesson ${at("paint")} gives`,
    ),
  );
  for (const [id, named] of [
    ["lambert", ["normal"]],
    ["relief", ["surface", "prior"]],
    ["loop", ["surface", "pose", "sensor"]],
    ["colours", ["lambert"]],
    ["prior", ["sensor"]],
    ["failure", ["paint"]],
  ])
    for (const other of named) assert.match(texts.get(id), new RegExp(`[Ll]esson ${at(other)}\\b`), id);
  assert.match(texts.get("prior"), new RegExp(`lessons ${at("relief")} and ${at("grey")}`));
});
