/** What the verdict advises: about which calibration, whether the best fit may replace it, and what its curves warn of. */

import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { answerChecks, reportOf } from "./rig";
import { openFrames, openPair, run } from "./rigsteps";

/** The check fits the inverse of this calibration. */
const inverted = (name: string) => ({
  warnings: [
    {
      code: "fits-inverted" as const,
      message: `${name}: fits inverted (1.2 px instead of 10.7): it seems to map colour to depth; invert it.`,
      field: `candidates.${name}`,
    },
  ],
});
/** Checks three frames and two calibrations. A guess would have the first advice, so it is confirmed. */
async function check(page: Page): Promise<void> {
  await openFrames(page);
  await page.getByRole("button", { name: "Confirm", exact: true }).first().click();
  await run(page);
}
const next = (page: Page) => page.locator(".rig-next");
const list = (page: Page) => page.locator(".rig-advice-list li");
const saved = (page: Page) => page.getByLabel("Calibration", { exact: true }).locator("option");

test("advice about another calibration names it and leaves the first place to that of the verdict", async ({
  lab,
  page,
}) => {
  await answerChecks(page, "off", undefined, inverted("other"));
  await check(page);
  await expect(page.locator(".rig-subject")).toHaveText("This is about “given”, the first of 2 calibrations.");
  await expect(next(page)).toContainText("use it instead of “given”");
  await expect(next(page)).not.toContainText(/invert/i);
  await expect(list(page).last()).toHaveText(
    "About “other”, which this verdict is not about: invert it in step 2 and check again, because it seems to be an inverse.",
  );
  expect(lab.complaints).toEqual([]);
});

test("a calibration that fits inverted is named first in the advice on it", async ({ lab, page }) => {
  await answerChecks(page, "off", undefined, inverted("given"));
  await check(page);
  await expect(next(page)).toHaveText("Next: Invert “given” in step 2 and check again: it seems to be the inverse.");
  await expect(page.getByText("which this verdict is not about")).toHaveCount(0);
  expect(lab.complaints).toEqual([]);
});

test("a best fit that is itself too uncertain is not offered in place of a calibration", async ({ lab, page }) => {
  const message = "The shift along z is the least certain. One more frame with the scene 0.3 m nearer would help.";
  await answerChecks(page, "off", undefined, {
    health: { pixels: 23.9, interval: [1.1, 63.1] },
    next: { ...reportOf("off", ["a"], ["b"]), message } as never,
  });
  await check(page);
  await expect(next(page)).toHaveText(
    `Next: Do not use the best fit instead of “given”: it is itself too uncertain, 23.90 px (95 %: 1.10 to 63.10 px; the limit is 3.5 px). ${message}`,
  );
  await expect(page.getByText(message)).toHaveCount(2);
  await expect(page.getByText("Save the calibration found here")).toHaveCount(0);
  expect(await saved(page).allTextContents()).toEqual(["given", "other"]);
  await expect(page.getByLabel("Calibration", { exact: true })).toHaveValue("given");
  await expect(page.getByText("is not offered here, because it is too uncertain to use")).toBeVisible();
  expect(lab.complaints).toEqual([]);
});

test("an estimate that is too uncertain says so, also where it is saved", async ({ lab, page }) => {
  await answerChecks(page, "undecided", undefined, { health: { pixels: 23.9, interval: [1.1, 63.1] } });
  await openPair(page);
  await page.getByRole("button", { name: "Confirm", exact: true }).first().click();
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Estimated");
  await expect(next(page)).toHaveText(
    "Next: The best fit is too uncertain to use: 23.90 px (95 %: 1.10 to 63.10 px; the limit is 3.5 px).",
  );
  expect(await saved(page).allTextContents()).toEqual(["found (too uncertain to use)"]);
  expect(lab.complaints).toEqual([]);
});

test("a calibration beyond a curve is marked, and a minimum at its end is a warning", async ({ lab, page }) => {
  const { candidates, sensitivity } = reportOf("off", ["given"], []);
  const given = { ...candidates.given, offAxes: [9.5, 2.04, 0, 0, 0, -80] } as (typeof candidates)[string];
  // About z the loss falls to the end of the chart, which the wide interval contains. Along x nothing is seen.
  const values = ({ axis, offsets, values }: (typeof sensitivity)[number]) =>
    axis === "rz" ? offsets.map((x) => x) : axis === "tx" ? offsets.map(() => 7) : values;
  const covariance = Array.from({ length: 36 }, (_, i) => (i % 7 === 0 ? 0.01 : 0));
  await answerChecks(page, "off", undefined, {
    covariance,
    candidates: { given },
    sensitivity: sensitivity.map((each) => ({ ...each, values: values(each) })),
  });
  await check(page);
  const curve = (title: string) => page.locator(".rig-curves figure", { hasText: title });
  await expect(curve("Rotation about x")).toContainText("“given” at 9.50°, beyond the end of the chart (arrow)");
  await expect(curve("Rotation about y")).toContainText(/“given” at 2\.04°$/);
  await expect(curve("Shift along z")).toContainText("“given” at −80.0 mm, beyond the end of the chart (arrow)");
  await expect(curve("Rotation about z")).toContainText("Minimum at 5.00° or beyond");
  await expect(curve("Rotation about z")).toContainText("the minimum lies at the end of the chart, so do not trust it");
  await expect(curve("Shift along x")).toContainText("Minimum at 0.0 mm;");
  await expect(curve("Shift along x")).not.toContainText("end of the chart");
  // Each of the six values lies within its interval, although the calibration is off.
  await expect(page.locator(".rig-correlated")).toContainText("The six unknowns are correlated");
  expect(lab.complaints).toEqual([]);
});

test("nothing is said of correlation where a value lies outside its own interval", async ({ lab, page }) => {
  await answerChecks(page, "off");
  await check(page);
  await expect(page.locator(".rig-curves figure")).toHaveCount(6);
  await expect(page.locator(".rig-correlated")).toBeHidden();
  expect(lab.complaints).toEqual([]);
});

test("a verdict that warnings cap has one word in the headline and in its row", async ({ lab, page }) => {
  const { candidates } = reportOf("consistent", ["given"], []);
  await answerChecks(page, "undecided", undefined, { candidates, code: "doubtful", ...inverted("other") });
  await check(page);
  await expect(page.locator(".rig-word")).toHaveText("Undecided, see warnings");
  const row = page
    .locator(".rig-calibrations tbody tr")
    .filter({ has: page.getByRole("rowheader", { name: "given" }) });
  await expect(row).toContainText("Undecided");
  await expect(row).not.toContainText("Consistent");
  await expect(page.locator(".rig-verdict p").first()).toContainText("It would be consistent without the warnings. ");
  expect(lab.complaints).toEqual([]);
});
