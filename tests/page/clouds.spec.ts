/** Both surfaces, drawn by a separate thread if the browser permits. */

import { decode, type DecodedPng } from "fast-png";
import { DRAWN, NO_OFFSCREEN, covered, goToClouds, still } from "./clouds";
import { LONG, expect, test } from "./lab";

/** Number of drawn pixels in a row: those whose colour differs from the background, which is visible near a corner. */
function drawnIn({ data, channels, width }: DecodedPng, row: number): number {
  const at = (column: number, row: number) => [0, 1, 2].map((c) => data[(row * width + column) * channels + c] ?? 0);
  const ground = at(width - 8, 8);
  // The outermost pixels are left out, because corners are rounded.
  return Array.from({ length: width - 16 }, (_, i) => at(i + 8, row)).filter((colour) =>
    colour.some((value, c) => Math.abs(value - (ground[c] ?? 0)) > 24),
  ).length;
}

/** The same picture with its columns as rows. */
function turned({ data, channels, width, height, ...rest }: DecodedPng): DecodedPng {
  const across = data.slice();
  for (let at = 0; at < width * height; at++)
    for (let c = 0; c < channels; c++)
      across[((at % width) * height + Math.floor(at / width)) * channels + c] = data[at * channels + c] ?? 0;
  return { ...rest, data: across, channels, width: height, height: width };
}

/** Limit of one attempt out of several, milliseconds. */
const BRIEFLY = { timeout: 5_000 };

const NO_WEBGL = `
  for (const { prototype } of [globalThis.HTMLCanvasElement, OffscreenCanvas].filter(Boolean)) {
    const original = prototype.getContext;
    prototype.getContext = function (kind, ...rest) { return kind.startsWith("webgl") ? null : original.call(this, kind, ...rest); };
  }`;

for (const [where, script] of [
  ["in a thread", ""],
  ["on the page where threads have no canvas", NO_OFFSCREEN],
] as const) {
  test(`the clouds are drawn ${where}, and turn with the arrow keys`, async ({ lab, page }) => {
    await page.addInitScript(script);
    const threads = () => page.workers().filter((worker) => worker.url().includes("stage-thread")).length;
    await lab.open();
    await goToClouds(page);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    const clouds = page.locator("#clouds-canvas");
    await expect(page.locator("#clouds-note")).toBeHidden();
    await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
    expect(threads()).toBe(script === "" ? 1 : 0);
    const lookFromTheFront = async () => {
      await page.getByRole("button", { name: "Home", exact: true }).click();
      // The focus ring changes the picture as well.
      await clouds.focus();
    };
    // A picture follows its cause with a delay. A picture that was taken too early would never match, so another one is taken.
    await expect(async () => {
      await lookFromTheFront();
      const front = await clouds.screenshot();
      const isFront = async () => (await clouds.screenshot()).equals(front);
      await page.keyboard.press("ArrowLeft");
      await expect.poll(isFront, BRIEFLY).toBe(false);
      await lookFromTheFront();
      await expect.poll(isFront, BRIEFLY).toBe(true);
    }).toPass();
    expect(await covered(clouds)).toBeGreaterThan(DRAWN);
  });
}

test("another example is seen from the front, however the last one was turned", LONG, async ({ lab, page }) => {
  // Stops animations and autoplay.
  await page.emulateMedia({ reducedMotion: "reduce" });
  await lab.visit();
  await goToClouds(page);
  const clouds = page.locator("#clouds-canvas");
  await expect(page.locator("#clouds-note")).toBeHidden();
  const choose = async (name: string) => {
    await page.getByRole("button", { name, exact: true }).click();
    await lab.reaches("ready");
    await clouds.focus();
  };
  await expect(async () => {
    await choose("Window light");
    await choose("Easy bust");
    await expect.poll(() => covered(clouds), BRIEFLY).toBeGreaterThan(DRAWN);
    const front = await clouds.screenshot();
    const isFront = async () => (await clouds.screenshot()).equals(front);
    await page.keyboard.press("ArrowLeft");
    await expect.poll(isFront, BRIEFLY).toBe(false);
    await choose("Window light");
    await choose("Easy bust");
    await expect.poll(isFront, BRIEFLY).toBe(true);
  }).toPass();
});

