/** Touch on the surfaces: horizontal movements rotate them, vertical ones scroll the page. */

import { expect, test } from "@playwright/test";
import { still } from "./clouds";
import { LONG } from "./lab";

test(
  "a finger up or down scrolls the page and turns nothing; across, or two of them, turn the surfaces and scroll nothing",
  LONG,
  async ({ browser, baseURL }) => {
    // Stops animations while pictures are compared.
    const context = await browser.newContext({
      hasTouch: true,
      isMobile: true,
      reducedMotion: "reduce",
      viewport: { width: 390, height: 844 },
    });
    const page = await context.newPage();
    await page.goto(`${baseURL}#size=32&start=identity`);
    await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
    await expect(page.locator("#clouds-note")).toBeHidden();
    const canvas = page.locator("#clouds-canvas");
    // A note on the surfaces explains how to tilt them.
    await expect(page.getByText("one finger rotates, two tilt")).toBeVisible();
    const hand = await context.newCDPSession(page);
    const scrolled = () => page.evaluate(() => scrollY);

    /** Moves adjacent fingers by these distances across and down, in steps that the browser handles one by one. */
    const swipe = async (fingers: number, across: number, down: number) => {
      const box = await canvas.boundingBox();
      if (!box) throw new Error("the surfaces are on the page");
      const at = (share: number) =>
        Array.from({ length: fingers }, (_, id) => ({
          id,
          x: box.x + box.width / 2 + 60 * (id - (fingers - 1) / 2) + share * across,
          y: box.y + box.height / 2 + share * down,
        }));
      const frame = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(done)));
      await hand.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
      for (let step = 1; step <= 10; step++) {
        await hand.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(step / 10) });
        await frame();
      }
      await hand.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    };

    for (const [fingers, across, down, turns] of [
      [1, 0, -90, false],
      [1, 0, 50, false],
      [1, 80, 0, true],
      [2, 0, -80, true],
      [2, 80, 0, true],
    ] as const) {
      const what = `${fingers} by ${across}, ${down}`;
      await page.getByRole("button", { name: "Home", exact: true }).click();
      const from = 60;
      await page.evaluate((from) => scrollTo(0, from), from);
      const before = await still(canvas);
      expect(await scrolled(), what).toBe(from);
      await swipe(fingers, across, down);
      if (turns) {
        await expect.poll(async () => (await canvas.screenshot()).equals(before), { message: what }).toBe(false);
        expect(await scrolled(), what).toBe(from);
      } else {
        if (down < 0) await expect.poll(scrolled, { message: what }).toBeGreaterThan(from + 40);
        else await expect.poll(scrolled, { message: what }).toBeLessThan(from - 20);
        await page.evaluate((from) => scrollTo(0, from), from);
        expect((await still(canvas)).equals(before), what).toBe(true);
      }
    }
    await context.close();
  },
);
