/** The slides of Learn: each fits its screen, and the browser's Back turns them like pages. */

import { LESSONS, open } from "./figure";
import { LONG, expect, test } from "./lab";

/** The states with the longest texts. */
const WORDIEST = ["pose&run=register&offset=40", "failure&case=symmetry&amount=100", "failure&amount=100"];

test("each slide fits its screen, whatever its figure has to say", LONG, async ({ lab, page }) => {
  for (const state of [...LESSONS, ...WORDIEST]) {
    await open(page, `at=${state}&slides`);
    await expect(page.locator(".learn-slide .learn-figure")).toHaveAttribute("aria-busy", "false");
    for (const [width, height] of [
      [1280, 720],
      [1366, 768],
      [1600, 900],
      [1920, 1080],
    ] as const) {
      await page.setViewportSize({ width, height });
      const below = () =>
        page.locator(".learn-slide").evaluate(({ scrollHeight, clientHeight }) => scrollHeight - clientHeight);
      await expect.poll(below, { message: `${state} at ${width} px` }).toBeLessThanOrEqual(0);
    }
  }
  expect(lab.complaints).toEqual([]);
});

test("before the first slide and after the last there is none, and the buttons say so", async ({ page }) => {
  await page.goto("./#learn&at=normal&slides");
  const previous = page.getByRole("button", { name: "Previous lesson" });
  const next = page.getByRole("button", { name: "Next lesson" });
  await expect(page.getByRole("heading", { name: "1. What a normal is" })).toBeVisible();
  await expect(previous).toBeDisabled();
  await next.click();
  await expect(page.getByRole("heading", { name: "2. Light and angle" })).toBeVisible();
  await expect(previous).toBeEnabled();
  await page.goto("./#learn&at=paint&slides");
  await expect(page.getByRole("heading", { name: "13. Shadows and paint" })).toBeVisible();
  await next.click();
  await expect(page.getByRole("heading", { name: "14. When it fails" })).toBeVisible();
  await expect(next).toBeDisabled();
});

test("the browser's Back turns a slide back, then leads to the lesson, and Forward again", async ({ lab, page }) => {
  await page.goto("./#learn&at=pose");
  await page.getByRole("navigation", { name: "Lessons" }).getByRole("link", { name: "What a pixel shows" }).click();
  const heading = (title: string) => page.getByRole("heading", { name: title });
  const slides = page.locator("dialog.learn-slides");
  await page.getByRole("button", { name: "Slides" }).click();
  await expect(slides).toBeVisible();
  await page.keyboard.press("ArrowRight");
  await expect(heading("7. One grey light is not enough")).toBeVisible();
  // A changed setting adds no entry to the history.
  await slides.locator('input[name="turn"]').fill("90");
  await expect(page).toHaveURL(/at=grey&turn=90&slides$/);
  await page.keyboard.press("PageDown");
  await expect(heading("8. Three colours")).toBeVisible();
  await page.goBack();
  await expect(heading("7. One grey light is not enough")).toBeVisible();
  await expect(slides.locator('input[name="turn"]')).toHaveValue("90");
  await page.goBack();
  await expect(heading("6. What a pixel shows")).toBeVisible();
  await expect(slides).toBeVisible();
  await page.goBack();
  await expect(slides).toBeHidden();
  await expect(heading("6. What a pixel shows")).toBeVisible();
  await expect(page).toHaveURL(/at=pixel$/);
  await page.goForward();
  await expect(slides).toBeVisible();
  await expect(heading("6. What a pixel shows")).toBeVisible();
  // From the slides to the Lab, and back to the lesson itself.
  await page.goto("./#size=32");
  await lab.reaches("ready");
  await page.getByRole("link", { name: "Learn", exact: true }).click();
  await expect(slides).toBeHidden();
  await expect(page.locator(".learn-main").getByRole("heading", { name: "6. What a pixel shows" })).toBeVisible();
  expect(lab.complaints).toEqual([]);
});
