/** Graphics that are lost and restored, and a page that is hidden for a while. */

import { breakable, endAll, fragileGraphics, graphics, hide } from "./broken";
import { covered, goToClouds, DRAWN, NO_OFFSCREEN } from "./clouds";
import { LONG, expect, test } from "./lab";

for (const [where, script] of [
  ["in a thread", ""],
  ["on the page", NO_OFFSCREEN],
] as const) {
  test(`WebGL that is lost ${where} is told of, and the clouds are drawn again once it is back`, async ({
    lab,
    page,
  }) => {
    await page.addInitScript(script);
    await fragileGraphics(page);
    await lab.open("size=48");
    await goToClouds(page);
    const [note, clouds] = [page.locator("#clouds-note"), page.locator("#clouds-canvas")];
    await expect(note).toBeHidden();
    await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
    await graphics(page, "lose");
    await expect(note).toBeVisible();
    await expect(note).toContainText("The surfaces stand still until it returns");
    // Everything else continues.
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    await graphics(page, "restore");
    await expect(note).toBeHidden();
    await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("2");
    lab.complaints.splice(0, Infinity, ...lab.complaints.filter((line) => !/Context Lost/i.test(line)));
  });
}

test("the thread that draws is ended: another draws, once", async ({ lab, page }) => {
  await breakable(page);
  await lab.open("size=48");
  await goToClouds(page);
  const [note, clouds] = [page.locator("#clouds-note"), page.locator("#clouds-canvas")];
  await expect(note).toBeHidden();
  await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
  await clouds.evaluate((canvas) => (canvas.dataset.first = "1"));
  await endAll(page, "stage-thread");
  await expect(page.locator("#clouds-canvas:not([data-first])")).toBeVisible();
  await expect(note).toBeHidden();
  await expect.poll(() => covered(clouds)).toBeGreaterThan(DRAWN);
  await expect(page.locator("#clouds-box .dot")).toHaveCount(2);
  await endAll(page, "stage-thread");
  await expect(note).toContainText("ended the drawing thread twice");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
});

test(
  "a run stands still while its tab is hidden, and goes on to the same end when it is shown",
  LONG,
  async ({ lab, page }) => {
    await breakable(page);
    await lab.open("size=48");
    await page.getByRole("button", { name: "Play" }).click();
    await lab.reaches("converged");
    const undisturbed = [await lab.iteration.innerText(), await page.locator("#pose").innerText()];
    await page.keyboard.press("r");
    await lab.reaches("ready");
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    await hide(page, true);
    await page.getByRole("button", { name: "Play" }).click();
    // The requested frame arrives. As long as it cannot be drawn, no other frame is requested.
    await expect(lab.iteration).toHaveText("2");
    await page.evaluate(async () => {
      // Time for a dozen frames, so that the test could fail.
      for (let count = 0; count < 4; count++) await new Promise((go) => setTimeout(go, 50));
    });
    await expect(lab.iteration).toHaveText("2");
    await lab.reaches("playing");
    await hide(page, false);
    await lab.reaches("converged");
    expect([await lab.iteration.innerText(), await page.locator("#pose").innerText()]).toEqual(undisturbed);
  },
);
