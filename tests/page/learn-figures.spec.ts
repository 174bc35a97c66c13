/** What the figures of the lessons draw for the sentences beside them, and how they mark numbers that are not up to date. */

import type { Page } from "@playwright/test";
import { open, slide } from "./figure";
import { expect, test } from "./lab";

/** The line of an ink in a panel, as its path. */
const line = (page: Page, panel: string, ink: string) =>
  page.locator(`[data-panel="${panel}"] path.learn-ink-${ink}:not(.halo)`);

test("8: the map has the curve of each colour, and they meet at the true normal", async ({ lab, page }) => {
  await open(page, "at=colours&colour=1&noise=0");
  const paths = async () => {
    const found: string[] = [];
    for (const ink of ["red", "green", "blue"]) {
      await expect(line(page, "landscape", ink)).toHaveCount(1);
      found.push((await line(page, "landscape", ink).getAttribute("d")) ?? "");
    }
    return found;
  };
  const coloured = await paths();
  for (const path of coloured) expect(path.length).toBeGreaterThan(100);
  expect(new Set(coloured).size).toBe(3);
  // Light of one colour leaves one curve.
  await slide(page, "colour", 0);
  await expect.poll(async () => new Set(await paths()).size).toBe(1);
  expect(lab.complaints).toEqual([]);
});
