// The regions of the documents that commands fill.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { benchLines, filled, tablesLines } from "../../scripts/docs.mjs";
import { inRoot } from "../../scripts/shell.mjs";

const aim = {
  table: "table1",
  what: "beta off | degrees",
  rows: 2,
  measured: 4.5e-7,
  sense: "<=",
  limit: 0.001,
  ok: true,
};

test("a region is replaced as a whole, and what surrounds it stays", () => {
  for (const [path, name] of [
    ["docs/accuracy.md", "tables"],
    ["docs/performance.md", "bench"],
    ["docs/performance.md", "beside"],
    ["docs/lab/results.md", "ablation"],
  ]) {
    const text = readFileSync(inRoot(path), "utf8");
    const once = filled(text, name, ["| a |"]);
    assert.ok(once.includes("| a |") && !once.includes("Not filled yet"));
    assert.equal(filled(once, name, ["| a |"]), once);
    const outside = (whole) => whole.replace(/<!-- begin: [^]*<!-- end: /, "");
    assert.equal(outside(once), outside(text));
  }
  assert.throws(() => filled("no region", "tables", []), /no region between/);
});

test("the tables' aims say where they come from, and escape what Markdown would take for a cell", () => {
  const lines = tablesLines({
    aims: [aim, { ...aim, measured: null, ok: null }, { ...aim, measured: 2, ok: false }],
    quick: true,
    data: false,
  });
  assert.match(lines[0], /^Version \d+\.\d+\.\d+.*quick selection.*without the data/);
  assert.deepEqual(
    lines.slice(4).map((line) => line.split(" | ").slice(-1)[0]),
    ["ok |", "not measured |", "missed |"],
  );
  assert.equal(lines[4], "| table1 | beta off \\| degrees | 2 | 4.5e-7 | <= 0.001 | ok |");
});

test("the benches' medians stand by stage and size", () => {
  const row = (where, size, median) => ({ where, size, stage: "step", milliseconds: { median } });
  const aims = [
    { what: "a step", value: 12.34, unit: "ms", limit: 20, met: true },
    { what: "another", value: null, unit: "ms", limit: 5, met: null },
  ];
  const lines = benchLines({
    rows: [
      row("browser", "32x32", 1.234),
      row("browser", "64x64", 234.5),
      row("native", "32x32", 1),
      row("browser, 2 workers", "32x32", 0.7),
    ],
    aims,
    machine: "m, load 9.0",
    surface: "bust",
    lightName: "A",
    quick: true,
  });
  assert.match(lines[0], /quick.*load 9\.0/);
  assert.ok(
    lines.includes("| step | 1.23 / 1.00 | 235 / - |") || lines.includes("| step | 1.23 / 1.00 | 234 / - |"),
    lines.join("\n"),
  );
  assert.ok(lines.includes("| step, 2 workers | 0.70 / - | - / - |"));
  assert.ok(
    lines.includes("| a step | 12.3 ms | 20 ms | ok |") && lines.includes("| another | - | 5 ms | not measured |"),
  );
});

test("the tests that docs/robustness.md names are there", () => {
  const cells = readFileSync(inRoot("docs/robustness.md"), "utf8")
    .split("\n")
    .filter((line) => line.startsWith("|"))
    .map((line) => line.split(" | ").at(-1));
  const named = cells.flatMap((cell) => [...cell.matchAll(/`([^`]+\.(?:rs|mjs|ts|py))`((?:,? "[^"]+")*)/g)]);
  assert.ok(named.length > 50, `${named.length} named`);
  for (const [, path, titles] of named) {
    const text = readFileSync(inRoot(path), "utf8");
    for (const [, title] of titles.matchAll(/"([^"]+)"/g)) assert.ok(text.includes(title), `${path}: ${title}`);
  }
});
