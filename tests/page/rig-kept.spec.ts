/** A rig over a reload: files, cameras, masks, calibrations and verdict come back, until the visitor starts over. */

import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { answerChecks } from "./rig";
import { heading, open, openFrames, openPair, run, step } from "./rigsteps";

const keeping = (page: Page) => page.locator(".rig-files-step").getByText("stay in this browser");
const kept = (page: Page) => expect(keeping(page)).toHaveCount(1);

/** What the database holds; `version` makes it the record of another version of the page. */
const stored = (page: Page, version = "") =>
  page.evaluate(
    (version) =>
      new Promise<{ count: number; hasVerdict: boolean }>((resolve) => {
        const request = indexedDB.open("bimodal-stereo");
        request.onsuccess = () => {
          const transaction = request.result.transaction("rig", "readwrite");
          const store = transaction.objectStore("rig");
          const [count, state] = [store.count(), store.get("state")];
          state.onsuccess = () => version && store.put({ ...state.result, version }, "state");
          transaction.oncomplete = () => {
            request.result.close();
            resolve({ count: count.result, hasVerdict: state.result?.lists.run !== undefined });
          };
        };
      }),
    version,
  );

test("a reload keeps files, cameras, masks, calibrations and the verdict with its pictures", async ({ lab, page }) => {
  await answerChecks(page, "off");
  await openFrames(page);
  await page.getByRole("button", { name: "Restrict what is used" }).first().click();
  const dialog = page.getByRole("dialog");
  await dialog.getByText("Rectangle by numbers").click();
  for (const label of ["left, px", "top, px"]) await dialog.getByLabel(label).fill("0");
  await dialog.getByLabel("width, px").fill("160");
  await dialog.getByLabel("height, px").fill("30");
  await dialog.getByRole("button", { name: "Apply" }).click();
  await dialog.getByRole("button", { name: "Done" }).click();
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Off, see warnings");
  // The verdict is stored after the files.
  await expect.poll(async () => (await stored(page)).hasVerdict).toBe(true);
  const verdict = await page.locator(".rig-verdict-box").innerText();

  await page.reload();
  await expect(heading(page, "3. Verdict")).toBeVisible();
  expect(await page.locator(".rig-verdict-box").innerText()).toBe(verdict);
  await expect(page.locator(".rig-stale")).toBeHidden();
  await expect(page.locator(".rig-overlay-layer")).toHaveAttribute("aria-label", /frame 1|0001/);
  await step(page, "Your calibration").click();
  await expect(page.locator(".rig-candidate")).toHaveCount(2);
  await step(page, "Files and cameras").click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await expect(page.locator(".rig-frame").first()).toContainText("used: 25 % of the image, as drawn");
  await expect(page.getByLabel("Horizontal field of view, °").last()).toHaveValue("60");
  // The files themselves are restored, so that each can be read again in another unit.
  await page.getByText("Files", { exact: true }).click();
  await page.locator(".rig-file").nth(1).getByLabel("Unit").selectOption("1");
  await expect(page.locator(".rig-file").nth(1)).toContainText("metres");
  expect(lab.complaints).toEqual([]);
});

test("another tab offers the rig, and what is brought back there works", async ({ page, context }) => {
  await openPair(page);
  await kept(page);
  const other = await context.newPage();
  await open(other);
  await expect(other.locator(".rig-frame")).toHaveCount(0);
  await other.getByRole("button", { name: "Restore the last rig (2 files)" }).click();
  await expect(other.locator(".rig-frame")).toHaveCount(1);
  await expect(other.getByRole("button", { name: "Next: your calibration" })).toBeEnabled();
  await expect(other.getByRole("button", { name: /Restore the last rig/ })).toBeHidden();
});

test("starting over removes what was kept, and undone it is kept again", async ({ page }) => {
  await openPair(page);
  await kept(page);
  expect((await stored(page)).count).toBeGreaterThan(2);
  await page.getByRole("button", { name: "Start over" }).click();
  await expect.poll(async () => (await stored(page)).count).toBe(0);
  await page.getByRole("button", { name: "Undo starting over" }).click();
  await kept(page);
  await page.reload();
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await page.getByRole("button", { name: "Start over" }).click();
  await expect.poll(async () => (await stored(page)).count).toBe(0);
  await page.reload();
  await expect(page.getByText("Drop files or a folder here")).toBeVisible();
  await expect(page.locator(".rig-frame")).toHaveCount(0);
  await expect(page.getByRole("button", { name: /Restore the last rig/ })).toBeHidden();
});

test("another version of the page reads the files again", async ({ page }) => {
  await openPair(page);
  await kept(page);
  await stored(page, "an older one");
  await page.reload();
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await expect(page.locator(".rig-frame")).toContainText("Colour 160×120 px, depth 160×120 px");
});

test("a browser whose storage is full says so, and the files work", async ({ page, baseURL }) => {
  await open(page);
  const session = await page.context().newCDPSession(page);
  await session.send("Storage.overrideQuotaForOrigin", { origin: new URL(baseURL ?? "").origin, quotaSize: 1 });
  await openPair(page);
  await expect(page.locator(".rig-files-step").getByText("its storage is full")).toBeVisible();
  await expect(page.locator(".rig-frame")).toHaveCount(1);
});
