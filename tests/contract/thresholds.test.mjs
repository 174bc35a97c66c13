// The page of calibrated constants agrees with the code.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { inRoot } from "../../scripts/shell.mjs";
import { DOCUMENT, HEAD, filled, formatted, handWritten, lookUp, rowsOf, scalars } from "../../scripts/thresholds.mjs";

const page = readFileSync(inRoot(DOCUMENT), "utf8");
const pageOf = (...rows) => [HEAD, "|---|---|---|---|---|---|", ...rows, "", "Words."].join("\n");

const RUST = `/// Half widths, see [\`Windows\`](super::Windows). A second sentence.
const RADII: [usize; 2] = [2, 3];
/// Twice
/// [\`NOISE\`] of Eq. 2, set on ten photographs (docs/lab/thresholds.md). More.
#[expect(dead_code)]
pub(crate) const MIXED: f64 = 2.0 * NOISE;
pub struct Weights {
    /// Weight of the prior | or not.
    pub prior: f64,
}
impl Default for Weights {
    fn default() -> Self {
        // prior: a comment.
        Self { prior: 0.05, unit: 1.0 }
    }
}
#[cfg(test)]
mod tests {
    const RADII: usize = 1;
}
`;
const look = (name) => lookUp(name, "a.rs", (path) => path === "a.rs" && RUST);

test("values and meanings of the page are those of the code", (t) => {
  const rows = rowsOf(page);
  assert.ok(rows.length > 100, `${rows.length} rows`);
  const expected = filled(page).split("\n");
  const wrong = page.split("\n").flatMap((line, at) => (line === expected[at] ? [] : [`${line}\n${expected[at]}`]));
  assert.deepEqual(wrong, [], "npm run thresholds writes them");
  const keys = rows.map(({ name, path }) => `${path} ${name}`);
  assert.deepEqual([...new Set(keys)], keys);
  for (const { name, data } of rows) for (const cell of data) assert.ok(cell.trim(), `${name} has an empty cell`);
  const all = scalars();
  assert.ok(all.length > 500, `${all.length} scalar constants`);
  const without = all.filter((key) => !keys.includes(key));
  t.diagnostic(`${without.length} of ${all.length} scalar constants of src have no row`);
});

test("the table in the comment of src/diagnosis.rs has the values of its constants", () => {
  const path = "src/diagnosis.rs";
  const rows = readFileSync(inRoot(path), "utf8").matchAll(/^\/\/! \| (\[?`[A-Z][^|]*) \| ([^|]*) \|/gm);
  const compared = [...rows].flatMap(([, names, values]) => {
    const numbers = values.match(/\d+(?:\.\d+)?/g) ?? [];
    return [...names.matchAll(/`(\w+)`/g)].flatMap(([, name], at) =>
      // "twice that" has no number.
      numbers.length > 0 ? [[name, numbers[at], lookUp(name, path).value]] : [],
    );
  });
  assert.ok(compared.length > 10, `${compared.length} values`);
  for (const [name, written, value] of compared) assert.equal(written, value, name);
});

test("a value that differs, and a row of a constant that does not exist, are found", () => {
  const row = (value) => pageOf(`| \`MIXED\` | \`a.rs\` | ${value} | \`NOISE\` | data | none |`);
  assert.notEqual(filled(row("3"), look), row("3"));
  const once = filled(row("3"), look);
  assert.equal(once, pageOf("| `MIXED` | `a.rs` | `2 * NOISE` | Twice `NOISE` of Eq. 2. | data | none |"));
  assert.equal(filled(once, look), once);
  assert.throws(() => filled(pageOf("| `GONE` | `a.rs` | 1 | a | b | c |"), look), /has 0 constants `GONE`/);
  assert.throws(() => lookUp("MIXED", "b.rs", () => false), /"b\.rs" of `MIXED` is not a file/);
  assert.throws(() => filled(pageOf("| MIXED | `a.rs` | 1 | a | b | c |"), look), /six cells/);
  assert.throws(() => filled(pageOf("| `MIXED` | `a.rs` | 1 | a | b |"), look), /six cells/);
});

test("comments and defaults are read without links, attributes, tests and the data", () => {
  assert.deepEqual(look("RADII"), { value: "2, 3", meaning: "Half widths, see `Windows`." });
  assert.deepEqual(look("Weights::prior"), { value: "0.05", meaning: "Weight of the prior \\| or not." });
  assert.deepEqual(
    lookUp("USUAL", "a.ts", () => "/** At most,\n * metres. */\nexport const USUAL = 8;\n"),
    { value: "8", meaning: "At most, metres." },
  );
});

test("expressions are written as people write them", () => {
  for (const [expression, words] of [
    ["20_000", "20000"],
    ["9.21_f32", "9.21"],
    ["2.0", "2"],
    ["-1e-3", "-1e-3"],
    ["[\n    0.5,\n    2.0,\n]", "0.5, 2"],
    ["[[0.7, 0.5], [1.5, 2.0]]", "0.7, 0.5; 1.5, 2"],
    ["1.0 / 0.572 - 1.0", "`1 / 0.572 - 1`"],
    ["Effort { few: 10, most: 40 }", "`few: 10, most: 40`"],
    ["[0.5, LAST]", "`[0.5, LAST]`"],
  ])
    assert.equal(formatted(expression), words);
});

test("the words of the page are those that people wrote", () => {
  const row = "| `MIXED` | `a.rs` | 3 | rims | data | none |";
  assert.equal(handWritten(pageOf(row)), pageOf("| `MIXED` | `a.rs` |  |  | data | none |"));
});
