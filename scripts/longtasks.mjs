// npm run longtasks [-- --alone]: the longest tasks of the page's main thread in the Lab, in a headless browser, on site/ as it is built from pkg/.
//   Tasks over 50 ms are printed, with the processor's time in them and when they began, and for each part the most processor's time that a
//   task took. Nothing is judged: a busy machine makes tasks longer, so that no test is made of it; the processor's time tells how much of that is the page's.
//   --alone   gives the main thread precedence over all else (Linux, as root). With two processors and no graphics card the browser's painting, the
//             module's worker and this trace keep it waiting for as long as it computes; so it waits only for what it asked for itself.
// Before it is asked for the page, the browser has shown another: no visitor's has just been started, and looks up its fonts as it lays out.
// Told apart: the page's own start (its scripts are evaluated, three.js and uPlot among them, loaded after the first paint), and what
// follows: steps, a run at the default pace, one view alone, the other colours. The page is asked and pressed by the browser's own
// protocol: what Playwright brings into a page to wait for something is a script so large that it would be the longest task of the start.
import { execFileSync } from "node:child_process";
import { chromium } from "@playwright/test";
import { browser } from "./browser.mjs";
import { Failure, say, script } from "./shell.mjs";
import { buildSite } from "./site/build.mjs";
import { serveSite } from "./site/serve.mjs";

/** Whether the main thread has precedence. */
const ALONE = process.argv.includes("--alone");
const SCENES = [
  { name: "128 x 128", state: "size=128" },
  { name: "640 x 480", state: "size=640x480&start=truth&lighting=known" },
];
/** Steps of a run that are watched; those of a large view take long. */
const STEPS = 6;
/** How long a run is watched, ms. */
const PLAYED = 8000;
/** How often the page is asked whether it has come so far, and for how long at most, ms. */
const ASKED = 250;
const LONGEST_WAIT = 240_000;
/** From when on a task is long, ms: a press that waits for it feels late. */
const LONG = 50;
/** The browser's tasks, and the marks between the parts. */
const CATEGORIES = ["toplevel", "blink.user_timing"];

/** What an expression comes to in the page. */
async function evaluate(session, expression) {
  const { result } = await session.send("Runtime.evaluate", { expression, returnByValue: true });
  return result.value;
}

/** Waits until the page has an element. */
async function shows(session, selector) {
  for (
    let waited = 0;
    !(await evaluate(session, `document.querySelector(${JSON.stringify(selector)}) !== null`));
    waited += ASKED
  ) {
    if (waited > LONGEST_WAIT) throw new Error(`The page never showed ${selector}.`);
    await new Promise((go) => setTimeout(go, ASKED));
  }
}

/** Begins to record the page; the end gives its main thread's tasks, ms since the navigation. */
async function record(session) {
  const events = [];
  session.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  await session.send("Tracing.start", {
    transferMode: "ReportEvents",
    traceConfig: { includedCategories: CATEGORIES },
  });
  return async () => {
    const complete = new Promise((done) => session.once("Tracing.tracingComplete", done));
    await session.send("Tracing.end");
    await complete;
    return tasksOf(events);
  };
}

/** Every renderer's main thread first: its number is its process's. */
async function putFirst(program) {
  const session = await program.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  for (const { type, id } of processInfo) {
    if (type !== "renderer") continue;
    try {
      execFileSync("renice", ["-n", "-20", "-p", String(id)], { stdio: "ignore" });
    } catch (error) {
      throw new Failure(`--alone needs Linux and root, to give process ${id} precedence: ${error.message}`);
    }
  }
}

function tasksOf(events) {
  const marks = events.filter(({ name }) => name.startsWith("part: ")).sort((a, b) => a.ts - b.ts);
  const { pid, tid } = marks[0];
  const ours = events.filter((event) => event.pid === pid && event.tid === tid);
  const began = Math.max(
    ...ours.filter(({ name, ts }) => name === "navigationStart" && ts < marks[0].ts).map(({ ts }) => ts),
  );
  const partAt = (ts) => marks.findLast((mark) => mark.ts <= ts)?.name.slice("part: ".length) ?? "start";
  const tasks = ours
    .filter(({ name, ph, ts }) => name.endsWith("RunTask") && ph === "X" && ts >= began)
    .map(({ ts, dur, tdur = 0 }) => ({
      part: partAt(ts),
      at: (ts - began) / 1000,
      wall: dur / 1000,
      own: tdur / 1000,
    }));
  return { tasks, parts: ["start", ...marks.map(({ name }) => name.slice("part: ".length))] };
}

function words(tasks) {
  const long = tasks
    .filter(({ wall }) => wall > LONG)
    .map(
      ({ at, wall, own }) =>
        `${wall.toFixed(0)} ms (${own.toFixed(0)} of the processor's, at ${(at / 1000).toFixed(1)} s)`,
    );
  const most = Math.max(0, ...tasks.map(({ own }) => own));
  const longest = Math.max(0, ...tasks.map(({ wall }) => wall));
  return `${long.length === 0 ? `none over ${LONG} ms, the longest ${longest.toFixed(0)}` : long.join(", ")}; at most ${most.toFixed(0)} ms of the processor's time`;
}

await script(async () => {
  await buildSite();
  const { address, close } = await serveSite({ port: 0, below: "/any/folder/" });
  const program = await chromium.launch({
    executablePath: (await browser()).chromium,
    args: ["--no-sandbox", "--enable-unsafe-swiftshader"],
  });
  const warm = await program.newPage();
  await warm.setContent(
    "<h1>A heading</h1><p>Some text, <b>some more</b><button>Go</button><input><select><option>one</option></select>",
  );
  await warm.screenshot();
  for (const { name, state } of SCENES) {
    const context = await program.newContext({ viewport: { width: 1280, height: 800 }, serviceWorkers: "block" });
    const page = await context.newPage();
    const session = await context.newCDPSession(page);
    const recorded = await record(session);
    if (ALONE) await putFirst(program);
    const begin = (part) => evaluate(session, `performance.mark("part: ${part}")`);
    await session.send("Page.navigate", { url: `${address}#${state}` });
    if (ALONE) await putFirst(program);
    for (const selector of ['#status[data-state="ready"]', "#clouds-note[hidden]", "#objective-chart canvas"])
      await shows(session, selector);
    await page.waitForTimeout(500);
    await begin(`${STEPS} steps`);
    for (let step = 0; step < STEPS; step++) {
      await page.keyboard.press("s");
      await page.waitForTimeout(1500);
    }
    await begin("played");
    await page.keyboard.press(" ");
    await page.waitForTimeout(PLAYED);
    await begin("one view alone and back");
    await page.keyboard.press("1");
    await page.waitForTimeout(500);
    await page.keyboard.press("1");
    await page.waitForTimeout(500);
    await begin("other colours");
    await evaluate(session, 'document.querySelector("#theme").click()');
    await page.waitForTimeout(1000);
    const { tasks, parts } = await recorded();
    for (const part of parts) say(`${name}, ${part}: ${words(tasks.filter((task) => task.part === part))}`);
    await context.close();
  }
  await program.close();
  close();
});
