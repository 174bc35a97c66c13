// The custom elements of the packed package, in plain HTML and in React, in a real browser.
import assert from "node:assert/strict";
import { join } from "node:path";
import { describe, test } from "node:test";
import { build } from "vite";
import { depthPng } from "../../pkg/write.js";
import { decodeDepth } from "../../pkg/files.js";
import { inRoot } from "../../scripts/shell.mjs";
import { chrome, examples, freshProject, html, pairFiles, run, served, write } from "./fresh.mjs";
import { LONG } from "./long.mjs";
import { init, sample } from "./support.mjs";

const project = freshProject();
const MAP = `<script type="importmap">{ "imports": { "bimodal-stereo/elements": "./node_modules/bimodal-stereo/elements.js" } }</script>`;
/** A pair and options with which a run takes few steps. */
const SCENE = { light: "colourful", size: 48, angles: { beta: 20 } };
const OPTIONS = { start: "identity" };

/** A page of the project, and the errors that it did not catch. */
async function opened(name, head) {
  if (head !== undefined) write(project, { [name]: html(head) });
  const page = await (await chrome()).newPage();
  const errors = [];
  page.on("pageerror", ({ message }) => errors.push(message));
  await page.goto(`${await served(project)}${name}`);
  return { page, errors };
}

/** The browser reports workers a little late. */
async function workersAre(page, count) {
  for (let tries = 0; page.workers().length !== count && tries < 200; tries++) await page.waitForTimeout(50);
  assert.equal(page.workers().length, count);
}

/** Sets what is given on a new element, and waits for one of its events; returns all events until then. */
const until = (page, tag, members, last) =>
  page.evaluate(
    async ([tag, members, last]) => {
      await import("bimodal-stereo/elements");
      document.querySelector(tag)?.remove();
      const element = Object.assign(document.createElement(tag), members);
      const seen = [];
      await new Promise((done) => {
        for (const type of ["step", "status", "done", "error"])
          element.addEventListener(type, ({ detail }) => {
            seen.push({ type, status: detail.status, code: detail.code, field: detail.field, state: detail.state });
            if (type === last) done();
          });
        document.body.append(element);
      });
      return seen;
    },
    [tag, members, last],
  );
const types = (seen) => [...new Set(seen.map(({ type }) => type))].sort();

