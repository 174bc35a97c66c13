// Editors show a comment for every public name and member of the package, and the comments of options follow from their rows.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { TYPES, comments, documented, linesOf, rowsOfTypes } from "../../scripts/documented.mjs";
import { inRoot } from "../../scripts/shell.mjs";

const { exports } = JSON.parse(readFileSync(inRoot("pkg/package.json"), "utf8"));
const entries = Object.values(exports).flatMap(({ types }) => (types === undefined ? [] : inRoot("pkg", types)));

test("every public name and member has a comment", () => {
  const found = comments(entries);
  assert.ok(entries.length >= 5 && found.size > 350, `${found.size} names and members`);
  assert.deepEqual(
    [...found].filter(([, isCommented]) => !isCommented).map(([path]) => path),
    [],
  );
});

test("units, ranges and defaults of options are those of their rows", async () => {
  const rows = await rowsOfTypes();
  const texts = TYPES.map((path) => readFileSync(path, "utf8"));
  assert.ok(texts.filter((text) => /@default /.test(text)).length > 1, "the types of options and samples are not read");
  for (const text of texts) assert.equal(text, documented(text, rows), "node scripts/documented.mjs writes them anew");
  const found = comments(entries);
  // Members of an interface with a separate name are documented there.
  const isNamed = (path) => /^Options\.(start|prior)\./.test(path);
  for (const [path, row] of rows) assert.ok(found.get(path) || isNamed(path), `${path} ${row.kind}`);
});

test("a row in words", () => {
  const row = { kind: "number", min: -360, max: 360, unit: "deg", default: 0 };
  assert.deepEqual(linesOf(row), ["Range: a number from -360 to 360, in degrees.", "@default 0"]);
  assert.deepEqual(linesOf({ kind: "number", above: 0, max: 1 }), ["Range: a number above zero up to 1."]);
  assert.deepEqual(linesOf({ kind: "flag", default: true }), ["@default true"]);
  const text = "export interface A {\n  /** An angle. */\n  a?: number;\n}\n";
  const written = documented(text, new Map([["A.a", row]]));
  assert.match(written, /An angle\.\n {3}\* Range: a number from -360 to 360, in degrees\.\n {3}\* @default 0\n/);
  assert.equal(documented(written, new Map([["A.a", row]])), written);
});
