// npm run longtasks [-- --alone]: the longest tasks of the page's main thread in the Lab, in a headless browser, on site/ as built from pkg/.
//   Prints tasks over 50 ms with their processor time and start, and the largest processor time of a task in each part. Nothing is judged,
//   because a busy machine makes tasks longer; that is why this is not a test. The processor time shows how much the page itself causes.
//   --alone   gives the main thread precedence over all else (Linux, as root). With two processors and no graphics card, the browser's
//             painting, the module's worker and the trace would delay it; with precedence it waits only for its own requests.
// The browser first shows another page: a browser that has just started looks up its fonts during the first layout, which visitors rarely meet.
// The page's start (evaluating its scripts, three.js and uPlot among them, which load after the first paint) is reported separately from
// what follows: steps, a run at the default pace, one view alone, the other colours. The browser's own protocol queries and clicks the
// page, because the script that Playwright injects for waiting is so large that it would be the longest task of the start.
import { execFileSync } from "node:child_process";
import { chromium } from "@playwright/test";
import { browser } from "./browser.mjs";
import { Failure, say, script } from "./shell.mjs";
import { buildSite } from "./site/build.mjs";
import { serveSite } from "./site/serve.mjs";

/** Whether the main thread gets precedence. */
const ALONE = process.argv.includes("--alone");
const SCENES = [
  { name: "128 x 128", state: "size=128" },
  { name: "640 x 480", state: "size=640x480&start=truth&lighting=known" },
];
/** Number of recorded steps of a run; those of a large view take long. */
const STEPS = 6;
/** Recorded time of a run, ms. */
const PLAYED = 8000;
/** Interval and limit of polling the page for a state, ms. */
const ASKED = 250;
const LONGEST_WAIT = 240_000;
/** A task of this length or more is long, ms: a click that waits for it feels late. */
const LONG = 50;
/** The browser's tasks, and the marks between the parts. */
const CATEGORIES = ["toplevel", "blink.user_timing"];

/** Evaluates an expression in the page. */
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

/** Records the page; the returned function ends it and gives the tasks of its main thread, ms since the navigation. */
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

/** Gives precedence to every renderer's main thread, whose id is that of its process. */
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