describe("<bimodal-stereo> in plain HTML", LONG, () => {
  test("runs a sample to a status, and frees its worker then", async () => {
    const { page, errors } = await opened("sample.html", MAP);
    const members = { sample: "bust", scene: SCENE, options: OPTIONS };
    const seen = await until(page, "bimodal-stereo", members, "done");
    assert.deepEqual(types(seen), ["done", "status", "step"]);
    assert.equal(seen.at(-1).status, "converged");
    const { report, words, name } = await page.evaluate(() => {
      const element = document.querySelector("bimodal-stereo");
      const words = element.shadowRoot.querySelector("[role=status]").textContent;
      return { report: element.report, words, name: element.getAttribute("sample") };
    });
    assert.ok(Math.abs(report.pose.angles.beta - 20) < 2, JSON.stringify(report.pose.angles));
    assert.match(words, /^converged \(\d+ iterations\): α /);
    assert.equal(name, "bust");
    await workersAre(page, 0);
    assert.deepEqual(errors, []);
    await page.close();
  });

  test("reads files at the addresses of its attributes", async () => {
    const { colour, depth } = await pairFiles({ ...SCENE, surface: "bust" });
    const { bytes, step } = await depthPng(decodeDepth(depth), "px");
    write(project, { "image.png": colour, "depth.png": bytes });
    const { page, errors } = await opened(
      "files.html",
      `${MAP}<script type="module">import "bimodal-stereo/elements";</script>
       <bimodal-stereo image="image.png" depth="depth.png" unit="${step}"></bimodal-stereo>
       <script>document.querySelector("bimodal-stereo").options = ${JSON.stringify(OPTIONS)};</script>`,
    );
    await page.waitForFunction(() => {
      const { report, error } = document.querySelector("bimodal-stereo");
      return error || (report && report.status !== "running");
    });
    const [error, report] = await page.evaluate(() => {
      const { error, report } = document.querySelector("bimodal-stereo");
      return [error, report];
    });
    assert.equal(error, undefined);
    assert.ok(Math.abs(report.pose.angles.beta - 20) < 2, JSON.stringify(report.pose.angles));
    assert.deepEqual(errors, []);
    await page.close();
  });

  test("takes a pair as arrays, and shows its surfaces and curves", async () => {
    await init();
    const { image, depth } = sample({ ...SCENE, surface: "bust", noise: 0.01 });
    const { page, errors } = await opened("pair.html", MAP);
    const members = { pair: { image, depth }, charts: true, options: OPTIONS };
    const seen = await until(page, "bimodal-stereo", members, "done");
    assert.equal(seen.at(-1).status, "converged");
    await page.locator("bimodal-stereo .learn-plot .curve").nth(1).waitFor();
    await page.locator("bimodal-stereo canvas[aria-label^='Points of the depth map']").waitFor();
    await page.evaluate(() => (document.querySelector("bimodal-stereo").charts = false));
    await page.locator("bimodal-stereo .learn-plot").first().waitFor({ state: "hidden" });
    assert.equal(await page.evaluate(() => document.querySelector("bimodal-stereo").report.status), "converged");
    assert.deepEqual(errors, []);
    await page.close();
  });

  test("says what is wrong by a code and an attribute", async () => {
    const { page, errors } = await opened("wrong.html", MAP);
    const last = async (members) => {
      const { type, code, field } = (await until(page, "bimodal-stereo", members, "error")).at(-1);
      return [type, code, field];
    };
    assert.deepEqual(await last({ image: "image.png" }), ["error", "missing", "depth"]);
    assert.deepEqual(await last({ image: "none.png", depth: "none.png" }), ["error", "file", "image"]);
    assert.deepEqual((await last({ sample: "teapot" })).slice(0, 1), ["error"]);
    assert.deepEqual((await last({ sample: "bust", options: { registration: "none" } })).slice(1), [
      "option",
      "options.registration",
    ]);
    await workersAre(page, 0);
    assert.deepEqual(errors, []);
    await page.close();
  });

  test("waits while it is paused, steps by hand, and has one worker until it is removed", async () => {
    const { page, errors } = await opened("paused.html", MAP);
    const members = { sample: "bust", paused: true, scene: { size: 32 } };
    await page.evaluate(async (given) => {
      await import("bimodal-stereo/elements");
      window.element = Object.assign(document.createElement("bimodal-stereo"), given);
      window.steps = 0;
      window.element.addEventListener("step", () => window.steps++);
      document.body.append(window.element);
    }, members);
    const status = page.getByRole("status");
    await status.getByText("paused").waitFor();
    await workersAre(page, 1);
    assert.equal(await page.evaluate(() => window.steps), 0);
    await page.getByRole("button", { name: "Step" }).press("Enter");
    await page.waitForFunction(() => window.steps === 1);
    // A change starts again, with a worker instead of the other.
    await page.evaluate(() => window.element.setAttribute("sample", "vase"));
    await status.getByText("paused").waitFor();
    await workersAre(page, 1);
    assert.equal(await page.evaluate(() => window.element.report), undefined);
    await page.evaluate(() => window.element.remove());
    await workersAre(page, 0);
    await page.evaluate(() => document.body.append(window.element));
    await status.getByText("paused").waitFor();
    await workersAre(page, 1);
    await page.evaluate(() => window.element.play());
    await page.waitForFunction(() => window.steps > 2);
    await page.evaluate(() => window.element.remove());
    await workersAre(page, 0);
    assert.deepEqual(errors, []);
    await page.close();
  });
});

test("the guide's page works as it is written", LONG, async () => {
  const [guide] = examples(inRoot("docs/guide/elsewhere.md"), "html");
  // These options omit the search, which takes long. The rest of the guide's page is unchanged.
  write(project, {
    "guide.html": `${guide}<script>Object.assign(document.querySelector("bimodal-stereo"), ${JSON.stringify({ scene: SCENE, options: OPTIONS })});</script>`,
  });
  const { page, errors } = await opened("guide.html");
  await page.getByText(/^converged: beta 20\.\d$/).waitFor();
  await page.locator("bimodal-figure").getByRole("region").waitFor();
  assert.deepEqual(errors, []);
  await page.close();
});

