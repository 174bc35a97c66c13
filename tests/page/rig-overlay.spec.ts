/** The overlay of a verdict, and the space that it takes. */

import { expect, test } from "./lab";
import { answerChecks, giveFiles, pair } from "./rig";

declare global {
  interface Window {
    /** Requests for pictures that are held back; undefined if all pass. */
    pictures: (() => void)[] | undefined;
  }
}

test("the overlay is as high before its picture as with it: nothing below jumps", async ({ page }) => {
  await answerChecks(page, "off");
  await page.addInitScript(() => {
    const send = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (
      this: Worker,
      message: { kind?: string },
      options?: StructuredSerializeOptions | Transferable[],
    ) {
      const pass = () => send.call(this, message, options as StructuredSerializeOptions);
      if (window.pictures && message.kind === "picture") window.pictures.push(pass);
      else pass();
    };
  });
  await page.goto("./#rig");
  await giveFiles(page, pair());
  await page.evaluate(() => void (window.pictures = []));
  await page
    .getByRole("navigation", { name: "Steps" })
    .getByRole("button", { name: /Your calibration/ })
    .click();
  await page.getByRole("button", { name: /^(Run the check|Estimate a calibration)$/ }).click({ timeout: 20_000 });
  const board = page.locator(".rig-overlay-board");
  await expect(board).toBeVisible();
  await expect.poll(() => page.evaluate(() => window.pictures?.length)).toBeGreaterThan(0);
  const height = () => board.evaluate((element) => element.getBoundingClientRect().height);
  const before = await height();
  expect(before).toBeGreaterThan(100);
  await page.evaluate(() => {
    for (const pass of window.pictures ?? []) pass();
    window.pictures = undefined;
  });
  await expect(page.getByRole("img", { name: /^Depth map on the colour image of / })).toBeVisible();
  expect(await height()).toBe(before);
});
