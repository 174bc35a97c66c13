/** The visitor's own files after a reload, without storage, and never next to another pair's pictures. */

import { LONG, expect, test } from "./lab";
import { own, put, slot } from "./ownfiles";
import { colourPng, depthPng, drop, maskPng } from "./uploads";

test("nothing of another pair stays: no picture, no true value, nothing to save", async ({ lab, page }) => {
  await lab.open("size=32");
  await expect(page.locator("#pose-error")).toBeVisible();
  await lab.unfold();
  await page.getByRole("button", { name: "Own files" }).click();
  const gone = async () => {
    for (const name of ["Colour", "Given depth", "Normals", "Refined depth"])
      await expect(page.locator(`canvas[aria-label^="${name}:"]`)).toBeHidden();
    for (const box of [
      "#clouds-canvas",
      "#pose tbody tr >> nth=0",
      "#pose-error",
      "#light canvas >> nth=0",
      "#takeaway button >> nth=0",
    ])
      await expect(page.locator(box)).toBeHidden();
  };
  await gone();
  await put(lab, "Colour image", colourPng());
  await expect(page.getByRole("img", { name: "Preview of a.png" })).toBeVisible();
  await gone();
  await put(lab, "Depth map", depthPng());
  await lab.reaches("ready");
  await expect(page.locator('canvas[aria-label^="Colour:"]')).toBeVisible();
  await expect(page.locator("#pose-error")).toBeHidden();
  await expect(page.locator("#pose tbody tr").first().locator("td").nth(1)).toBeEmpty();
  // An unreadable picture replaces the previous one completely.
  await put(lab, "Colour image", { ...colourPng("cut.png"), buffer: colourPng().buffer.subarray(0, 90) });
  await lab.reaches("error");
  await gone();
  await page.getByRole("button", { name: "Sample", exact: true }).click();
  await lab.reaches("ready");
  await expect(page.locator("#pose-error")).toBeVisible();
  await expect(page.locator('canvas[aria-label^="Colour:"]')).toBeVisible();
});

test("a reload keeps the files, until they are forgotten; a link alone does not show them", async ({
  lab,
  page,
  context,
}) => {
  await own(lab);
  await put(lab, "Colour image", colourPng("mine.png"));
  await put(lab, "Depth map", depthPng("deep.png"));
  await lab.reaches("ready");
  await expect(page.locator(".keeping")).toContainText("stay in this browser");
  const shown = await lab.fingerprint("Colour");
  await page.reload();
  await lab.reaches("ready");
  await expect(slot(lab, 0)).toContainText("mine.png");
  expect(await lab.fingerprint("Colour")).toBe(shown);
  await expect(page.locator("#pose-error")).toBeHidden();

  const other = await context.newPage();
  await other.goto(page.url());
  await expect(other.locator("#status")).toHaveAttribute("data-state", "ready");
  await expect(other.locator("#pose-error")).toBeVisible();
  await expect(other.locator("#origin-sample")).toHaveAttribute("aria-pressed", "true");
  await other.close();

  await lab.unfold();
  await page.getByRole("button", { name: "Remove my files" }).click();
  await lab.reaches("waiting");
  await expect(page.locator(".keeping")).toContainText("No files are stored");
  await expect(slot(lab, 0)).not.toContainText("mine.png");
  await page.reload();
  await lab.reaches("waiting");
  expect(
    await page.evaluate(
      () =>
        new Promise((resolve) => {
          const request = indexedDB.open("bimodal-stereo");
          request.onsuccess = () => {
            const all = request.result.transaction("own-files").objectStore("own-files").count();
            all.onsuccess = () => resolve(all.result);
          };
        }),
    ),
  ).toBe(0);
});

test(
  "a pair that comes whole leaves no mask of the last, and files of last time come back for nobody who brings others",
  LONG,
  async ({ lab, page }) => {
    await lab.open("size=32");
    await drop(page, "body", [colourPng("one.png"), depthPng("two.png"), maskPng("three.png")]);
    await expect(slot(lab, 2)).toContainText("three.png");
    await lab.reaches("ready");
    await drop(page, "#hero", [depthPng("five.png"), colourPng("four.png", 9)]);
    await expect(slot(lab, 0)).toContainText("four.png");
    await expect(slot(lab, 1)).toContainText("five.png");
    await expect(slot(lab, 2)).not.toContainText("three.png");
    await lab.reaches("ready");
    await expect(page.locator(".keeping")).toContainText("stay in this browser");
    await page.getByRole("button", { name: "Sample", exact: true }).click();
    await lab.reaches("ready");
    await page.reload();
    await lab.reaches("ready");
    await drop(page, "body", [maskPng("six.png")]);
    await expect(slot(lab, 2)).toContainText("six.png");
    await lab.reaches("waiting");
    await expect(slot(lab, 0)).not.toContainText("four.png");
  },
);

test("where storage is full, older files do not come back in the place of those that could not be kept", async ({
  lab,
  page,
}) => {
  await own(lab);
  await put(lab, "Colour image", colourPng("old.png"));
  await put(lab, "Depth map", depthPng("old-depth.png"));
  await expect(page.locator(".keeping")).toContainText("stay in this browser");
  await page.evaluate(() => {
    IDBObjectStore.prototype.put = () => {
      throw new DOMException("no", "QuotaExceededError");
    };
  });
  await put(lab, "Colour image", colourPng("new.png", 20));
  await expect(page.locator(".keeping")).toContainText("its storage is full");
  await page.reload();
  await lab.reaches("waiting");
  await expect(slot(lab, 0)).not.toContainText("old.png");
});

for (const [name, words] of [
  ["QuotaExceededError", "its storage is full"],
  ["SecurityError", "it does not let this page store files"],
] as const) {
  test(`files work where they can't be kept: ${name}`, async ({ lab, page }) => {
    await page.addInitScript((name) => {
      IDBFactory.prototype.open = () => {
        throw new DOMException("no", name);
      };
    }, name);
    await own(lab);
    await put(lab, "Colour image", colourPng());
    await put(lab, "Depth map", depthPng());
    await lab.reaches("ready");
    await expect(page.locator(".keeping")).toContainText(words);
    await page.getByRole("button", { name: "Remove my files" }).click();
    await lab.reaches("waiting");
    await expect(page.locator(".keeping")).toContainText("storage does not respond");
  });
}
