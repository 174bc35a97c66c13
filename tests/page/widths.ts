/** One visit at several widths of the window: a start of the page for each would cost most of what such a test takes. */

import type { Page } from "@playwright/test";

/** What a visit begins with: here the page has to get by with least, and nothing has been wider before. */
export const narrowest = { width: 320, height: 844 };

/** How far the document reaches, px; more than the window's width sticks out. */
export const innerWidth = (page: Page): Promise<number> => page.evaluate(() => document.documentElement.scrollWidth);

/** Looks at the page in windows of these widths, and leaves it as narrow as at the start. */
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

/** Two frames later whoever watches sizes has drawn for the new one. */
async function resize(page: Page, width: number, height: number): Promise<void> {
  await page.setViewportSize({ width, height });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}
