// The types list the codes that the numerics can give, the documentation has a row for each, and no code depends on a message's words.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";
import { inRoot } from "../../scripts/shell.mjs";
import { DOCUMENT, documentOf } from "../../scripts/codes.mjs";

const TABLE = JSON.parse(readFileSync(inRoot("src/codes.json"), "utf8"));
const source = (path) => readFileSync(inRoot(path), "utf8");
/** The files below some folders whose paths match. */
const files = (folders, pattern) =>
  folders.flatMap((folder) =>
    readdirSync(inRoot(folder), { recursive: true })
      .map((path) => `${folder}/${path}`)
      .filter((path) => pattern.test(path)),
  );

/** The members of a union type. */
function union(path, name) {
  const [, body] = new RegExp(`export type ${name} =([^;]+);`).exec(source(path)) ?? [];
  assert.ok(body, `${path} has no ${name}`);
  return [...body.matchAll(/"([a-z-]+)"/g)].map(([, word]) => word);
}

// A test of the crate (tests/library/codes.rs) checks that the table has exactly the codes of the numerics.
for (const [group, path, name] of [
  ["runs", "js/types/codes.ts", "ReasonCode"],
  ["checks", "js/types/codes.ts", "CheckCode"],
  ["warnings", "js/types/codes.ts", "WarningCode"],
  ["readers", "js/rig/warnings.ts", "ReaderCode"],
  ["estimators", "js/types/codes.ts", "EstimatorWarningCode"],
  ["errors", "js/errors.ts", "ErrorCode"],
])
  test(`${name} is the table's ${group}`, () =>
    assert.deepEqual(union(path, name).sort(), Object.keys(TABLE[group]).sort()));

test("no advice is a larger image alone, which a run scales down to the depth map", () => {
  const advice = Object.values(TABLE.runs).flatMap(({ remedy, lab = "" }) => [remedy, lab]);
  const larger = advice.filter((words) => /(larger|finer) image/.test(words));
  assert.ok(larger.length >= 2, String(larger));
  assert.deepEqual(
    larger.filter((words) => !/image and depth map/.test(words)),
    [],
  );
});

test("where larger may mean nearer, the Lab's advice names the choice beside the unit", () =>
  assert.match(TABLE.runs.hollow.lab, /larger numbers .* mean nearer.*Settings, Depth camera, Numbers/));

test("errors of the command line and of Python have a row", () => {
  const given = (pattern, paths) =>
    paths.flatMap((path) => [...source(path).matchAll(pattern)].map(([, code]) => code));
  const used = [
    ...given(
      /\b(?:failure|BimodalError|of)\(\s*"([a-z-]+)"/g,
      files(["python/src", "python/bimodal_stereo"], /\.(?:rs|py)$/),
    ),
    ...given(/\bcode: "([a-z-]+)"/g, files(["cli/src"], /\.rs$/)),
  ];
  assert.ok(used.length > 20, String(used.length));
  assert.deepEqual(
    [...new Set(used)].filter((code) => !(code in TABLE.errors)),
    [],
  );
});

test("warnings of the readers in Rust and of the command check have a row", () => {
  const used = files(["files/src", "js/cli"], /\.(?:rs|ts)$/).flatMap((path) =>
    [
      ...source(path).matchAll(
        /(?:\b(?:Warning::new|warn|add|say)\(|code: |const \w+: &str = )\s*"([a-z]+(?:-[a-z]+)+)"/g,
      ),
    ].map(([, code]) => code),
  );
  assert.ok(new Set(used).size > 12, String(used));
  assert.deepEqual(
    [...new Set(used)].filter((code) => !(code in TABLE.readers)),
    [],
  );
});

/** The strings of a list in a source. */
function list(path, pattern) {
  const [, body] = pattern.exec(source(path)) ?? [];
  assert.ok(body, `${path} has no ${pattern}`);
  return [...body.matchAll(/"([a-z-]+)"/g)].map(([, word]) => word).sort();
}

test("what a reader left out caps no verdict, in JavaScript and in Rust", () => {
  const harmless = Object.keys(TABLE.readers).filter((code) => TABLE.readers[code].harmless);
  assert.ok(harmless.length > 3);
  assert.deepEqual(list("js/rig/warnings.ts", /HARMLESS[^=]*= new Set\(\[([^\]]+)\]/), harmless.sort());
  assert.deepEqual(list("files/src/warning.rs", /HARMLESS: [^=]*=\s*\[([^\]]+)\]/), harmless.sort());
});

test("the documentation's table is made of these rows", () => {
  assert.equal(source(DOCUMENT), documentOf(TABLE), "node scripts/codes.mjs writes it anew");
});

/** Patterns of code that looks for words in a message, a reason or a warning. */
const DECIDING = [
  /\.(?:test|exec)\(\s*[^()]*\b(?:message|reason|warnings?)\b/,
  /\b(?:message|reason|warnings?)\b(?:[?!]|\s*\?\?\s*"")?\)?\??\.(?:match|matchAll|includes|startsWith|endsWith|search)\(/,
  /\b(?:messages|warnings)\b[^;]*=>[^;]*\.(?:test|exec|match|includes|startsWith|endsWith)\(/,
  /(?<!typeof [\w.]*)\b(?:message|warning)\b\s*[!=]==?\s*["'`][^"'`]/,
  /\bswitch \((?:[\w.?]*\.)?(?:message|warning)\)/,
];
/** An exception, because it displays a message without the name of the field beside it. */
const SHOWN = ["www/lab/messages.ts"];

function decisions(text) {
  const code = text.replace(/\/\*[^]*?\*\/|^\s*\/\/.*$/gm, "");
  return code.split("\n").filter((line) => DECIDING.some((pattern) => pattern.test(line)));
}

test("nothing in js and www decides by the words of a message", () => {
  const all = files(["js", "www"], /\.ts$/).sort();
  assert.ok(all.length > 150, String(all.length));
  const found = all.filter((path) => decisions(source(path)).length > 0);
  assert.deepEqual(found, SHOWN);
});

test("the search for such decisions finds them", () => {
  for (const line of [
    "if (/painted/.test(message)) return;",
    'const share = /^\\d+ %/.exec(report.message ?? "")?.[0];',
    'if (report.message?.includes("unit")) return;',
    "const isGuessed = warnings.some((words) => /guess/i.test(words));",
    'if (message === "lost") return;',
    "switch (error.message) {",
  ])
    assert.equal(decisions(line).length, 1, line);
  for (const line of ['if (reason.code === "rivals") return;', "say(report.message);", "// the message.includes(what)"])
    assert.equal(decisions(line).length, 0, line);
});
