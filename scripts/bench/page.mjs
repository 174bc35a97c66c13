// Waiting times of a visitor outside the loop: start, transfer of a frame to the page, drawing.
import { openPage } from "./sides.mjs";

/** The page's largest square; it draws at most 512 pixels a side. */
const DRAWN_SIZE = 256;
/** The loop with the fastest iterations; its frames are as large as those of any other. */
const DRAWN = `surface=bust&light=colourful&size=${DRAWN_SIZE}&lighting=known&start=identity&registration=icp&shading=pixel`;

/** Times from `init()` to the first report, each in a new page that has compiled nothing yet; the file is served from this machine. */
export async function startUps(chromium, address, scene, times) {
  const found = [];
  for (let round = 0; round < times; round++) {
    const { page, close } = await openPage(chromium, `${address}/scripts/bench/page/`);
    const { milliseconds } = await page.evaluate(async (path) => {
      window.bench.start();
      await window.bench.ask({ kind: "scene", path });
      return window.bench.ask({ kind: "firstReport" });
    }, `/${scene.path}`);
    found.push(milliseconds);
    await close();
  }
  return found;
}

/** Times to copy all arrays of a full-sized frame out of the module's memory, to post them to the page, and to paint four views in the module. */
export async function transfers(side, times) {
  const found = { copying: [], painting: [], travelling: [] };
  for (let round = 0; round < times; round++) {
    const { copying, painting, travelling } = await side.ask({ kind: "frame" });
    found.copying.push(copying);
    found.painting.push(painting);
    found.travelling.push(travelling);
  }
  return found;
}

/** Runs before the page's own scripts: records when a frame was requested, when it arrived, and how long its drawing kept the page busy. */
function recordFrames() {
  const frames = (window.benchFrames = []);
  let asked;
  let shown;
  const animate = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) =>
    animate((time) => {
      const before = performance.now();
      draw(time);
      if (shown) shown.drawing += performance.now() - before;
    });
  window.Worker = class extends Worker {
    postMessage(message, ...rest) {
      // Clouds have a separate thread, which receives no requests for frames.
      if (!("kind" in message)) return super.postMessage(message, ...rest);
      asked = message.kind === "advance" ? performance.now() : undefined;
      shown = undefined;
      super.postMessage(message, ...rest);
    }

    set onmessage(handler) {
      super.onmessage = (event) => {
        const reports = event.data.reply?.reports;
        if (reports && asked !== undefined) {
          const computing = reports
            .flatMap(({ milliseconds }) => Object.values(milliseconds))
            .reduce((sum, value) => sum + value, 0);
          shown = { delivery: performance.now() - asked - computing, drawing: 0 };
          frames.push(shown);
          asked = undefined;
        }
        handler(event);
      };
    }
  };
}

/** Size of a camera's frame, which the page plays from the search to the end of the loop. */
const PLAYED_SIZE = "640x480";
/** Limit of the time that is recorded, seconds. */
const PLAYED = 10;

/** Runs before the page's own scripts: records animation frames, and tasks that block the main thread for more than 50 ms. */
function watch() {
  const seen = (window.benchSeen = { frames: [], longTasks: [] });
  new PerformanceObserver((list) => seen.longTasks.push(...list.getEntries().map(({ duration }) => duration))).observe({
    type: "longtask",
  });
  const frame = (time) => {
    seen.frames.push(time);
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

/** Measures how smoothly the page plays a run. */
export async function playing(chromium, address) {
  const context = await chromium.newContext({ viewport: { width: 1280, height: 800 }, serviceWorkers: "block" });
  const page = await context.newPage();
  await page.addInitScript(watch);
  await page.goto(`${address}/site/#size=${PLAYED_SIZE}`);
  await page.waitForSelector('#status[data-state="ready"]', { timeout: 60_000 });
  // After this time, scripts that load late have loaded.
  await page.waitForTimeout(2000);
  await page.evaluate(() => Object.values(window.benchSeen).forEach((list) => (list.length = 0)));
  await page.keyboard.press("Space");
  await page.waitForSelector('#status[data-state="playing"]');
  await page.waitForSelector('#status:not([data-state="playing"])', { timeout: 1000 * PLAYED }).catch(() => {});
  const { frames, longTasks } = await page.evaluate(() => window.benchSeen);
  await context.close();
  const seconds = (frames.at(-1) - frames[0]) / 1000;
  return { size: PLAYED_SIZE, seconds, framesPerSecond: (frames.length - 1) / seconds, longTasks };
}

/**
 * Times of frames of the real page, stage by stage. `delivery`: from the request to the reply, without the stage's own time; this is
 * cropping, copying and sending. `drawing`: the time for which animation frames kept the main thread busy with canvases, clouds and charts.
 */
export async function drawings(chromium, address, times) {
  const context = await chromium.newContext({ viewport: { width: 1280, height: 800 }, serviceWorkers: "block" });
  const page = await context.newPage();
  await page.addInitScript(recordFrames);
  await page.goto(`${address}/site/#${DRAWN}`);
  const status = () => page.evaluate(() => document.querySelector("#status").dataset.state);
  const ready = () => page.waitForSelector('#status[data-state="ready"]');
  await ready();
  let frames = [];
  // The first frame builds objects that later frames reuse.
  while (frames.length < times + 1) {
    await page.keyboard.press("t");
    await page.waitForFunction((count) => window.benchFrames.length > count, frames.length);
    // A painting that is too long for one animation frame continues in the next.
    await page.evaluate(async () => {
      for (let frame = 0; frame < 4; frame++) await new Promise((done) => requestAnimationFrame(done));
    });
    frames = await page.evaluate(() => window.benchFrames);
    if (["ready", "paused"].includes(await status())) continue;
    await page.keyboard.press("r");
    await ready();
  }
  await context.close();
  const later = frames.slice(1);
  return {
    size: `${DRAWN_SIZE}x${DRAWN_SIZE}`,
    delivery: later.map(({ delivery }) => delivery),
    drawing: later.map(({ drawing }) => drawing),
  };
}
