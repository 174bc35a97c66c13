/** Check a rig: recordings are dropped, and a verdict comes out by clicking alone. They are made here, by the public writers. */

import { LONG, expect, test } from "./lab";
import type { Page } from "@playwright/test";
import { sampleRig } from "../../pkg/index.js";
import { driver, lz4Frame, mcap } from "../contract/recordings.mjs";
import { answerChecks } from "./rig";
import { open, put, run } from "./rigsteps";
import { atWidths, innerWidth, narrowest } from "./widths";

/** Rendered frames of one rig, that differ. */
async function rendered(count: number) {
  const frames = [];
  for (let frame = 0; frame < count; frame++) frames.push(await sampleRig({ kind: "boxes", seed: 2, frame }));
  const [first] = frames;
  if (!first) throw new Error("No frame was rendered.");
  return { frames, pose: first.pose };
}

const file = (name: string, buffer: Buffer) => ({ name, mimeType: "application/octet-stream", buffer });

const shot = async (page: Page, name: string) => {
  if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/${name}.png`, fullPage: true });
};

/** Drops files where a visitor would. */
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
  const { frames, pose } = await rendered(3);
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
