/** Hostile files, and a whole visit under the page's policy: no content of a file becomes part of the page, and the page requests only its own files. */

import { readFileSync } from "node:fs";
import type { Download, Page } from "@playwright/test";
import { harmless } from "../contract/harmless.mjs";
import { EVIL, EVIL_TEXT, expectHarmless, pictures, texts } from "./hostile";
import { LONG, expect, test, type Lab } from "./lab";
import { answerChecks, giveFiles, pair } from "./rig";
import { drop } from "./uploads";
import { refusals, requests } from "./visit";

const read = async (download: Promise<Download>): Promise<string> =>
  readFileSync(await (await download).path(), "utf8");

/** Checks that a report is complete and contains nothing that could run, and that a browser runs nothing when opening it. */
async function opens(page: Page, html: string): Promise<void> {
  expect(harmless(html).text).toContain("&lt;img src=x onerror=");
  await page.route("**/taken.html", (route) => route.fulfill({ contentType: "text/html", body: html }));
  await page.goto("taken.html");
  await expectHarmless(page);
}

test("hostile files stay text in the Lab, in what it takes away, and in its report", async ({ lab, page }) => {
  const refused = await refusals(page);
  await lab.open("size=32");
  await drop(page, "body", [...pictures(), ...texts()]);
  await lab.reaches("ready");
  await expect(page.locator(".slot").first()).toContainText(`${EVIL}colour.png`);
  await expect(page.locator(".remarks")).toContainText(`${EVIL}a.txt`);
  await page.keyboard.press("s");
  await expectHarmless(page);
  // A reload restores them from the browser's storage.
  await expect(page.locator(".keeping")).toContainText("stay in this browser");
  await page.reload();
  await lab.reaches("ready");
  await expect(page.locator(".slot").first()).toContainText(`${EVIL}colour.png`);
  await expectHarmless(page);
  const report = read(page.waitForEvent("download"));
  await page.locator("#takeaway button[value=report]").click();
  const html = await report;
  expect(refused).toEqual([]);
  await opens(page, html);
});

test("a hostile link stays text: settings, lessons, tables and steps that no one made", async ({ lab, page }) => {
  const evil = encodeURIComponent(EVIL_TEXT);
  for (const address of [
    `surface=${evil}&light=${evil}&size=${evil}&colour.distortion=${evil}&${evil}=${evil}`,
    `learn&at=${evil}&beta=${evil}&embed`,
    `tables&show=${evil}&light=${evil}`,
    `rig&step=${evil}`,
    evil,
  ]) {
    await page.goto("about:blank");
    await page.goto(`./#${address}`);
    await expect(page.locator("main:visible")).not.toBeEmpty();
    await expectHarmless(page);
  }
  expect(lab.complaints).toEqual([]);
});

test("hostile files stay text in Check a rig, and in its report", async ({ lab, page }) => {
  await answerChecks(page, "off");
  const refused = await refusals(page);
  await page.goto("./#rig");
  await giveFiles(page, [...pictures(), ...texts()]);
  await expect(page.locator("#rig")).toContainText(`${EVIL}a.txt`);
  await expectHarmless(page);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await expectHarmless(page);
  await page.getByRole("button", { name: /^(Run the check|Estimate a calibration)$/ }).click();
  await expect(page.locator(".rig-bar").first()).toBeVisible();
  await expectHarmless(page);
  const report = read(page.waitForEvent("download"));
  await page.getByRole("button", { name: "Save report (HTML)" }).click();
  const html = await report;
  expect(refused).toEqual([]);
  expect(lab.complaints).toEqual([]);
  await opens(page, html);
});

async function visitLab(lab: Lab, page: Page): Promise<void> {
  await page.goto("./#size=48&play");
  await expect(page.locator("#status")).toHaveAttribute("data-state", /converged|ambiguous|lost|max-iterations/);
  await expect(page.locator("#objective-chart canvas")).toBeVisible();
  for (const value of ["pose", "light", "clouds", "depthPng", "normals", "picture", "report"]) {
    const download = page.waitForEvent("download");
    await page.locator(`#takeaway button[value=${value}]`).click();
    await download;
  }
  await lab.unfold();
  await page.getByRole("button", { name: "Close settings" }).click();
  await page.locator("#stages button").first().click();
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Help" }).click();
  await page.getByRole("button", { name: "Close" }).click();
  await drop(page, "body", pictures());
  await lab.reaches("ready");
  await page.getByRole("button", { name: "Close settings" }).click();
}

async function visitLearn(page: Page): Promise<void> {
  await page.getByRole("link", { name: "Learn", exact: true }).click();
  const figure = page.locator(".learn-figure");
  await expect(figure).toHaveAttribute("aria-busy", "false");
  const links = page.locator(".learn-contents a[data-to]");
  for (const link of (await links.all()).slice(0, -1)) {
    await link.click();
    await expect(figure).toHaveAttribute("aria-busy", "false");
  }
  await page.getByRole("button", { name: "Slides" }).click();
  await page.keyboard.press("Escape");
  await links.last().click();
  await expect(page.locator(".learn-exercises")).toBeVisible();
}

async function visitTables(page: Page): Promise<void> {
  await page.getByRole("link", { name: "Tables", exact: true }).click();
  for (const tab of await page.locator("#tables .tab").all()) await tab.click();
  await page.locator("#tables .tab").first().click();
  await page.locator("#tables .heat-cell").first().click();
  await expect(page.locator("#tables .heat-cell[data-value]").first()).toBeVisible();
}

async function visitRig(page: Page): Promise<void> {
  await page.getByRole("link", { name: "Check a rig" }).click();
  await giveFiles(page, pair());
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await page.getByRole("button", { name: /^(Run the check|Estimate a calibration)$/ }).click();
  await expect(page.locator(".rig-bar").first()).toBeVisible();
}

test(
  "a whole visit asks for nothing but the page's own files, and its policy refuses nothing of it",
  LONG,
  async ({ lab, page, context, baseURL }) => {
    const refused = await refusals(page);
    const asked = requests(context);
    await answerChecks(page, "consistent");
    await visitLab(lab, page);
    await visitLearn(page);
    await visitTables(page);
    await visitRig(page);
    expect(asked.length).toBeGreaterThan(20);
    expect(asked.filter((address) => !address.startsWith(baseURL ?? "?"))).toEqual([]);
    expect(refused).toEqual([]);
    expect(lab.complaints).toEqual([]);
  },
);
