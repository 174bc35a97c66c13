/** What tests of the clouds look at. */

import { expect, type Locator, type Page } from "@playwright/test";
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

/**
 * The picture once it stands still: it follows its cause after some time, and how long that is nobody knows on a busy machine. Each look
 * makes the browser draw, so that three alike in a row are three pictures drawn.
 */
export async function still(target: Locator): Promise<Buffer> {
  let last = await target.screenshot();
  let alike = 1;
  await expect
    .poll(async () => {
      const next = await target.screenshot();
      alike = next.equals(last) ? alike + 1 : 1;
      last = next;
      return alike;
    })
    .toBeGreaterThanOrEqual(3);
  return last;
}

/** The clouds are loaded once a visitor comes near them; on a laptop they are there at once. */
export const goToClouds = (page: Page) => page.locator("#clouds-box").scrollIntoViewIfNeeded();

/** Browsers whose threads have no canvas. */
export const NO_OFFSCREEN = "delete HTMLCanvasElement.prototype.transferControlToOffscreen;";
