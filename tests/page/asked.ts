/** The questions on slides. */

import type { Locator, Page } from "@playwright/test";

export const dialog = (page: Page): Locator => page.locator("dialog.learn-slides");
export const asked = (page: Page): Locator => dialog(page).locator(".learn-guess[data-asked]");
/** The exercise on a slide. */
export const exercise = (page: Page): Locator => dialog(page).locator(".learn-asked[data-asked]");

/** Guesses the first choice or a number, and compares. */
export async function guess(page: Page): Promise<void> {
  const form = asked(page);
  const typed = form.locator("input[type=number]");
  if ((await typed.count()) > 0) await typed.fill("3");
  else await form.locator("label").first().click();
  await form.locator("button[type=submit]").click();
}
