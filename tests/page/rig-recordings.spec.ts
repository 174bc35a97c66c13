/** Check a rig: from dropped recordings to a verdict, only by clicks. The recordings are made here with public writers. */

import { expect, test } from "./lab";
import { existsSync, readFileSync } from "node:fs";
import type { Page } from "@playwright/test";
import { smallFrames } from "../contract/recorded-messages.mjs";
import { driver, lz4Frame, mcap } from "../contract/recordings.mjs";
import { answerChecks } from "./rig";
import { open, put, run, step } from "./rigsteps";
import { atWidths, innerWidth, narrowest } from "./widths";

/** Different rendered frames of one rig, and its calibration. */
async function rendered() {
  const frames = await smallFrames();
  const [first] = frames;
  if (!first) throw new Error("No frame was rendered.");
  return { frames, pose: first.pose };
}
const bag = () => readFileSync(new URL("../fixtures/recordings/walk-lz4.bag", import.meta.url));

const file = (name: string, buffer: Buffer) => ({ name, mimeType: "application/octet-stream", buffer });

const shot = async (page: Page, name: string) => {
  if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/${name}.png`, fullPage: true });
};

/** Drops files as a visitor does. */
async function drop(page: Page, files: { name: string; buffer: Buffer }[]): Promise<void> {
  const transfer = await page.evaluateHandle(
    (all) => {
      const found = new DataTransfer();
      for (const { name, base64 } of all)
        found.items.add(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], name));
      return found;
    },
    files.map(({ name, buffer }) => ({ name, base64: buffer.toString("base64") })),
  );
  await page.locator(".rig-files-step .rig-drop").dispatchEvent("drop", { dataTransfer: transfer });
}

test("an MCAP that is dropped lists its topics, and ends in a verdict of its own transforms", async ({ lab, page }) => {
  const { frames, pose } = await rendered();
  const compressChunk = (data: Uint8Array) => ({ compression: "lz4", compressedData: lz4Frame(data) });
  const bytes = await mcap(driver(frames, pose, { compress: true }), { compressChunk });
  await open(page);
  await drop(page, [file("walk.mcap", bytes)]);
  const card = page.locator(".rig-recording");
  await expect(card.getByRole("heading", { name: "walk.mcap" })).toBeVisible();
  await expect(card.getByRole("row", { name: /^\/camera\/depth\/image_raw\/compressedDepth / })).toContainText("depth");
  await expect(card.getByRole("row", { name: /^\/chatter / })).toContainText("not used");
  await expect(card.getByRole("status")).toHaveText("3 frames taken");
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  for (const side of ["Colour", "Depth"])
    await expect(page.getByRole("group", { name: `${side} camera` }).locator(".rig-camera-numbers")).toHaveText(/^fx /);
  await shot(page, "files");
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Consistent");
  await expect(page.locator(".rig-calibrations")).toContainText("tf");
  await shot(page, "verdict");
  expect(lab.complaints).toEqual([]);
});

test("a bag of ROS 1 ends in a verdict; another topic takes other frames, and without it they go", async ({
  lab,
  page,
}) => {
  await open(page);
  await put(page, [file("walk.bag", bag())]);
  const card = page.locator(".rig-recording");
  await expect(card.getByRole("status")).toHaveText("3 frames taken");
  await card.getByLabel("Frames, at most").selectOption("5");
  await expect(card.getByRole("status")).toHaveText("3 frames taken");
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Consistent");
  await step(page, "Files and cameras").click();
  await page.getByRole("button", { name: "Remove the recording walk.bag" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(0);
  await page.getByRole("button", { name: "Undo removing walk.bag" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await step(page, "Your calibration").click();
  await expect(page.locator(".rig-candidate")).toHaveCount(1);
  expect(lab.complaints).toEqual([]);
});

test("what a recording lacks is said, its frames are none, and nothing sticks out", async ({ lab, page }) => {
  await answerChecks(page, "undecided");
  const { frames, pose } = await rendered();
  const messages = driver(frames, pose, { compress: true }).filter(({ topic }) => topic.startsWith("/camera/color"));
  await page.setViewportSize(narrowest);
  await open(page);
  await put(page, [file("colour.mcap", await mcap(messages)), file("walk.bag", bag())]);
  await expect(page.locator(".rig-recording").first().getByRole("alert")).toContainText(
    "has supported depth maps or organised clouds",
  );
  await expect(page.locator(".rig-recording").nth(1).getByRole("status")).toHaveText("3 frames taken");
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await atWidths(page, [320, 390, 1280, 2560], async (width) =>
    expect(await innerWidth(page), `at ${width} px`).toBeLessThanOrEqual(width),
  );
  expect(lab.complaints).toEqual([]);
});

/** A real recording, from the data beside the project: colour and depth of one moment, and the device's own calibration. */
const AZURE = new URL("../../../shared/data/azure_kinect_raw/recording.mkv", import.meta.url);

test("the recording of an Azure Kinect ends in a verdict of the calibration attached to it", async ({ lab, page }) => {
  test.skip(!existsSync(AZURE), "needs ../shared/data");
  await open(page);
  await put(page, [file("recording.mkv", readFileSync(AZURE))]);
  const card = page.locator(".rig-recording");
  await expect(card.getByRole("row", { name: /^DEPTH b16g 640x576/ })).toContainText("depth");
  await expect(card.getByRole("status")).toHaveText("1 frame taken");
  await shot(page, "mkv-files");
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText(/Consistent|Undecided, see warnings/);
  await shot(page, "mkv-verdict");
  expect(lab.complaints).toEqual([]);
});
