// npm run longtasks: the longest tasks of the page's main thread in the Lab, in a headless browser, on site/ as it is built from pkg/.
//   Tasks over 50 ms are printed, with when they began. Nothing is judged: a busy machine makes them longer, so that no test is made of it.
// Told apart: the page's own start (its scripts are evaluated, three.js and uPlot among them, loaded after the first paint), and what
// follows: steps, a run at the default pace, one view alone, the other colours.
import { chromium } from "@playwright/test";
import { browser } from "./browser.mjs";
import { script, say } from "./shell.mjs";
import { buildSite } from "./site/build.mjs";
import { serveSite } from "./site/serve.mjs";

const SCENES = [
  { name: "128 x 128", state: "size=128" },
  { name: "640 x 480", state: "size=640x480&start=truth&lighting=known" },
];
/** Steps of a run that are watched; those of a large view take long. */
const STEPS = 6;
/** How long a run is watched, ms. */
const PLAYED = 8000;

function watch() {
  window.tasks = [];
  new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map(({ startTime, duration }) => ({ startTime, duration })))).observe({ type: "longtask", buffered: true });
}

/** What was longer than 50 ms since it was asked for last. */
const taken = (page) => page.evaluate(async () => {
  // Entries arrive after the task that they tell of.
  await new Promise((done) => setTimeout(done, 300));
  return window.tasks.splice(0);
});

const words = (tasks) => (tasks.length === 0 ? "none over 50 ms" : tasks.map(({ startTime, duration }) => `${duration.toFixed(0)} ms (at ${(startTime / 1000).toFixed(1)} s)`).join(", "));

await script(async () => {
  await buildSite();
  const { address, close } = await serveSite({ port: 0, below: "/any/folder/" });
  const program = await chromium.launch({ executablePath: (await browser()).chromium, args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
  for (const { name, state } of SCENES) {
    const context = await program.newContext({ viewport: { width: 1280, height: 800 }, serviceWorkers: "block" });
    const page = await context.newPage();
    await page.addInitScript(watch);
    await page.goto(`${address}#${state}`);
    await page.waitForSelector('#status[data-state="ready"]', { timeout: 240_000 });
    await page.waitForSelector("#clouds-note[hidden]", { state: "attached", timeout: 60_000 }).catch(() => {});
    await page.waitForSelector("#objective-chart canvas", { timeout: 60_000 });
    say(`${name}, start: ${words(await taken(page))}`);
    for (let step = 0; step < STEPS; step++) {
      await page.keyboard.press("s");
      await page.waitForTimeout(1500);
    }
    say(`${name}, ${STEPS} steps: ${words(await taken(page))}`);
    await page.keyboard.press(" ");
    await page.waitForTimeout(PLAYED);
    say(`${name}, played: ${words(await taken(page))}`);
    await page.keyboard.press("1");
    await page.waitForTimeout(500);
    await page.keyboard.press("1");
    await page.waitForTimeout(500);
    say(`${name}, one view alone and back: ${words(await taken(page))}`);
    await page.locator("#theme").click();
    await page.waitForTimeout(1000);
    say(`${name}, other colours: ${words(await taken(page))}`);
    await context.close();
  }
  await program.close();
  close();
});
