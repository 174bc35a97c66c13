/** Opens Check a rig and goes through its steps as a visitor does. */

import { type Page, expect } from "@playwright/test";
import { giveFiles, matrixFile, pair } from "./rig";

export const step = (page: Page, name: string) =>
  page.getByRole("navigation", { name: "Steps" }).getByRole("button", { name });

export const heading = (page: Page, name: string) => page.getByRole("heading", { level: 2, name });

export async function open(page: Page): Promise<void> {
  await page.goto("./#rig");
  await expect(page.getByText("Drop files or a folder here")).toBeVisible();
}

export async function openExample(page: Page): Promise<void> {
  await open(page);
  await page.getByRole("button", { name: "Load an example" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
}

export const put = (page: Page, files: Parameters<ReturnType<Page["locator"]>["setInputFiles"]>[0]) =>
  page.locator("#rig input[type=file]:not([webkitdirectory])").first().setInputFiles(files);

/** Opens a pair, with the depth camera by its field of view. */
export async function openPair(page: Page): Promise<void> {
  await open(page);
  await giveFiles(page, pair());
}

/** Opens as much as the example has, three frames and two calibrations, without rendering it, which takes seconds. */
export async function openFrames(page: Page): Promise<void> {
  await open(page);
  await giveFiles(
    page,
    [...["0001", "0002", "0003"].flatMap(pair), matrixFile("given.txt", 0.025), matrixFile("other.txt", 0.05)],
    3,
  );
}

export async function run(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await page.getByRole("button", { name: /^(Run the check|Estimate a calibration)$/ }).click();
}
