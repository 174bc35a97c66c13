// A page that loads the package from another origin can use threads, and gets a warning where it cannot.
import assert from "node:assert/strict";
import { rmSync } from "node:fs";
import { join } from "node:path";
import { describe, test } from "node:test";
import { serveSite } from "../../scripts/site/serve.mjs";
import { atTheEnd, folder, freshProject, html, served, visit, write } from "./fresh.mjs";
import { LONG } from "./long.mjs";

/** A search by two threads that prints the estimator's warnings. */
const script = (address) => `
import init, { Estimator, sample } from "${address}index.js";
await init();
const { image, depth } = sample({ surface: "bust", light: "window", size: 48, angles: { beta: 30 }, noise: 0.01 });
const estimator = new Estimator(image, depth, { workers: 2 });
const deadline = performance.now() + 60000;
let report = estimator.report;
for await (report of estimator) if (report.stage !== "search") break;
console.log(estimator.warnings.map(({ code, field }) => code + " " + field).join() || "no warning");
console.log("end");
`;

/** The package at a separate address that permits other origins to read it. */
async function packageElsewhere() {
  const path = join(freshProject(), "node_modules/bimodal-stereo");
  const headers = { "Access-Control-Allow-Origin": "*" };
  const { address, close } = await serveSite({ port: 0, below: "/", folder: path, headers });
  atTheEnd(close);
  return { path, address };
}

async function pageFor(address, policy = "") {
  const page = folder();
  const head = policy && `<meta http-equiv="Content-Security-Policy" content="${policy}" />`;
  write(page, {
    "index.html": html(`${head}<script type="module" src="page.js"></script>`),
    "page.js": script(address),
  });
  return served(page);
}

describe("a package from another origin", LONG, () => {
  test("starts its threads by a worker of the page's own origin", async () => {
    const { address } = await packageElsewhere();
    const { lines, missing, threads } = await visit(await pageFor(address), { threads: 1 });
    assert.deepEqual([lines, missing], [["no warning", "end"], []]);
    assert.deepEqual(threads, ["function"]);
  });

  test("is warned of threads that the page forbids", async () => {
    const { address } = await packageElsewhere();
    const { lines } = await visit(await pageFor(address, "worker-src 'none'"));
    assert.ok(lines.includes("workers-unavailable options.workers"), lines.join("\n"));
    assert.ok(lines.some((line) => line.startsWith("bimodal-stereo: workers-unavailable: options.workers: ")));
  });

  test("is warned where thread.js was left behind", async () => {
    const { path, address } = await packageElsewhere();
    rmSync(join(path, "thread.js"));
    const { lines } = await visit(await pageFor(address));
    assert.ok(lines.includes("workers-unavailable options.workers"), lines.join("\n"));
  });
});
