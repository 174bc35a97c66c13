// The permitted imports between the parts of the TypeScript. Biome checks that imports form no circles (noImportCycles).
import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { imports } from "../../scripts/imports.mjs";
import { inRoot } from "../../scripts/shell.mjs";

const PARTS = ["js", "protocols", "www", "scripts"];
/** The folders or files outside itself that a part may import. */
const MAY_LOOK = {
  js: ["target"],
  protocols: [],
  www: ["pkg", "protocols", "src/codes.json", "js/wasm.ts"],
  scripts: ["pkg", "protocols", "target", "src/codes.json"],
};
/** The places of the page, which are peers, and the files that they may borrow from each other. */
const PLACES = ["www/lab", "www/learn", "www/rig", "www/tables"];
const BORROWED = [
  "www/rig/protocol.ts",
  "www/rig/session.ts",
  "www/rig/masktool.ts",
  "www/rig/paint.ts",
  "www/lab/settings.ts",
];
/** Folders that all places may use. */
const GROUND = ["www/draw", "www/engine"];

const language = (path) => (path.endsWith(".d.ts") ? "dts" : path.endsWith(".ts") ? "ts" : "js");

/** The file of an import: sources name compiled files, and imports for bundlers have no ending. */
function fileOf(from, source) {
  const path = join(dirname(from), source);
  const candidates = [path.replace(/\.js$/, ".ts"), `${path}.ts`, path];
  return candidates.find((each) => existsSync(inRoot(each)) && /\.[a-z]+$/.test(each)) ?? path;
}

/** All imports of other files of the project, by the importing file. */
function looksOf(parts) {
  const files = parts.flatMap((part) =>
    readdirSync(inRoot(part), { recursive: true })
      .map((path) => join(part, path))
      .filter((path) => /\.(ts|mjs)$/.test(path)),
  );
  return new Map(
    files.map((path) => {
      const sources = imports(readFileSync(inRoot(path), "utf8"), language(path));
      return [path, sources.filter((source) => source.startsWith(".")).map((source) => fileOf(path, source))];
    }),
  );
}

const LOOKS = looksOf(PARTS);
const isIn = (path, folder) => path === folder || path.startsWith(`${folder}/`);

/** The imports that a rule forbids, as text. */
const forbidden = (looks, isAllowed) =>
  [...looks].flatMap(([from, targets]) => targets.filter((to) => !isAllowed(from, to)).map((to) => `${from} -> ${to}`));

const looksDown = (from, to) => {
  const part = PARTS.find((each) => isIn(from, each));
  return isIn(to, part) || MAY_LOOK[part].some((each) => isIn(to, each));
};
const staysInPlace = (from, to) => {
  const place = [...PLACES, ...GROUND].find((each) => isIn(from, each));
  const other = PLACES.find((each) => isIn(to, each));
  return (
    place === undefined || other === undefined || other === place || (!GROUND.includes(place) && BORROWED.includes(to))
  );
};

test("each part looks into those below it", () => {
  assert.ok([...LOOKS.values()].flat().length > 500, "the sources are not read");
  assert.deepEqual(forbidden(LOOKS, looksDown), []);
});

test("the places of the page do not look into each other, nor what they stand on into them", () => {
  assert.deepEqual(forbidden(LOOKS, staysInPlace), []);
});

/** All files that a file needs, including itself. */
function needed(entry) {
  const found = new Set([entry]);
  for (const path of found) for (const target of LOOKS.get(path) ?? []) found.add(target);
  return [...found];
}

test("readers and writers of files do without the numerics", () => {
  for (const entry of ["js/files.ts", "js/rig/index.ts", "js/write/index.ts", "js/rig/write/index.ts"]) {
    const all = needed(entry);
    assert.ok(all.length > 5, entry);
    assert.deepEqual(
      all.filter((path) => isIn(path, "target") || ["js/engine.ts", "js/estimator.ts", "js/border.ts"].includes(path)),
      [],
      entry,
    );
  }
});

test("what is forbidden is found", () => {
  assert.equal(fileOf("www/lab/own.ts", "../engine/engine"), "www/engine/engine.ts");
  assert.equal(fileOf("js/rig/read.ts", "../check.js"), "js/check.ts");
  const upward = new Map([
    ["js/check.ts", ["www/dom.ts"]],
    ["www/draw/view.ts", ["www/lab/settings.ts", "scripts/shell.mjs"]],
    ["www/learn/page.ts", ["www/rig/page.ts", "www/rig/session.ts"]],
  ]);
  assert.deepEqual(forbidden(upward, looksDown), [
    "js/check.ts -> www/dom.ts",
    "www/draw/view.ts -> scripts/shell.mjs",
  ]);
  assert.deepEqual(forbidden(upward, staysInPlace), [
    "www/draw/view.ts -> www/lab/settings.ts",
    "www/learn/page.ts -> www/rig/page.ts",
  ]);
});
