/** What tests of the clouds look at. */

import type { Locator, Page } from "@playwright/test";
import { decode } from "fast-png";

/** Share of the picture that two clouds cover, at least. */
export const DRAWN = 0.02;

/** Share of the pixels of the clouds' picture that are not of its ground, which its corner shows. */
export async function covered(clouds: Locator): Promise<number> {
  const { data, channels, width, height } = decode(await clouds.screenshot());
  const ground = data.subarray(0, 3);
  let count = 0;
  for (let i = 0; i < width * height; i++) {
    if (ground.some((value, c) => Math.abs(value - (data[i * channels + c] ?? 0)) > 24)) count++;
  }
  return count / (width * height);
}

/** The clouds are loaded once a visitor comes near them; on a laptop they are there at once. */
export const goToClouds = (page: Page) => page.locator("#clouds-box").scrollIntoViewIfNeeded();

/** Browsers whose threads have no canvas. */
export const NO_OFFSCREEN = "delete HTMLCanvasElement.prototype.transferControlToOffscreen;";
