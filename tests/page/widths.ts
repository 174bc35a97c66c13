/** One visit at several window widths, because starting the page for each would take most of a test's time. */

import type { Page } from "@playwright/test";

/** The first size of a visit: the narrowest layout, so that no wider one precedes it. */
export const narrowest = { width: 320, height: 844 };

/** Width of the document, px; anything beyond the window's width sticks out. */
export const innerWidth = (page: Page): Promise<number> => page.evaluate(() => document.documentElement.scrollWidth);

/** Checks the page at these window widths, and restores the narrow one. */
export async function atWidths(
  page: Page,
  widths: readonly number[],
  look: (width: number) => Promise<void>,
  height = narrowest.height,
): Promise<void> {
  for (const width of widths) {
    await resize(page, width, height);
    await look(width);
  }
  await resize(page, narrowest.width, height);
}

/** Resizes the window and waits two frames, in which resize observers have redrawn. */
async function resize(page: Page, width: number, height: number): Promise<void> {
  await page.setViewportSize({ width, height });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}
