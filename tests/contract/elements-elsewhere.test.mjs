// The custom elements in bundles, from another origin and with a .wasm at a given address, in a real browser.
import assert from "node:assert/strict";
import { cpSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import webpack from "webpack";
import { serveSite } from "../../scripts/site/serve.mjs";
import { atTheEnd, chrome, freshProject, html, run, served, write } from "./fresh.mjs";
import { LONG } from "./long.mjs";

const project = freshProject();
const PACKAGE = join(project, "node_modules/bimodal-stereo");

/** A run of few steps and a figure, both drawn. */
const BODY = `<bimodal-stereo charts sample="bust"></bimodal-stereo><bimodal-figure lesson="lambert"></bimodal-figure>
<script>Object.assign(document.querySelector("bimodal-stereo"), { scene: { size: 48, light: "colourful", angles: { beta: 20 } }, options: { start: "identity" } });</script>`;
const module = (address) => `<script type="module" src="${address}"></script>`;

/** Opens a page and waits for both elements; an error of theirs fails. Returns what has failed in the page itself. */
async function drawn(address) {
  const page = await (await chrome()).newPage();
  const wrong = [];
  page.on("pageerror", ({ message }) => wrong.push(message));
  page.on("response", (response) => response.status() >= 400 && wrong.push(response.url()));
  await page.goto(address);
  const [run, figure] = await page.evaluate(() =>
    Promise.all(
      ["bimodal-stereo", "bimodal-figure"].map(
        (name) =>
          new Promise((done) => {
            const element = document.querySelector(name);
            const told = () =>
              done(element.error?.message ?? element.report?.status ?? Object.keys(element.result.numbers).length);
            if (element.error || element.result) told();
            for (const type of ["done", "error"]) element.addEventListener(type, told);
          }),
      ),
    ),
  );
  assert.equal(run, "converged");
  assert.ok(figure > 0, String(figure));
  // The charts load late, but the run's last drawing waits for them.
  await page.locator("bimodal-stereo .learn-plot .curve").first().waitFor({ state: "attached" });
  await page.close();
  return wrong;
}

test("the elements in a bundle of webpack", LONG, async () => {
  write(project, { "app.js": 'import "bimodal-stereo/elements";' });
  const path = join(project, "webpack");
  const stats = await new Promise((done, fail) => {
    const output = { path, filename: "app.js" };
    const options = { context: project, mode: "production", entry: "./app.js", output, performance: false };
    webpack(options, (error, result) => (error ? fail(error) : done(result)));
  });
  assert.equal(stats.toString({ all: false, errors: true, warnings: true }), "");
  write(project, { "webpack/index.html": html(module("app.js") + BODY) });
  assert.deepEqual(await drawn(await served(path)), []);
});

test("the elements in a bundle of esbuild, whose threads are entries", LONG, async () => {
  write(project, { "app.js": 'import "bimodal-stereo/elements";' });
  const threads = ["bimodal-stereo/elements-thread.js", "bimodal-stereo/figure-thread.js"];
  const entries = ["app.js", ...threads, "node_modules/bimodal-stereo/bimodal_stereo_bg.wasm"];
  const options = ["--bundle", "--format=esm", "--loader:.wasm=copy", "--entry-names=[name]", "--outdir=dist"];
  run("esbuild", [...entries, ...options], project);
  write(project, { "dist/index.html": html(module("app.js") + BODY) });
  assert.deepEqual(await drawn(await served(join(project, "dist"))), []);
});

test("the elements from another origin", LONG, async () => {
  const headers = { "Access-Control-Allow-Origin": "*" };
  const { address, close } = await serveSite({ port: 0, below: "/", folder: PACKAGE, headers });
  atTheEnd(close);
  write(project, { "foreign/index.html": html(module(`${address}elements.js`) + BODY) });
  assert.deepEqual(await drawn(await served(join(project, "foreign"))), []);
});

test("the elements with a .wasm and threads at given addresses", LONG, async () => {
  write(project, {
    "given.js": `import { configure } from "bimodal-stereo/elements";
      configure({ wasm: "files/method.wasm", stereoThread: "files/run.js", figureThread: new URL("files/figure.js", location.href) });`,
  });
  run("esbuild", ["given.js", "--bundle", "--format=esm", "--outfile=given/app.js"], project);
  const thread = (name, out) =>
    run("esbuild", [join(PACKAGE, name), "--bundle", "--format=esm", `--outfile=given/files/${out}`], project);
  thread("elements-thread.js", "run.js");
  thread("figure-thread.js", "figure.js");
  cpSync(join(PACKAGE, "bimodal_stereo_bg.wasm"), join(project, "given/files/method.wasm"));
  write(project, { "given/index.html": html(module("app.js") + BODY) });
  assert.deepEqual(await drawn(await served(join(project, "given"))), []);
});
