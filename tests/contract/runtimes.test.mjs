// The package in Deno and Bun: its README's example, threads, and files from disk. Both are installed below target/ for this test only.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, test } from "node:test";
import { decodeDepth } from "../../pkg/files.js";
import { depthPng } from "../../pkg/write.js";
import { inRoot } from "../../scripts/shell.mjs";
import { examples, freshProject, pairFiles, run, write } from "./fresh.mjs";
import { LONG } from "./long.mjs";

const RUNTIMES = inRoot("target/runtimes");
const VERSIONS = { deno: "2.9.6", bun: "1.4.5" };
const program = (name) => join(RUNTIMES, "node_modules/.bin", name);
/** The commands of README's table, split into words. */
const COMMANDS = [
  ...readFileSync(inRoot("pkg/README.md"), "utf8").matchAll(/^\| (?:Deno|Bun) \| `(.+?) app\.mjs`/gm),
].map(([, command]) => command.split(" "));

/** Whether a runtime is available; installs it if necessary. */
function isThere(name) {
  if (!existsSync(program(name))) {
    const line = ["install", "--prefix", RUNTIMES, "--no-save", "--no-audit", "--no-fund"];
    // One command installs both, because npm removes packages that are not listed.
    const all = Object.entries(VERSIONS).map(([each, version]) => `${each}@${version}`);
    spawnSync("npm", [...line, ...all], { encoding: "utf8" });
  }
  return spawnSync(program(name), ["--version"]).status === 0;
}

const [MADE, OWN] = examples(inRoot("pkg/README.md"), "js");
/** README's example, followed by threads and a file from disk. */
const APP = `${MADE}
import { imageFrom } from "bimodal-stereo/files";
const together = new Estimator(image, depth, { workers: 2 });
let last;
for await (last of together);
console.log(last.pose.angles.beta === report.pose.angles.beta, together.warnings.length);
together.free();
console.log((await imageFrom("image.png")).width);
`;

describe("the package runs in", () => {
  test("both have a line in README's table", () =>
    assert.deepEqual(
      COMMANDS.map(([name]) => name),
      ["deno", "bun"],
    ));
  for (const [name, ...args] of COMMANDS) {
    const path = program(name);
    test(name, LONG, async (context) => {
      if (!isThere(name)) return context.skip(`needs ${name}, which npm could not install into target/runtimes`);
      const project = freshProject();
      const { colour, depth } = await pairFiles({ angles: { beta: 20 }, size: 48 });
      const { bytes } = await depthPng(decodeDepth(depth), "px");
      write(project, { "app.mjs": APP, "own.mjs": OWN, "image.png": colour, "depth.png": bytes });
      const lines = run(path, [...args, "app.mjs"], project)
        .trim()
        .split("\n");
      assert.match(lines[0], /^converged (49|50)\./);
      assert.deepEqual(lines.slice(1), ["true 0", "48"]);
      const writing = name === "deno" ? [...args, "--allow-write"] : args;
      assert.match(run(path, [...writing, "own.mjs"], project), /^converged/);
    });
  }
});
