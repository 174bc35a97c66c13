// Files of code stay short enough to be read in one go; a growing file is split by meaning.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { inRoot, root } from "../../scripts/shell.mjs";

const MOST_LINES = 450;
const CODE = /\.(?:rs|ts|tsx|mjs|mts|js|py|pyi|css|html|sh)$/;

const linesOf = (text) => text.split("\n").length - (text.endsWith("\n") ? 1 : 0);
const tooLong = (texts) =>
  [...texts].flatMap(([name, text]) => (linesOf(text) > MOST_LINES ? [`${name}: ${linesOf(text)} lines`] : []));

test(`no file of code has more than ${MOST_LINES} lines`, (t) => {
  const listed = ["ls-files", "--cached", "--others", "--exclude-standard", "--deduplicate"];
  const { status, stdout } = spawnSync("git", listed, { cwd: root, encoding: "utf8" });
  if (status !== 0) return t.skip("needs a checkout with git");
  const names = stdout
    .split("\n")
    .filter((name) => CODE.test(name) && !name.startsWith("docs/") && existsSync(inRoot(name)));
  assert.ok(names.length > 700, `${names.length} files`);
  const texts = names.map((name) => [name, readFileSync(inRoot(name), "utf8")]);
  assert.deepEqual(tooLong(texts), []);
});

test("a file that is too long is found, and one of just so many lines is not", () => {
  const lines = (count) => "a\n".repeat(count);
  assert.deepEqual(tooLong([["a.ts", lines(MOST_LINES)]]), []);
  assert.deepEqual(tooLong([["a.ts", `${lines(MOST_LINES)}b`]]), [`a.ts: ${MOST_LINES + 1} lines`]);
});
