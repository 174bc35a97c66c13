/** Answers of the worker that come after the visitor has gone on. */

import { expect, test } from "./lab";
import { answerChecks, matrixFile } from "./rig";
import { openPair, run } from "./rigsteps";

test("a calibration that is changed while its file is compared with the others stays changed", async ({
  lab,
  page,
}) => {
  let arrange = () => {};
  const held = new Promise<void>((go) => (arrange = go));
  await page.route(/\/pairs-[^/]*\.js$/, async (route) => {
    await held;
    await route.continue();
  });
  await openPair(page);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  const files = page.locator("#rig .rig-step:not([hidden]) input[type=file]");
  await files.setInputFiles(matrixFile("factory.txt", 0.025));
  await page.getByRole("button", { name: "Invert factory" }).click();
  const words = page.locator(".rig-words");
  await expect(words).toContainText("25.0 mm to the left of");
  const answered = page.waitForResponse(/\/pairs-[^/]*\.js$/);
  arrange();
  await answered;
  // The answer about this file comes after the answer about the first one.
  await files.setInputFiles(matrixFile("other.txt", 0.04));
  await expect(words.nth(1)).toContainText("40.0 mm to the right of");
  await expect(words.first()).toContainText("25.0 mm to the left of");
  expect(lab.complaints).toEqual([]);
});

test("a check can be cancelled while its frames are on their way", async ({ lab, page }) => {
  await answerChecks(page, "unsent");
  await openPair(page);
  await run(page);
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect(page.locator(".rig-run").getByRole("status")).toHaveText("Cancelled. Files and calibrations are kept.");
  expect(lab.complaints).toEqual([]);
});
