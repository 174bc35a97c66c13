/** The Lab keeps its layout and all of it can be reached, in windows of any size, by keyboard and by touch. */

import { LONG, expect, test } from "./lab";
import { atWidths } from "./widths";

test("the surfaces are most of the first screen from 1280 to 2560 px", async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 800 });
  await lab.open();
  for (const [width, height] of [
    [1280, 800],
    [1600, 900],
    [2560, 1300],
  ] as const) {
    await atWidths(
      page,
      [width],
      async () => {
        const box = await page.locator("#clouds-box").boundingBox();
        const bar = await page.locator("#bar").boundingBox();
        expect(box && box.width / width).toBeGreaterThan(0.45);
        expect(box && bar && box.y + box.height).toBeLessThanOrEqual(bar?.y ?? 0);
        // Parts of the page in reading order: inputs, surfaces, results.
        const lefts = await page
          .locator("#inputs, #hero, #outcome")
          .evaluateAll((parts) => parts.map((part) => part.getBoundingClientRect().left));
        expect([...lefts].sort((a, b) => a - b)).toEqual(lefts);
      },
      height,
    );
  }
});

test("nothing moves under the pointer", async ({ lab, page }) => {
  await lab.open("size=64");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const boxes = () =>
    page
      .locator("#lab figure, #bar, #panel")
      .evaluateAll((parts) => parts.map((part) => JSON.stringify(part.getBoundingClientRect())));
  await page.mouse.move(2, 2);
  const before = await boxes();
  const colour = await page.getByRole("img", { name: /^Colour:/ }).boundingBox();
  if (!colour) throw new Error("the picture is on the page");
  await page.mouse.move(colour.x + colour.width / 2, colour.y + colour.height / 2);
  await expect(page.locator("#inputs-views .readout").first()).toHaveText(/^\d+, \d+: /);
  expect(await boxes()).toEqual(before);
});

test("at 400 % zoom nothing sticks out, and the bar leaves the window to the page", async ({ lab, page }) => {
  // The size of a window of 1280 x 800 at 400 % zoom.
  await page.setViewportSize({ width: 320, height: 200 });
  await lab.open("size=32");
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(320);
  expect(await page.locator("#bar").evaluate((bar) => getComputedStyle(bar).position)).toBe("static");
});

for (const [width, height] of [
  [640, 400],
  [320, 200],
  [1280, 400],
] as const) {
  test(`the skip link shows what Play runs in a window of ${width} x ${height}`, async ({ lab, page }) => {
    await page.setViewportSize({ width, height });
    await lab.open("size=32");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await expect(page.locator("#play")).toBeFocused();
    await expect(page.locator("#play")).toBeInViewport({ ratio: 1 });
    // The visible part at this size; the page may scroll smoothly.
    await expect(page.locator("#clouds-canvas")).toBeInViewport({ ratio: height < 300 ? 0.5 : 1 });
    if (height > 300) await expect(page.locator("#status")).toBeInViewport({ ratio: 1 });
  });
}

test("the bar is one row of one height", async ({ lab, page }) => {
  for (const width of [320, 768, 1280, 2560]) {
    await page.setViewportSize({ width, height: 800 });
    await lab.open("size=32");
    expect(await page.locator("#bar").evaluate((bar) => bar.getBoundingClientRect().height)).toBe(60);
  }
});

test("what is focused is never behind the bar", async ({ lab, page }) => {
  await lab.open("size=32");
  const bar = (await page.locator("#bar").boundingBox())?.y ?? 0;
  for (let press = 0; press < 70; press++) {
    await page.keyboard.press("Tab");
    const hidden = await page.evaluate((bar) => {
      const focused = document.activeElement;
      if (!focused || focused.closest("#bar") || focused === document.body) return false;
      const { top, height } = focused.getBoundingClientRect();
      return top + Math.min(height, 24) > bar;
    }, bar);
    expect(hidden).toBe(false);
  }
});

test("the keyboard alone leads from the load to a pose", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.keyboard.press("Tab");
  await expect(page.getByRole("link", { name: "Skip to Play" })).toBeFocused();
  await page.keyboard.press("Enter");
  await expect(page.getByRole("button", { name: "Play" })).toBeFocused();
  await page.keyboard.press("Enter");
  await lab.reaches("converged");
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: "Pose, JSON" }).focus();
  await page.keyboard.press("Enter");
  expect((await waiting).suggestedFilename()).toBe("pose.json");
});

test("single keys can be switched off", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.keyboard.press("?");
  await page.getByLabel("Keyboard shortcuts on").uncheck();
  await page.getByRole("button", { name: "Close" }).click();
  await page.locator("#clouds-canvas").focus();
  await page.keyboard.press("s");
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await expect(lab.iteration).toHaveText("1");
  await page.reload();
  await lab.reaches("ready");
  await page.keyboard.press("s");
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "The Lab" })).toBeHidden();
});

test("fingers have targets of 44 px", async ({ browser, baseURL }) => {
  const context = await browser.newContext({ hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });
  const page = await context.newPage();
  await page.goto(`${baseURL}#size=32&start=identity`);
  await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
  // On a phone, the wipe appears with a pinned run.
  await page.getByRole("button", { name: "Pin this run" }).click();
  const small = await page
    .locator(
      "#presets button, .transport button, #pace, #input > summary, .top button, #clouds select, #clouds-home, #takeaway button, #pin, #wipe, #coefficients > summary",
    )
    .evaluateAll((targets) =>
      targets
        .filter((target) => target.getBoundingClientRect().height < 44 || target.getBoundingClientRect().width < 44)
        .map((target) => target.outerHTML.slice(0, 80)),
    );
  expect(small).toEqual([]);
  await context.close();
});

test("what a failure says can be read to its end, whatever it says", LONG, async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 800 });
  await lab.visit("size=32&noise=0.1&overlap=0.4");
  await page.keyboard.press(" ");
  await expect(page.locator("#status")).toHaveAttribute("data-state", /lost|ambiguous/);
  await expect(page.locator("#next")).not.toBeEmpty();
  const panel = await page
    .locator("#panel")
    .evaluate(({ scrollHeight, clientHeight }) => ({ scrollHeight, clientHeight }));
  expect(panel.scrollHeight).toBeLessThanOrEqual(panel.clientHeight);
});
