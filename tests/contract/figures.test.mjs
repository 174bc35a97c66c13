// The figures of the documents are small, have a white background and a description, and each is shown by a document.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { FIGURES, FOLDER } from "../../scripts/figures.mjs";
import { inRoot } from "../../scripts/shell.mjs";

const MOST_BYTES = 150_000;

const documents = readdirSync(inRoot("docs"), { recursive: true })
  .filter((name) => name.endsWith(".md"))
  .map((name) => readFileSync(inRoot("docs", name), "utf8"));

test("the figures are those that the command makes", () => {
  assert.deepEqual(readdirSync(inRoot(FOLDER)).toSorted(), FIGURES.map((name) => `${name}.svg`).toSorted());
});

for (const name of FIGURES)
  test(`${name}.svg is small, has a white ground and words, and needs no other file`, () => {
    const text = readFileSync(inRoot(join(FOLDER, `${name}.svg`)), "utf8");
    assert.ok(text.length < MOST_BYTES, `${text.length} bytes`);
    assert.match(text, /<title>[^<]{40,}<\/title>\n<rect width="700" height="\d+" fill="#ffffff"\/>/);
    for (const [, address] of text.matchAll(/href="([^"]{0,20})/g)) assert.match(address, /^(?:data:image\/jpeg|#)/);
    assert.doesNotMatch(text.replaceAll(/href="data:[^"]*"/g, ""), /NaN|undefined|Infinity/);
  });

for (const name of FIGURES)
  test(`a document shows ${name}.svg, with a text for those who do not see it`, () => {
    const shown = new RegExp(`!\\[([^\\]]+)\\]\\([^)]*figures/${name}\\.svg\\)`);
    const [words] = documents.flatMap((text) => shown.exec(text)?.[1] ?? []);
    assert.ok(words?.length > 40, words);
  });
