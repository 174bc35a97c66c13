/**
 * Every part of the page works in Firefox, a second engine, except the clouds. Without a graphics card Firefox has no WebGL, and the page
 * says so.
 */

import { expect, test } from "../page/lab";

test.afterEach(({ lab }) => {
  lab.complaints.splice(0, Infinity, ...lab.complaints.filter((line) => !line.startsWith("THREE.WebGLRenderer:")));
});

test("the Lab finds the pose of its sample, and draws it", async ({ lab, page }) => {
  await lab.visit("size=48");
  const before = await lab.fingerprint("Normals");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");
  expect(await lab.errorDegrees()).toBeLessThan(1);
  expect(await lab.fingerprint("Normals")).not.toBe(before);
});

test("a lesson answers its slider", async ({ page }) => {
  await page.goto("./#learn&at=pixel");
  const figure = page.locator(".learn-figure");
  await expect(figure).toHaveAttribute("aria-busy", "false");
  const before = await page.locator(".learn-numbers").innerText();
  await page.locator('.learn-controls input[name="beta"]').fill("55");
  await expect(figure).toHaveAttribute("aria-busy", "false");
  await expect(page.locator(".learn-numbers")).not.toHaveText(before);
});

test("a cell of the Tables is measured, and Check a rig reads its example", async ({ page }) => {
  await page.goto("./#tables");
  await page.locator("#tables .heat-cell").first().click();
  await expect(page.locator("#tables .heat-cell[data-value]").first()).toBeVisible();
  await page.goto("./#rig");
  await page.getByRole("button", { name: "Load an example" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
});
