/** The report that the page saves has the words of the page, and its command repeats the check. */

import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { reportHtml } from "../../pkg/rig-report.js";
import { matrixFile, pair, reportOf } from "./rig";
import { openPair, put, run } from "./rigsteps";
import { atWidths, innerWidth } from "./widths";

/** A saved file as text. */
async function saved(page: Page, button: string): Promise<string> {
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: button }).click();
  return readFileSync(await (await download).path(), "utf8");
}

test("the report begins with the page's verdict, and its command gives the same numbers", async ({ lab, page }, {
  outputDir,
}) => {
  const told = matrixFile("it's told.txt", 0.025);
  await openPair(page);
  await put(page, [told]);
  await run(page);
  await expect(page.locator(".rig-word")).toBeVisible();
  const word = await page.locator(".rig-word").textContent();
  const sentence = await page.locator(".rig-verdict p").first().textContent();
  const report = await saved(page, "Save report (HTML)");
  const numbers = JSON.parse(await saved(page, "Save numbers (JSON)"));
  // The report has its own policy, not that of the page.
  await page.goto("about:blank");
  await page.setContent(report);
  await expect(page.getByRole("heading", { level: 1 })).toContainText(`${word}: expected reprojection error `);
  await expect(page.locator("main")).toContainText(sentence ?? "");
  await expect(page.locator("main")).toContainText(/Before, with the calibration in question: \S+/);
  const command = (await page.locator(".shell").textContent()) ?? "";
  expect(command).toContain(`--calibration 'it'\\''s told.txt'`);
  mkdirSync(outputDir, { recursive: true });
  for (const { name, buffer } of [...pair(), told]) writeFileSync(join(outputDir, name), buffer);
  const cli = join(process.cwd(), "pkg/cli.js");
  const npx = `npx() { shift; "${process.execPath}" "${cli}" "$@"; }`;
  const { stdout, stderr } = spawnSync("sh", ["-c", `${npx}\n${command} --json -`], {
    cwd: outputDir,
    encoding: "utf8",
  });
  const again = JSON.parse(stdout);
  expect(again.error, stderr).toBeUndefined();
  expect(again.verdict).toBe(numbers.verdict);
  expect(again.estimate).toEqual(numbers.estimate);
  expect(again.health).toEqual(numbers.health);
  expect(Object.values(again.candidates)).toEqual(Object.values(numbers.candidates));
  const hashes = (inputs: { sha256: string }[]) => inputs.map(({ sha256 }) => sha256);
  expect(hashes(again.inputs)).toEqual(expect.arrayContaining(hashes(numbers.inputs)));
  for (const hash of hashes(numbers.inputs)) expect(report).toContain(hash);
  expect(lab.complaints).toEqual([]);
});

test("no matrix covers the table of unknowns or is cut, on a screen or on A4", async ({ page }) => {
  const report = reportOf("off", ["given"], ["frame 1"]);
  const given = { ...report.estimate, translation: [-0.12345, 0.0123, 0.03] };
  await page.setContent(reportHtml(report, [], { calibrations: { given } }));
  /** Cells beyond the window, cells under a matrix, and matrices wider than their boxes. */
  const faults = () =>
    page.evaluate(() => {
      const all = (selector: string) =>
        [...document.querySelectorAll(selector)].filter((each) => each.checkVisibility());
      const matrices = all(".extrinsics pre");
      const cells = all(".unknowns :is(td, th)").map((each) => ({ each, box: each.getBoundingClientRect() }));
      const isUnder = (box: DOMRect) =>
        matrices
          .map((matrix) => matrix.getBoundingClientRect())
          .some((it) => box.right > it.left && box.left < it.right && box.bottom > it.top && box.top < it.bottom);
      return [
        ...cells.filter(({ box }) => box.right > window.innerWidth || isUnder(box)).map(({ each }) => each.textContent),
        ...matrices.filter((each) => each.scrollWidth > each.clientWidth).map(() => "a matrix is cut"),
      ];
    });
  await expect(page.locator(".extrinsics pre")).toHaveCount(2);
  await atWidths(page, [390, 768, 769, 800, 1024, 1280], async (width) => {
    expect(await faults(), `at ${width} px`).toEqual([]);
    expect(await innerWidth(page)).toBeLessThanOrEqual(width);
  });
  await page.emulateMedia({ media: "print" });
  // A4 without its margins of 8 mm, at 96 px to the inch.
  await atWidths(page, [733], async () => expect(await faults(), "on A4").toEqual([]));
});

test("a check waits for files that are still being read, because one may be its calibration", async ({ lab, page }) => {
  await openPair(page);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  const isDisabled = await page.locator("#rig").evaluate(async (rig, text) => {
    const field = rig.querySelector<HTMLInputElement>("input[type=file]:not([webkitdirectory])");
    const files = new DataTransfer();
    files.items.add(new File([text], "told.txt"));
    if (field) field.files = files.files;
    field?.dispatchEvent(new Event("change"));
    // The page shows a change in a microtask.
    await Promise.resolve();
    return [...rig.querySelectorAll("button")].find(({ textContent }) => textContent === "Estimate a calibration")
      ?.disabled;
  }, matrixFile("told.txt", 0.025).buffer.toString());
  expect(isDisabled).toBe(true);
  await expect(page.getByRole("button", { name: "Run the check" })).toBeEnabled();
  expect(lab.complaints).toEqual([]);
});
