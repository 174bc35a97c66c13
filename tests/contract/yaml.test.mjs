// The reader of YAML against js-yaml: what that writes in all its styles, what calibrations look like, and what is none.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { before, describe, test } from "node:test";
import { dump, loadAll } from "js-yaml";
import { rolldown } from "rolldown";

const here = (path) => new URL(path, import.meta.url);
let readDocuments;

before(async () => {
  const bundle = await rolldown({ input: here("../../js/rig/formats/yaml.ts").pathname, platform: "neutral" });
  const { output } = await bundle.generate({ format: "esm" });
  ({ readDocuments } = await import(`data:text/javascript,${encodeURIComponent(output[0].code)}`));
});

const same = (text) => assert.deepEqual(readDocuments(text), loadAll(text), text);

/** Numerical Recipes' quick generator. */
function random(seed) {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

const WORDS = [
  "a",
  "b c",
  "x: y",
  "#no",
  "- z",
  "it's",
  'a "b"',
  "1",
  "1.",
  "true",
  "~",
  "",
  " p ",
  "l\nm",
  "l\n\n m\n",
  "[q",
  "{r",
  "*s",
  "&t",
  "!u",
  "%v",
  "@w",
  "é",
  "a#b",
  "a:b",
  "null",
  "0x1f",
  "-",
  "?",
  "a, b",
  "\ttab",
  "x\n\n",
];

function randomValue(draw, deep) {
  const kind = draw(deep > 3 ? 4 : 7);
  if (kind === 0) return draw(2000) - 1000;
  if (kind === 1) return ((draw(1e6) - 5e5) / 1024) * 10 ** (draw(13) - 6);
  if (kind === 2) return [null, true, false, Infinity, -Infinity, 0][draw(6)];
  if (kind === 3) return WORDS[draw(WORDS.length)];
  const items = Array.from({ length: draw(5) }, () => randomValue(draw, deep + 1));
  return kind === 4
    ? items
    : Object.fromEntries(items.map((item, at) => [draw(3) === 0 ? WORDS[draw(WORDS.length)] : `key_${at}`, item]));
}

describe("YAML", () => {
  test("whatever js-yaml writes comes back", () => {
    for (let seed = 0; seed < 600; seed++) {
      const draw = random(seed);
      const value = randomValue(draw, 0);
      const options = { indent: 2 + draw(3), flowLevel: draw(4) - 1, lineWidth: [20, 80, -1][draw(3)], noRefs: true };
      const text = dump(value, options);
      assert.deepEqual(readDocuments(text), [value], `seed ${seed}:\n${text}`);
      same(text);
    }
  });

  test("the fixtures of others' programs, and the forms of calibrations, as js-yaml reads them", () => {
    const folder = here("../fixtures/rig/");
    const files = readdirSync(folder).filter((name) => name.endsWith(".yaml"));
    assert.ok(files.length >= 4);
    for (const name of files)
      same(
        readFileSync(new URL(name, folder), "utf8")
          .replace(/^%YAML.*$/m, "")
          .replace(/!!opencv-matrix/g, ""),
      );
    for (const text of [
      'header: \n  seq: 0\n  stamp: \n    secs: 0\n  frame_id: "cam"\nD: [1.0, 2.0]\n---\nheader: \n  seq: 1\n',
      "T: [[1,0,0,0],\n    [0,1,0,0],\n    [0,0,1,0]]\n",
      "T:\n- [0.1, -2e-3,\n   3.]\n- - 1\n  - .5\n",
      "- a: 1\n  b: 2\n-  c: 3\n   d:\n   - 4\n-\n  - 5\n",
      "a: foo\n  bar\n\n  baz\nb: 'it''s'\nc: \"x\n  y \\\n  z\\u00e9\\x41\"\n",
      "a: |\n  x\n   y\n\nb: >-\n  p\n  q\n\n  r\nc: |+\n  s\n\n",
      "x: &k [1, 2]\ny: *k\nz: &m\n  q: 1\nw: *m\nv: {a: &n 3, b: *n}\n",
      "a: 1. # c\nb: -1e-3\nc: .5\nd: +3\ne: 0x1F\nf: 1_000\ng: -.inf\nh: ~\ni:\nj: yes\nk: true\n",
      "key with space: v#x\nu: http://a/b\nt: a:b\na : 1\n'q' : 2\n",
      '{a: [1,2], b: , c, "d":1, e: {}, f: [g: 1, h]}\n',
      "#c\n\n# d\na: [\n  1, # e\n  2\n  ]\n#f\nb: 2\n",
      "%YAML 1.2\n---\na: 1\n...\n---\n- 2\n...\n",
      "a:\r\n  - 1\r\n  - 2\r\n",
      "a: !!str b\nc: !!float 1.5\n",
      "plain words\n",
      "",
    ])
      same(text);
  });

  test("what is no YAML is refused, as js-yaml does", () => {
    for (const text of [
      "a: [1, 2\n",
      "a: 1\n b: 2\n",
      "a: 1\na: 2",
      "a: *x",
      "a: b: c",
      "- 1\na: 2",
      "a: 'x",
      "a: [1 2",
      "a: - 1",
      "{a: 1",
      "a: @x",
      'a: "\\q"',
      'a: "\\u12"',
      "a: ]",
      "a:\n  b: 1\n c: 2\n",
      `a: ${"[".repeat(200)}${"]".repeat(200)}`,
      `x: &a 1\ny: [${Array(65).fill("*a").join(", ")}]`,
    ]) {
      assert.throws(() => loadAll(text, { maxDepth: 32, maxAliases: 64 }), undefined, text);
      assert.throws(() => readDocuments(text), undefined, text);
    }
  });

  test("a name that objects have already is one like any other", () => {
    const [value] = readDocuments("__proto__: 1\nconstructor: 2\n");
    assert.deepEqual(Object.entries(value), [
      ["__proto__", 1],
      ["constructor", 2],
    ]);
  });

  test("no text takes long, and changed ones end", () => {
    const long = 2 ** 18;
    for (const piece of [
      " ",
      "\n",
      "1,",
      "[",
      "- ",
      "a: ",
      "a\n",
      "'",
      '"',
      "\\",
      "# ",
      "&a ",
      ": ",
      "\t",
      " \n",
      "|\n",
      "x ",
    ]) {
      for (const head of ["", "[", '"', "a: ", "a: |\n ", "a: >\n ", "- "]) {
        const text = head + piece.repeat((long - 8) / piece.length);
        const { user } = process.cpuUsage();
        try {
          readDocuments(text);
        } catch {
          // Refused is fine.
        }
        const spent = (process.cpuUsage().user - user) / 1000;
        assert.ok(spent < 1000, `${JSON.stringify(head + piece)}: ${spent} ms`);
      }
    }
    const original = readFileSync(here("../fixtures/rig/camchain.yaml"), "utf8");
    for (let seed = 0; seed < 2000; seed++) {
      const draw = random(seed);
      let text = original;
      for (let change = 0; change < 3; change++) {
        const at = draw(text.length);
        text = text.slice(0, at) + "[]{}:,-#&*!|>'\"%@ \n\tx1"[draw(23)] + text.slice(at + draw(3));
      }
      try {
        assert.ok(Array.isArray(readDocuments(text)));
      } catch (error) {
        assert.equal(error.constructor, Error, `${error.stack}\n${text}`);
      }
    }
  });
});
