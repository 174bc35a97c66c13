/** Controls the figure of a lesson. */

import { expect, type Locator, type Page } from "@playwright/test";

export const LESSONS = [
  ...["normal", "lambert", "relief", "strips", "orders", "pixel", "grey", "colours"],
  ...["surface", "prior", "pose", "loop", "sensor", "paint", "failure"],
];

export const figure = (page: Page): Locator => page.locator(".learn-figure");

/**
 * Opens a lesson in one of its states. On a loaded page it only changes the address's fragment, as one of the page's own links does, which
 * avoids loading everything again.
 */
export async function open(page: Page, state = ""): Promise<void> {
  const hash = `#learn${state ? `&${state}` : ""}`;
  if (page.url().includes("#learn")) {
    await page.evaluate((hash) => {
      if (location.hash === hash) return;
      // The page resets this once it has drawn; until then, the drawing belongs to the previous address.
      document.querySelector(".learn-figure")?.setAttribute("aria-busy", "true");
      location.hash = hash;
    }, hash);
  } else await page.goto(`./${hash}`);
  // If only the fragment changes, the previous lesson stays until the page handles the change.
  const link = page.locator(`.learn-contents a[data-to="${new URLSearchParams(state).get("at") ?? ""}"]`);
  if ((await link.count()) > 0) await expect(link).toHaveAttribute("aria-current", "true");
  await settled(page);
}

export const control = (page: Page, name: string): Locator => page.locator(`.learn-controls [name="${name}"]`);

/** Waits until the drawing shows the present values. */
export async function settled(page: Page): Promise<void> {
  await expect(figure(page)).toHaveAttribute("aria-busy", "false");
}

export async function number(page: Page, key: string): Promise<number> {
  await settled(page);
  return Number((await page.locator(`[data-number="${key}"]`).getAttribute("data-value")) ?? NaN);
}

/** Moves a slider as a user does; the input event makes the page busy. */
export async function slide(page: Page, name: string, value: number): Promise<void> {
  const slider = page.locator(`.learn-controls input[name="${name}"]`);
  await slider.fill(String(value));
  await expect(slider).toHaveValue(String(value));
}
