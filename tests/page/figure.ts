/** The figure of a lesson in a test's hands. */

import { expect, type Locator, type Page } from "@playwright/test";

export const LESSONS = ["pixel", "grey", "colours", "surface", "prior", "pose", "sensor", "paint", "failure"];

export const figure = (page: Page): Locator => page.locator(".learn-figure");

/**
 * Opens a lesson in one of its states. A page that has loaded hears of it by the end of its address alone, as it does from a link of its
 * own, which spares loading everything anew.
 */
export async function open(page: Page, state = ""): Promise<void> {
  const hash = `#learn${state ? `&${state}` : ""}`;
  if (page.url().includes("#learn")) {
    await page.evaluate((hash) => {
      if (location.hash === hash) return;
      // Taken back by the page once it has drawn: what is drawn still belongs to the address before.
      document.querySelector(".learn-figure")?.setAttribute("aria-busy", "true");
      location.hash = hash;
    }, hash);
  } else await page.goto(`./${hash}`);
  // Where only the address's end is another one, the lesson before is there until the page hears of it.
  const link = page.locator(`.learn-contents a[href="#learn&at=${new URLSearchParams(state).get("at") ?? ""}"]`);
  if ((await link.count()) > 0) await expect(link).toHaveAttribute("aria-current", "true");
  await settled(page);
}

/** The last drawing for the values as they are. */
export async function settled(page: Page): Promise<void> {
  await expect(figure(page)).toHaveAttribute("aria-busy", "false");
}

export async function number(page: Page, key: string): Promise<number> {
  await settled(page);
  return Number((await page.locator(`[data-number="${key}"]`).getAttribute("data-value")) ?? NaN);
}

/** Moves a slider as a hand does: the page hears of it by the input event, and is busy from then on. */
export async function slide(page: Page, name: string, value: number): Promise<void> {
  const slider = page.locator(`.learn-controls input[name="${name}"]`);
  await slider.fill(String(value));
  await expect(slider).toHaveValue(String(value));
}
