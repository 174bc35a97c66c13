// npm run ablation: every part can be switched off in the present sources, and the summary of the rows is right.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, test } from "node:test";
import { sets, table } from "../../scripts/ablation/cells.mjs";
import { ALL, PARTS, without } from "../../scripts/ablation/parts.mjs";
import { effects, markdown, text } from "../../scripts/ablation/print.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { kit } from "../../protocols/scenes.mjs";

describe("the parts", () => {
  for (const part of PARTS) {
    test(`${part.name}: its lines are there, once each`, () => {
      for (const file of new Set(part.changes.map((change) => change.file))) {
        const before = readFileSync(inRoot(file), "utf8");
        assert.notEqual(without(part, file, before), before);
      }
    });
  }

  test("have a name of their own each, and change something", () => {
    assert.equal(new Set([ALL, ...PARTS].map(({ name }) => name)).size, PARTS.length + 1);
    assert.ok(PARTS.every(({ changes, what }) => changes.length > 0 && what));
  });

  test("a line that is gone, or there twice, fails by the part's name", () => {
    const part = { name: "moved", changes: [{ file: "a.rs", from: "const A: f64 = 1.0;", to: "const A: f64 = 0.0;" }] };
    assert.equal(without(part, "a.rs", "x\nconst A: f64 = 1.0;\ny"), "x\nconst A: f64 = 0.0;\ny");
    assert.equal(without(part, "b.rs", "nothing of it"), "nothing of it");
    assert.throws(() => without(part, "a.rs", "const A: f64 = 2.0;"), /"moved".*a\.rs has 0 times/);
    assert.throws(() => without(part, "a.rs", "const A: f64 = 1.0; const A: f64 = 1.0;"), /"moved".*a\.rs has 2 times/);
  });
});

describe("the cells", () => {
  for (const [complete, quick, count] of [
    [true, false, 51],
    [true, true, 6],
    [false, false, 18],
    [false, true, 2],
  ]) {
    test(`${complete ? "with other people's data" : "without"}${quick ? ", quick" : ""}: ${count}`, () => {
      assert.equal(table(sets(quick, complete)).cells(kit(complete)).length, count);
    });
  }
});

describe("what is told", () => {
  const row = (id, degrees, status = "converged") => ({ id, degrees, status, rivals: 0, milliseconds: 1500 });
  const chosen = [
    {
      set: "photographs",
      lines: [
        { name: "a", ids: ["a/20", "a/40"] },
        { name: "b", ids: ["b/20", "b/40"] },
      ],
    },
    { set: "renders", lines: [{ name: "c", ids: ["c/20"] }] },
  ];
  const all = {
    part: "all",
    gzipped: 300_000,
    rows: [row("a/20", 1), row("a/40", 2, "ambiguous"), row("b/20", 0.2), row("b/40", 5), row("c/20", 30, "lost")],
  };
  const off = {
    part: "paint",
    gzipped: 297_500,
    rows: [row("a/20", 0.5), row("a/40", 40, "lost"), row("b/20", 0.26), row("c/20", 20, "lost")],
  };

  test("better and worse with a part, beyond what matters", () => {
    const { worse, better } = effects(all, off);
    assert.deepEqual(
      worse.map(({ id }) => id),
      ["a/20"],
    );
    assert.deepEqual(
      better.map(({ id }) => id),
      ["a/40"],
    );
  });

  test("as text", () => {
    const lines = text(chosen, [all, off]);
    const told = (pattern) =>
      assert.ok(
        lines.some((line) => pattern.test(line)),
        `${pattern} in\n${lines.join("\n")}`,
      );
    told(/^ {2}a +1\.0 2\.0\? +0\.5 40\?$/);
    told(/^ {2}b +0\.2 5\.0! +0\.3 -$/);
    told(/photographs: under 3 degrees +3 of 4 +-$/);
    told(/photographs: confidently wrong +1 of 4 +-$/);
    told(/renders: worst +30\.0 +20\.0$/);
    told(/gzipped, kB +300\.0 +-2\.5/);
    told(/paint: better 1, worse 1:/);
    told(/a\/20 0\.5 -> 1\.0/);
  });

  test("as Markdown every line has as many cells", () => {
    const lines = markdown(chosen, [all, off]).filter((line) => line.startsWith("|"));
    assert.ok(lines.length > 5);
    assert.deepEqual(new Set(lines.map((line) => line.split("|").length)), new Set([5]));
  });
});
