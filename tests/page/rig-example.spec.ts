/** The example of "Check a rig", checked as by a visitor, with the package itself. */

import { readFileSync } from "node:fs";
import { LONG, expect, test } from "./lab";

test("the example is checked by the package itself", LONG, async ({ lab, page }) => {
  await page.goto("./#rig");
  await page.getByRole("button", { name: "Load an example" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await page.getByRole("button", { name: "Run the check" }).click();
  await expect(page.locator(".rig-word")).toHaveText("Off");
  // The rotation shifts distant points by more than the baseline, so the headline, its row and the report name the place.
  const place = /and [\d.]+ mm \(mostly along [xyz]\) at the centre of the scene, \d\.\d\d m away/;
  await expect(page.locator(".rig-verdict p").first()).toHaveText(place);
  await expect(page.locator(".rig-reason").first()).toContainText(place);
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save report (HTML)" }).click();
  expect(readFileSync(await (await download).path(), "utf8").match(new RegExp(place, "g"))).toHaveLength(2);
  const told = page.locator(".rig-calibrations tbody tr").nth(1);
  const degrees = Number.parseFloat((await told.locator("td").nth(1).textContent()) ?? "");
  // The error of the calibration is 2 degrees.
  expect(degrees).toBeGreaterThan(1);
  expect(degrees).toBeLessThan(3);
  const rendered = page
    .locator(".rig-calibrations tbody tr")
    .filter({ has: page.getByRole("rowheader", { name: "as rendered" }) });
  await expect(rendered).not.toContainText("Off");
  await expect(page.locator(".rig-curves figure")).toHaveCount(6);
  expect(lab.complaints).toEqual([]);
});
