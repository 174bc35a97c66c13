/** A run is saved as a file, dropped on another visit, and continued where it stopped. */

import { expect, test } from "./lab";
import { colourPng, depthPng, drop } from "./uploads";

test("a run that was taken away goes on where it stood, with the options that it had", async ({ lab, page }) => {
  await lab.open("size=32&prior=2&iterations=5");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("2");
  const pose = await page.locator("#pose").innerText();
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save run to resume later" }).click();
  const download = await waiting;
  expect(download.suggestedFilename()).toBe("run.bimodal");
  await expect(page.locator("#taken")).toContainText("drop it on this page to resume from here");
  const chunks: Buffer[] = [];
  for await (const chunk of await download.createReadStream()) chunks.push(Buffer.from(chunk as Uint8Array));
  const run = { name: "evening.bimodal", mimeType: "application/octet-stream", buffer: Buffer.concat(chunks) };

  // Another visit, without any state of the first.
  await page.goto("about:blank");
  await lab.visit("size=64");
  await drop(page, "body", [run]);
  await expect(lab.iteration).toHaveText("2");
  await lab.unfold();
  await expect(page.locator("#fields-weights").getByLabel("λ shape prior", { exact: true }).first()).toHaveValue("2");
  await expect(page.locator(".remarks")).toContainText("evening.bimodal: a saved run");
  // The file omits a sample's truth and contains the pose found.
  const found = (text: string) => text.split("\n").map((line) => line.split("\t").slice(0, 2).join(" "));
  expect(found(await page.locator("#pose").innerText())).toEqual(found(pose));
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("3");

  // Reset restarts the same pair with the same options.
  await page.getByRole("button", { name: "Reset" }).click();
  await expect(lab.iteration).toHaveText("0");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");

  // A pair of files replaces the run.
  await drop(page, "body", [colourPng(), depthPng()]);
  await lab.reaches("ready");
  await expect(lab.iteration).toHaveText("0");
  await expect(page.locator(".remarks")).not.toContainText("a saved run");
});

test("one that is damaged is refused, and says why", async ({ lab, page }) => {
  await lab.open("size=32");
  await drop(page, "body", [
    {
      name: "broken.bimodal",
      mimeType: "application/octet-stream",
      buffer: Buffer.from("bimodal-stereo\n\x01and nothing of ours"),
    },
  ]);
  await lab.reaches("error");
  await expect(page.locator("#alert")).toContainText("state: is damaged or cut off");
  await page.getByRole("button", { name: "Sample" }).click();
  await lab.reaches("ready");
});
