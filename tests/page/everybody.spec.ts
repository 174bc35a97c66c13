/** Touch, keyboard, and reduced motion. */

import type { Page } from "@playwright/test";
import { LONG, expect, test } from "./lab";
import { answerChecks } from "./rig";
import { atWidths, innerWidth, narrowest } from "./widths";

/** Smallest side of a touch target, px (WCAG 2.5.5), with half a pixel for rounding. */
const TARGET = 43.5;

/** Controls that are smaller, except links within a sentence, which are as high as the line; a check box's target is its label. */
const small = (page: Page): Promise<string[]> =>
  page.evaluate((least) => {
    const controls = [
      ...document.querySelectorAll<HTMLElement>("a[href], button, select, summary, input, [tabindex='0']"),
    ];
    return controls.flatMap((control) => {
      const isBox = control.matches("[type=checkbox], [type=radio], [type=file]");
      const target = (isBox && (control as HTMLInputElement).labels?.[0]) || control;
      const { width, height } = target.getBoundingClientRect();
      const isSeen = control.checkVisibility({ visibilityProperty: true }) && width > 0 && !control.matches(".skip");
      const isInSentence = control.matches("p a, li a") && getComputedStyle(control).display === "inline";
      if (!isSeen || isInSentence || (width >= least && height >= least)) return [];
      return [
        `${control.tagName} ${control.id || control.className} ${control.textContent?.trim()}: ${Math.round(width)}x${Math.round(height)}`,
      ];
    });
  }, TARGET);

test.describe("by touch", () => {
  test.use({ hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });

  test("whatever is to be pressed is as large as a finger", async ({ lab, page }) => {
    await lab.visit("size=48");
    expect(await page.evaluate(() => matchMedia("(pointer: coarse)").matches)).toBe(true);
    expect(await small(page), "the Lab").toEqual([]);
    await page.locator("#input > summary").tap();
    for (const summary of await page.locator("#input details > summary").all())
      if (await summary.isVisible()) await summary.tap();
    expect(await small(page), "settings").toEqual([]);
    // The open settings cover the button that opened them.
    await page.getByRole("button", { name: "Close settings" }).tap();
    await expect(page.getByRole("button", { name: "Close settings" })).toBeHidden();
    await page.locator("#input > summary").tap();
    await page.getByRole("button", { name: "Play", exact: true }).tap();
    await expect(page.getByRole("button", { name: "Close settings" }), "over what plays").toBeHidden();
    for (const id of ["normal", "strips", "pixel", "pose", "paint", "exercises"]) {
      await page.goto(`./#learn&at=${id}`);
      await expect(page.locator(id === "exercises" ? ".learn-exercises" : `[data-lesson="${id}"]`)).toBeVisible();
      expect(await small(page), id).toEqual([]);
    }
    await page.goto("./#tables");
    await expect(page.locator(".heat-cell").first()).toBeVisible();
    expect(await small(page), "the Tables").toEqual([]);
  });

  test("one place alone looks current, after Back, too", async ({ page }) => {
    await page.goto("./#tables");
    await expect(page.locator(".heat-cell").first()).toBeVisible();
    await page.locator("#to-rig").tap();
    await expect(page.locator("#to-rig")).toHaveAttribute("aria-current", "page");
    await page.goBack();
    await expect(page.locator("#to-tables")).toHaveAttribute("aria-current", "page");
    const marked = await page
      .locator(".top nav a")
      .evaluateAll((links) => links.filter((link) => getComputedStyle(link).boxShadow !== "none").map(({ id }) => id));
    expect(marked).toEqual(["to-tables"]);
  });

  test("so it is where a rig is checked", LONG, async ({ page }) => {
    await answerChecks(page, "off");
    await page.goto("./#rig");
    await page.getByRole("button", { name: "Load an example" }).tap();
    await expect(page.locator(".rig-frame")).toHaveCount(3);
    expect(await small(page), "files").toEqual([]);
    await page.getByRole("button", { name: "Next: your calibration" }).tap();
    expect(await small(page), "calibrations").toEqual([]);
    await page.getByRole("button", { name: "Run the check" }).tap();
    await expect(page.locator(".rig-bar").first()).toBeVisible();
    // The picture appears a little later.
    await expect
      .poll(() => page.locator(".rig-overlay-board").evaluate(({ clientHeight }) => clientHeight))
      .toBeGreaterThan(TARGET);
    expect(await small(page), "verdict").toEqual([]);
  });
});

test("single keys are switched off for good, where that is asked for", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.locator("#help-button").click();
  await page.getByLabel("Keyboard shortcuts on").uncheck();
  await page.reload();
  await lab.reaches("ready");
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog")).toBeHidden();
  await page.locator("#help-button").click();
  await expect(page.getByLabel("Keyboard shortcuts on")).not.toBeChecked();
});

test("the tab key goes through the page as it is used: places, examples, settings, inputs, surfaces, outcome, numbers, player", async ({
  lab,
  page,
}) => {
  await lab.open("size=32");
  const parts = ["#skip", ".top", ".lead", "#inputs", "#hero", "#outcome", "#views", "#numbers", "#bar"];
  const met: string[] = [];
  for (let press = 0; press < 120 && met.at(-1) !== "#bar"; press++) {
    await page.keyboard.press("Tab");
    const part = await page.evaluate((parts) => parts.find((part) => document.activeElement?.closest(part)), parts);
    if (part && met.at(-1) !== part) met.push(part);
  }
  expect(met).toEqual(parts);
});

test("what is taken away is two presses of the tab key and Enter away", async ({ lab, page }) => {
  await lab.open("size=32");
  for (const key of ["Tab", "Tab", "Enter"]) await page.keyboard.press(key);
  await expect(page.getByRole("button", { name: "Pose, JSON" })).toBeFocused();
  await expect(page.getByRole("button", { name: "Pose, JSON" })).toBeInViewport();
  await expect(page).not.toHaveURL(/takeaway/);
  await page.getByRole("link", { name: "Learn" }).click();
  await expect(page.locator("#skip-takeaway")).toBeHidden();
});

test("who wants less motion gets no show, and surfaces that do not swing", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("./");
  await lab.reaches("ready");
  await expect(lab.iteration).toHaveText("0");
  expect(await page.evaluate(() => document.getAnimations().length)).toBe(0);
});

test("neither the Tables nor Check a rig stick out from 320 to 2560 px, nor the page's last line", async ({ page }) => {
  await page.setViewportSize(narrowest);
  for (const place of ["tables", "rig"]) {
    await page.goto(`./#${place}`);
    await expect(page.locator(`#${place} h2`).first()).toBeVisible();
    await atWidths(page, [320, 390, 1280, 1600, 2560], async (width) => {
      expect(await innerWidth(page), `${place} at ${width} px`).toBeLessThanOrEqual(width);
      await expect(page.getByText("there are no analytics")).toBeVisible();
    });
  }
});
