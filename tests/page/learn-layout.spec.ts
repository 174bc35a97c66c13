/** Positions of the parts of a lesson's figure: an effect and its control are visible together, and a frame cuts nothing off. */

import type { Page } from "@playwright/test";
import { LESSONS, figure, open, settled } from "./figure";
import { LONG, expect, test } from "./lab";

/** Pictures that stand alone in a row although there are several pictures. */
const lonely = (page: Page): Promise<string[]> =>
  figure(page).evaluate((box) => {
    const pictures = [...box.querySelectorAll<HTMLElement>(".learn-panel:not(.learn-wide)")];
    const top = (panel: Element) => Math.round(panel.getBoundingClientRect().top);
    const rows = [...box.querySelectorAll(".learn-panel")].map(top);
    const alone = pictures.filter((panel) => rows.filter((each) => each === top(panel)).length === 1);
    return pictures.length > 1 ? alone.map((panel) => panel.dataset.panel ?? "") : [];
  });

test("no picture is alone in its row on a laptop", LONG, async ({ page }) => {
  for (const [width, height] of [
    [1280, 720],
    [1440, 900],
  ] as const) {
    await page.setViewportSize({ width, height });
    for (const id of LESSONS) {
      await open(page, `at=${id}`);
      expect(await lonely(page), `${id} at ${width} px`).toEqual([]);
    }
  }
});

test("the controls stay in view while the last picture is looked at", async ({ page }) => {
  for (const [width, height] of [
    [390, 844],
    [1280, 720],
    [1440, 900],
  ] as const) {
    await page.setViewportSize({ width, height });
    await open(page, "at=grey");
    await page.locator(".learn-panel").last().scrollIntoViewIfNeeded();
    await expect(page.locator(".learn-controls input").first()).toBeInViewport();
    await page.evaluate(() => scrollTo(0, 0));
  }
});

test("an embedded figure fits the frame that its line of HTML gives", LONG, async ({ page }) => {
  for (const id of LESSONS) {
    await page.setViewportSize({ width: 1280, height: 800 });
    await open(page, `at=${id}`);
    const line = await page.locator(".learn-embed input").inputValue();
    const [width, height] = ["width", "height"].map((name) =>
      Number(new RegExp(`${name}="(\\d+)"`).exec(line)?.[1]),
    ) as [number, number];
    await page.setViewportSize({ width, height });
    await page.goto("about:blank");
    await page.goto(`./#learn&at=${id}&embed`);
    await settled(page);
    expect(await page.evaluate(() => document.documentElement.scrollHeight), id).toBeLessThanOrEqual(height);
    await page.goto("about:blank");
  }
});

test(
  "a printed lesson takes two pages at most, with its figure and without its buttons",
  LONG,
  async ({ page, say }) => {
    for (const id of LESSONS) {
      await open(page, `at=${id}`);
      const pdf = (await page.pdf({ format: "A4" })).toString("latin1");
      expect(pdf.match(/\/Type\s*\/Page\b/g)?.length, id).toBeLessThanOrEqual(2);
    }
    await page.emulateMedia({ media: "print" });
    await expect(figure(page)).toBeVisible();
    await expect(page.getByRole("button", { name: say("interface.slides", "Slides") })).toBeHidden();
  },
);

test("all of a figure is in view beside its text, with pictures that are large enough", LONG, async ({ page }) => {
  for (const [width, height] of [
    [1280, 800],
    [1440, 900],
    [1920, 1080],
  ] as const) {
    await page.setViewportSize({ width, height });
    for (const id of LESSONS) {
      await open(page, `at=${id}`);
      const hidden = () =>
        figure(page).evaluate((box) =>
          Math.ceil(Math.max(box.scrollHeight - box.clientHeight, box.getBoundingClientRect().bottom - innerHeight)),
        );
      await expect.poll(hidden, `${id} at ${width} px`).toBeLessThanOrEqual(0);
      const sides = await figure(page)
        .locator(":is(.learn-canvas, .learn-plot-box)")
        .evaluateAll((all) => all.map(({ clientWidth, clientHeight }) => Math.min(clientWidth, clientHeight)));
      expect(Math.min(...sides), `${id} at ${width} px`).toBeGreaterThanOrEqual(128);
      expect(await lonely(page), `${id} at ${width} px`).toEqual([]);
    }
  }
});

test("on a phone each picture and plot is seen whole below the controls", LONG, async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  for (const id of LESSONS) {
    await open(page, `at=${id}`);
    const heights = await figure(page).evaluate((box) => {
      const heightOf = (part: Element | null) => part?.getBoundingClientRect().height ?? Infinity;
      const panels = [...box.querySelectorAll(".learn-panel")].map(heightOf);
      return { controls: heightOf(box.querySelector(".learn-controls")), panel: Math.max(...panels) };
    });
    expect(heights.controls + heights.panel, id).toBeLessThan(844);
  }
});
