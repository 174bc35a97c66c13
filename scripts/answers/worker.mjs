// A separate process that runs scenes one after the other, with one instance of each package.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { answerOf } from "./answer.mjs";
import { compareChecks } from "./checks.mjs";
import { WHOLE, compare } from "./compare.mjs";
import { figureOf, figureOfCheck } from "./figures.mjs";
import { SCENES } from "./scenes.mjs";

const packages = new Map();

/** Loads the package that a checkout has built, with either of its .wasm files. */
async function load(folder, scalar) {
  if (!packages.has(folder)) {
    const inPackage = (path) => pathToFileURL(join(folder, "pkg", path));
    const { exports } = JSON.parse(readFileSync(inPackage("package.json"), "utf8"));
    // Older packages have a separate module for Node.
    const api = await import(inPackage(exports["."].node ?? exports["."].default));
    await (scalar ? api.default(inPackage("bimodal_stereo_scalar_bg.wasm")) : api.default());
    packages.set(folder, api);
  }
  return packages.get(folder);
}

async function run({ id, folder, against, scalar }) {
  const scene = SCENES.find(({ name }) => name === id);
  const answer = await answerOf(scene, await load(folder, scalar));
  const { uses, endedBy, report } = answer;
  if (against === undefined) return { uses, endedBy, figure: (scene.rig ? figureOfCheck : figureOf)(answer) };
  const before = await answerOf(scene, await load(against, scalar));
  const comparison = scene.rig ? compareChecks(before, answer) : compare(before, answer, WHOLE);
  return { uses, endedBy, status: report.status ?? report.verdict, comparison };
}

process.on("message", async ({ cell }) => {
  const start = performance.now();
  let result;
  try {
    result = await run(cell);
  } catch ({ name, code, message }) {
    result = { failure: { name, code, message } };
  }
  process.send({ id: cell.id, result, took: performance.now() - start });
});
process.on("disconnect", () => process.exit());
process.send({ ready: true });