test("surfaces whose distance the pose settles stay in the middle of the view", LONG, async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await lab.visit();
  await goToClouds(page);
  await page.getByRole("button", { name: "The paper's loop", exact: true }).click();
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");
  const clouds = page.locator("#clouds-canvas");
  await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
  // The drawn share of the picture distinguishes a cut-off bust from a complete one.
  await still(clouds);
  const kept = await covered(clouds);
  await page.getByRole("button", { name: "Home", exact: true }).click();
  await still(clouds);
  expect(Math.abs(kept / (await covered(clouds)) - 1)).toBeLessThan(0.1);
});

test("no surface is cut off, whatever scale is found", LONG, async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await lab.visit("size=64");
  const play = async (example: string, status: string) => {
    await page.getByRole("button", { name: example, exact: true }).click();
    await lab.reaches("ready");
    await page.getByLabel("Speed").selectOption({ label: "fastest" });
    await page.getByRole("button", { name: "Play" }).click();
    await lab.reaches(status);
  };
  const isWhole = (picture: DecodedPng) => {
    const [first, middle, last] = [1, Math.round(picture.height / 2), picture.height - 2].map((row) =>
      drawnIn(picture, row),
    );
    expect(middle).toBeGreaterThan(20);
    expect([first, last]).toEqual([0, 0]);
  };
  const drawn = async () => decode(await page.locator("#clouds-canvas").screenshot());
  // A surface that reaches an edge is cut off. At the sides, a lost one may: a hundredth of its points is left out as outliers.
  await play("Too hard", "lost");
  await expect(async () => isWhole(await drawn())).toPass();
  await play("Easy bust", "converged");
  await expect(async () => {
    const picture = await drawn();
    isWhole(picture);
    isWhole(turned(picture));
  }).toPass();
});

test("without WebGL the page says so and computes all the same", async ({ lab, page }) => {
  // three.js logs errors before it gives up; no other errors may occur.
  await page.addInitScript(NO_WEBGL);
  // Init scripts of the page do not run in workers, so the lines are prepended to the worker's script.
  await page.route(/stage-thread[^/]*\.js$/, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `${NO_WEBGL}\n${await response.text()}` });
  });
  await lab.open();
  await goToClouds(page);
  await expect(page.locator("#clouds-note")).toHaveText(/no WebGL/);
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  expect(lab.complaints.filter((line) => !line.includes("THREE.WebGLRenderer"))).toEqual([]);
  lab.complaints.length = 0;
});

test("points are as large on a dense screen", LONG, async ({ browser, baseURL }) => {
  const shares: number[] = [];
  for (const deviceScaleFactor of [1, 2]) {
    const context = await browser.newContext({ deviceScaleFactor, viewport: { width: 1280, height: 800 } });
    const page = await context.newPage();
    await page.goto(`${baseURL}#start=truth`);
    await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
    await goToClouds(page);
    const clouds = page.locator("#clouds-canvas");
    await page.getByLabel("Draw as").selectOption("points");
    await expect(page.locator("#clouds-note")).toBeHidden();
    // Before the first step only the depth map's cloud exists, so no second cloud can appear late.
    await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
    shares.push(await covered(clouds));
    await context.close();
  }
  const [plain = 0, dense = 0] = shares;
  expect(dense / plain).toBeGreaterThan(0.8);
  expect(dense / plain).toBeLessThan(1.25);
});

test("while the search looks around, the surface stands where its best candidate puts it", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await lab.visit("size=64&light=window&beta=50");
  const clouds = page.locator("#clouds-canvas");
  await expect(page.locator("#clouds-note")).toBeHidden();
  await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
  const start = await clouds.screenshot();
  await expect(async () => {
    // No iteration has run, so the search must have moved the surface.
    await page.keyboard.press("s");
    expect((await clouds.screenshot()).equals(start)).toBe(false);
  }).toPass();
  await expect(lab.iteration).toHaveText("0");
});

test("surfaces and points, and the colours on them, are a choice", async ({ lab, page }) => {
  await lab.open("size=64");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const clouds = page.locator("#clouds-canvas");
  await expect(page.locator("#clouds-note")).toBeHidden();
  const seen: Buffer[] = [];
  for (const [name, value] of [
    ["Draw as", "points"],
    ["Draw as", "surfaces"],
    ["Colour by", "picture"],
    ["Colour by", "normals"],
    ["Colour by", "residual"],
  ] as const) {
    await page.getByLabel(name).selectOption(value);
    await expect
      .poll(async () => {
        const now = await clouds.screenshot();
        return seen.some((before) => before.equals(now));
      })
      .toBe(false);
    seen.push(await clouds.screenshot());
  }
});