describe("<bimodal-figure> in plain HTML", LONG, () => {
  test("draws a lesson's figure, follows its state, and frees its worker", async () => {
    const { page, errors } = await opened("figure.html", MAP);
    const seen = await until(page, "bimodal-figure", { lesson: "pixel" }, "done");
    assert.ok(seen.length > 1);
    await workersAre(page, 1);
    const slider = page.locator("bimodal-figure input[type=range]").first();
    const key = await slider.getAttribute("name");
    const before = await page.evaluate(() => document.querySelector("bimodal-figure").result);
    const told = page.evaluate(
      () =>
        new Promise((done) =>
          document.querySelector("bimodal-figure").addEventListener("status", ({ detail }) => done(detail.state)),
        ),
    );
    await slider.press("ArrowRight");
    const state = await told;
    assert.match(state, new RegExp(`^${key}=`));
    assert.equal(await page.locator("bimodal-figure").getAttribute("state"), state);
    await page.waitForFunction(
      (old) => JSON.stringify(document.querySelector("bimodal-figure").result) !== old,
      JSON.stringify(before),
    );
    // A lesson and a state for it, in both orders.
    for (const order of [
      ["lesson", "state"],
      ["state", "lesson"],
    ]) {
      await page.evaluate(() =>
        Object.assign(document.querySelector("bimodal-figure"), { lesson: "pixel", state: "" }),
      );
      await page.waitForFunction(() => {
        const { shadowRoot, result } = document.querySelector("bimodal-figure");
        return result && !shadowRoot.querySelector("[name=holes]");
      });
      await page.evaluate((names) => {
        const given = { lesson: "sensor", state: "holes=20" };
        const element = document.querySelector("bimodal-figure");
        for (const name of names) element[name] = given[name];
      }, order);
      await page.locator("bimodal-figure").getByRole("region").waitFor();
      await workersAre(page, 1);
      // The first lesson has no holes and would have dropped this part of the state.
      await page.waitForFunction(
        () => document.querySelector("bimodal-figure").shadowRoot.querySelector("[name=holes]")?.value === "20",
      );
      assert.equal(await page.locator("bimodal-figure").getAttribute("state"), "holes=20");
      await page.evaluate(() => document.querySelector("bimodal-figure").setAttribute("state", "holes=7"));
      await page.waitForFunction(
        () => document.querySelector("bimodal-figure").shadowRoot.querySelector("[name=holes]")?.value === "7",
      );
    }
    await page.evaluate(() => document.querySelector("bimodal-figure").remove());
    await workersAre(page, 0);
    assert.deepEqual(errors, []);
    await page.close();
  });

  test("knows which lessons there are", async () => {
    const { page, errors } = await opened("lessons.html", MAP);
    const { code, field } = (await until(page, "bimodal-figure", { lesson: "alchemy" }, "error")).at(-1);
    assert.deepEqual([code, field], ["option", "lesson"]);
    assert.deepEqual(errors, []);
    await page.close();
  });
});

const APP = `import { StrictMode, useState } from "react";
import { createRoot } from "react-dom/client";
import "bimodal-stereo/elements";
import type { ElementsInJsx, StereoEvents } from "bimodal-stereo/elements";

declare module "react" {
  namespace JSX {
    interface IntrinsicElements extends ElementsInJsx<React.HTMLAttributes<HTMLElement>> {}
  }
}

const SCENE = ${JSON.stringify(SCENE)} as const;
const OPTIONS = ${JSON.stringify(OPTIONS)} as const;

function App() {
  const [status, setStatus] = useState("none");
  const [done, setDone] = useState("none");
  const [drawn, setDrawn] = useState(false);
  const [isShown, setShown] = useState(true);
  const onDone = ({ detail }: StereoEvents["done"]) => setDone(detail.status);
  return (
    <main>
      <p id="told">{status} {done} {String(drawn)}</p>
      <button type="button" onClick={() => setShown(false)}>Remove</button>
      {isShown && <bimodal-stereo sample="bust" scene={SCENE} options={OPTIONS} onstatus={({ detail }) => setStatus(detail.status)} ondone={onDone} />}
      {isShown && <bimodal-figure lesson="pixel" ondone={() => setDrawn(true)} />}
    </main>
  );
}

createRoot(document.getElementById("root")!).render(<StrictMode><App /></StrictMode>);
`;

test("both elements in React 19, in its strict mode and with its types", LONG, async () => {
  const root = join(project, "react");
  write(project, {
    "react/app.tsx": APP,
    "react/index.html": html('<div id="root"></div><script type="module" src="./app.tsx"></script>'),
  });
  const types = inRoot("node_modules/@types");
  write(project, {
    "react/tsconfig.json": JSON.stringify({
      compilerOptions: {
        ...{
          jsx: "react-jsx",
          module: "esnext",
          moduleResolution: "bundler",
          target: "es2022",
          strict: true,
          noEmit: true,
        },
        ...{ lib: ["es2023", "dom", "esnext.disposable"], types: [] },
        paths: {
          react: [`${types}/react`],
          "react/*": [`${types}/react/*`],
          "react-dom/*": [`${types}/react-dom/*`],
        },
      },
      include: ["app.tsx"],
    }),
  });
  run("tsc", ["-p", "react"], project);
  const alias = Object.fromEntries(["react", "react-dom"].map((name) => [name, inRoot("node_modules", name)]));
  await build({
    root,
    base: "./",
    configFile: false,
    logLevel: "silent",
    resolve: { alias },
    worker: { format: "es" },
  });
  const { page, errors } = await opened("react/dist/index.html");
  await page.waitForFunction(() => document.getElementById("told")?.textContent === "converged converged true");
  await page.getByRole("button", { name: "Remove" }).click();
  await workersAre(page, 0);
  assert.deepEqual(errors, []);
  await page.close();
});

test("importing the elements without a document does nothing", () => {
  const code = 'import "bimodal-stereo/elements"; console.log(typeof document);';
  assert.equal(run(process.execPath, ["--input-type=module", "-e", code], project).trim(), "undefined");
});
