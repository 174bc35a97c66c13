/** Intrinsics of common sensors: published figures for a rig whose own are not known, as guesses that cap the verdict. */

import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { answerChecks, matrixFile, pair } from "./rig";
import { open, put, run, step } from "./rigsteps";

const depth = (page: Page) => page.getByRole("group", { name: "Depth camera" });
const source = (page: Page) => depth(page).getByLabel("Source of its parameters");

test("a common sensor gives missing intrinsics, which stay a guess in the verdict", async ({ lab, page }) => {
  const asked: string[] = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  const tables = () => asked.filter((path) => /\/sensors-[^/]*\.js$/.test(path)).length;
  await answerChecks(page, "consistent");
  await open(page);
  await put(page, [...pair(), matrixFile("factory.txt", 0.025)]);
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await expect(page.locator(".rig-missing")).toContainText("the depth camera's parameters");
  expect(tables()).toBe(0);
  await source(page).selectOption("sensor");
  const sensors = depth(page).getByLabel("Sensor", { exact: true });
  await expect(sensors.locator("option", { hasText: "Orbbec Astra" })).toHaveCount(1);
  expect(tables()).toBe(1);
  // Only depth cameras whose pictures have the shape of this one, 4:3.
  await expect(sensors.locator("option", { hasText: "16:9" })).toHaveCount(0);
  await expect(sensors.locator("option", { hasText: "colour" })).toHaveCount(0);
  await expect(page.locator(".rig-missing")).toContainText("the depth camera's parameters");
  await sensors.selectOption("Kinect for Xbox 360");
  // 525 px at a width of 640 px, in a picture of 160 px.
  await expect(depth(page).locator(".rig-camera-numbers")).toContainText("fx 131.25, fy 131.25, cx 79.50, cy 59.50 px");
  await page.getByRole("button", { name: "Confirm", exact: true }).click();
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Undecided, see warnings");
  await expect(page.locator(".rig-verdict")).toContainText(
    "The depth camera's parameters are published figures of a sensor (Kinect for Xbox 360), which is a guess",
  );
  // The same numbers, entered as the visitor's own, are no guess.
  await step(page, "Files and cameras").click();
  await depth(page).getByRole("button", { name: "Edit these parameters" }).click();
  await expect(source(page)).toHaveValue("typed");
  await step(page, "Verdict").click();
  await page.getByRole("button", { name: "Run again" }).click();
  await expect(page.locator(".rig-word")).toHaveText("Consistent");
  expect(lab.complaints).toEqual([]);
});

test("a reload keeps the sensor", async ({ lab, page }) => {
  await open(page);
  await put(page, pair());
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await source(page).selectOption("sensor");
  await depth(page).getByLabel("Sensor", { exact: true }).selectOption("Orbbec Astra");
  const numbers = depth(page).locator(".rig-camera-numbers");
  await expect(numbers).toContainText("fx 138.56");
  await expect(page.getByText("stay in this browser")).toHaveCount(1);
  const storedName = () =>
    page.evaluate(
      () =>
        new Promise<string>((resolve) => {
          const request = indexedDB.open("bimodal-stereo");
          request.onsuccess = () => {
            const state = request.result.transaction("rig").objectStore("rig").get("state");
            state.onsuccess = () => {
              request.result.close();
              resolve(state.result?.cameras.depth.sensor?.name ?? "");
            };
          };
        }),
    );
  await expect.poll(storedName).toBe("Orbbec Astra");
  await page.reload();
  await expect(numbers).toContainText("fx 138.56");
  await expect(depth(page).getByLabel("Sensor", { exact: true })).toHaveValue("Orbbec Astra");
  expect(lab.complaints).toEqual([]);
});
