// The commands that set up the project start in a fresh clone, where nothing is installed.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { inRoot } from "../../scripts/shell.mjs";

const folder = mkdtempSync(join(tmpdir(), "bare-clone-"));
after(() => rmSync(folder, { recursive: true, force: true }));
for (const name of ["package.json", "protocols", "scripts", "src"])
  cpSync(inRoot(name), join(folder, name), { recursive: true });

/** The message of a command that is refused before it sets up anything, but after it has loaded all its imports. */
const refusal = (args, env = {}) =>
  spawnSync(process.execPath, args, { cwd: folder, env: { ...process.env, ...env }, encoding: "utf8" }).stderr;

test("npm test begins without node_modules", () => {
  assert.match(refusal(["scripts/test.mjs", "nothing"]), /^\nThere is no part "nothing"/);
});

test("npm start begins without node_modules", () => {
  assert.match(refusal(["scripts/start.mjs"], { PORT: "none" }), /^\nPORT must be a number/);
});
