// Each catalogue of another language has exactly the texts of Learn, with the same symbols, numbers and details.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { describe, test } from "node:test";
import { inRoot } from "../../scripts/shell.mjs";
import { english, phrases } from "./english-words.mjs";

const FOLDER = "www/learn/languages";
const names = readdirSync(inRoot(FOLDER));

/** Words that are the same in English, by language. */
const SAME = {
  de: ["Albedo", "B", "G", "Link", "Orange", "Pose", "R", "Status", "log S", "nx"],
};
/** The sign before the decimals of a number. */
const DECIMAL_SIGN = { de: "," };

/** All texts of a tree by their paths. */
const flat = (tree, path = "") =>
  Object.entries(tree).flatMap(([name, part]) => {
    const place = path === "" ? name : `${path}.${name}`;
    return typeof part === "object" && part !== null ? flat(part, place) : [[place, part]];
  });

const sorted = (found) => [...(found ?? [])].sort();
/** Names in braces, with the number of digits that they take. */
const braces = (text) => sorted(text.match(/\{[^}]+\}/g));
/** Numbers outside braces. */
const numbers = (text, sign) =>
  sorted(text.replaceAll(/\{[^}]+\}/g, "").match(/\d+(?:[.,]\d+)?/g)).map((number) => number.replace(sign, "."));

const camel = (name) => name.replaceAll(/_(\w)/g, (_, letter) => letter.toUpperCase());
/** The details of each reason, as src/reason.rs declares them. */
function detailsOfReasons() {
  const [, body] = /pub enum Reason \{\n([^]*?)\n\}/.exec(readFileSync(inRoot("src/reason.rs"), "utf8"));
  return Object.fromEntries(
    [...body.matchAll(/^ {4}(\w+)(?: \{([^]*?)^ {4}\})?,$/gm)].map(([, name, fields = ""]) => [
      name.replaceAll(/(?<!^)([A-Z])/g, "-$1").toLowerCase(),
      [...fields.matchAll(/^ {8}(\w+):/gm)].map(([, field]) => camel(field)),
    ]),
  );
}

/** The faults of a catalogue, as text. */
function faults(catalogue, source, { same, sign }) {
  const [given, wanted] = [new Map(flat(catalogue)), new Map(flat(source))];
  const found = [];
  for (const [path, text] of wanted) if (!given.has(path)) found.push(`${path} is missing: ${text ?? ""}`);
  for (const [path, text] of given) {
    const original = wanted.get(path);
    if (!wanted.has(path)) found.push(`${path} is not in the English source`);
    else if (typeof text !== "string" || text.trim() === "") found.push(`${path} is empty`);
    // The English source has only the codes of a run's reasons; their details are checked below. "by" names a control, not words.
    else if (original === undefined || path.endsWith(".by")) continue;
    else if (text === original && !same.includes(text)) found.push(`${path} is English: ${text}`);
    else if (!isDeepEqual(braces(text), braces(original))) found.push(`${path} has other {names}: ${text}`);
    else if (!path.endsWith("decimal-sign") && !isDeepEqual(numbers(text, sign), numbers(original, ".")))
      found.push(`${path} has other numbers: ${numbers(text, sign)} for ${numbers(original, ".")}`);
  }
  return found;
}
const isDeepEqual = (a, b) => JSON.stringify(a) === JSON.stringify(b);

const source = english();

test("one id stands for the same English words everywhere", () => {
  for (const [id, words] of phrases()) assert.equal(words, source.interface[id], id);
});

for (const name of names) {
  const code = name.replace(".json", "");
  const rules = { same: SAME[code] ?? [], sign: DECIMAL_SIGN[code] ?? "." };
  const read = () => JSON.parse(readFileSync(inRoot(FOLDER, name), "utf8"));

  describe(name, () => {
    test("has every text of Learn and no other, with its symbols and numbers", () => {
      assert.deepEqual(faults(read(), source, rules), []);
    });

    test("has reasons that use only their own details", () => {
      const details = detailsOfReasons();
      for (const [reason, words] of Object.entries(read().runs))
        for (const [, detail] of words.matchAll(/\{(\w+)(?::\d)?\}/g))
          assert.ok(details[reason].includes(detail), `${reason} has no ${detail}`);
    });

    test("follows the control on which an English label depends", () => {
      for (const [path, key] of flat(source).filter(([each]) => each.endsWith(".by")))
        assert.equal(new Map(flat(read())).get(path), key, path);
    });

    test("is a language that the page offers", () => {
      const offered = readFileSync(inRoot("www/learn/language.ts"), "utf8");
      assert.ok(offered.includes(`import("./languages/${name}")`), name);
    });

    test("fails if a text is missing, superfluous, empty, English, or has other symbols or numbers", () => {
      const broken = (change) => {
        const catalogue = read();
        change(catalogue);
        return faults(catalogue, source, rules).length;
      };
      assert.equal(
        broken((all) => delete all.lessons.pixel.title),
        1,
      );
      assert.equal(
        broken((all) => delete all.lessons.pixel.controls.light.choices.window),
        1,
      );
      assert.equal(
        broken((all) => delete all.figures.pixel.ball.alt),
        1,
      );
      assert.equal(
        broken((all) => (all.lessons.pixel.subtitle = "?")),
        1,
      );
      assert.equal(
        broken((all) => (all.lessons.grey.tasks[1] = " ")),
        1,
      );
      assert.equal(
        broken((all) => (all.interface.slides = source.interface.slides)),
        1,
      );
      assert.equal(
        broken((all) => (all.lessons.grey.text[0] = all.lessons.grey.text[0].replace("{M}", "{N}"))),
        1,
      );
      assert.equal(
        broken((all) => (all.figures.grey.dent.alt = all.figures.grey.dent.alt.replace("turn", "angle"))),
        1,
      );
      assert.equal(
        broken((all) => (all.exercises[3].answer[0] = all.exercises[3].answer[0].replace("2", "3"))),
        1,
      );
    });
  });
}
