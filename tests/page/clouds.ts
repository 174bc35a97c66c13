/** Helpers for tests of the clouds. */

import { expect, type Locator, type Page } from "@playwright/test";
import { decode } from "fast-png";

/** Smallest share of the picture that two clouds cover. */
export const DRAWN = 0.02;

/** Share of the pixels that differ from the background, whose colour is taken at a corner. */
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
 * The picture once it has stopped changing. It follows its cause with a delay of unknown length on a busy machine. Each screenshot makes the
 * browser draw, so three equal ones in a row are three drawn pictures.
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

/** Scrolls to the clouds, which load when a visitor comes near; on a large screen they load at once. */
export const goToClouds = (page: Page) => page.locator("#clouds-box").scrollIntoViewIfNeeded();

/** Simulates a browser whose threads have no canvas. */
export const NO_OFFSCREEN = "delete HTMLCanvasElement.prototype.transferControlToOffscreen;";
