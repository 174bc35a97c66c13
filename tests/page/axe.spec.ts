/** axe-core finds no violations on any screen, in dark and in light colours. */

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import type { Page } from "@playwright/test";
import type { Pose } from "../../pkg/index.js";
import { bridge } from "../contract/bridge.mjs";
import { smallFrames } from "../contract/recorded-messages.mjs";
import { driver } from "../contract/recordings.mjs";
import { LESSONS } from "./figure";
import { LONG, expect, test, type Lab } from "./lab";
import { LANGUAGES } from "./language";
import { Messages } from "./messages";
import { answerChecks } from "./rig";
import { cameraJson, depthPng, drop, roomPng } from "./uploads";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

const IDENTITY: Pose = {
  scale: 1,
  rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  translation: [0, 0, 0],
  angles: { alpha: 0, beta: 0, gamma: 0 },
  matrix: [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [0, 0, 1, 0],
    [0, 0, 0, 1],
  ],
};

interface Axe {
  run(
    context: Document,
  ): Promise<{ violations: { id: string; help: string; nodes: { target: string[]; failureSummary: string }[] }[] }>;
}

/** Violations of all rules, including best practices, with their places. */
async function findings(page: Page): Promise<string[]> {
  // Runs through the browser's own protocol, because the page's policy forbids eval.
  await page.evaluate(AXE);
  return page.evaluate(async () => {
    const { violations } = await (window as unknown as { axe: Axe }).axe.run(document);
    return violations.flatMap(({ id, nodes }) =>
      nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")}: ${failureSummary.replace(/\s+/g, " ")}`),
    );
  });
}

const ENDS = /^(converged|ambiguous|lost|max-iterations)$/;

/** Checks one screen in both colour schemes, because opening a screen takes longer than the check. Findings do not end the test. */
async function clean(page: Page, screen: string): Promise<void> {
  for (const colorScheme of ["dark", "light"] as const) {
    await page.emulateMedia({ colorScheme });
    expect.soft(await findings(page), `${screen}, ${colorScheme}`).toEqual([]);
  }
}

async function lab(lab: Lab, page: Page): Promise<void> {
  const messages = await Messages.of(page);
  await lab.visit("size=64");
  await expect(page.locator("#clouds-note")).toBeHidden();
  await expect(page.locator("#objective-chart canvas")).toBeVisible();
  await clean(page, "before a run");
  await page.getByRole("button", { name: "Play" }).click();
  await expect(lab.iteration).not.toHaveText("0");
  // Keeps the run going during the check.
  await messages.hold("advance");
  await clean(page, "while it runs");
  await messages.release();
  await expect(page.locator("#status")).toHaveAttribute("data-state", ENDS);
  await clean(page, "after a run");
  await lab.unfold();
  for (const summary of await page.locator("#input details > summary").all())
    if (await summary.isVisible()) await summary.click();
  await clean(page, "settings");
  const hint = page.locator("#fields-method .hint:visible").first();
  await hint.click();
  await expect(hint).toHaveAttribute("aria-expanded", "true");
  await clean(page, "a field explained");
  await page.getByRole("button", { name: "Own files" }).click();
  await clean(page, "own files");
  await drop(page, "body", [roomPng(), depthPng(), cameraJson()]);
  await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
  await clean(page, "own files with remarks");
  await page.getByRole("button", { name: "Draw a mask" }).click();
  await expect(page.getByRole("dialog")).toBeVisible();
  await clean(page, "drawing a mask");
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Sample", exact: true }).click();
  await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
  await page.getByRole("button", { name: "Close settings" }).click();
  await page.locator("#stages button").first().click();
  await expect(page.locator("#explanation")).toBeVisible();
  await clean(page, "a stage explained");
  await page.keyboard.press("Escape");
  await page.locator("#help-button").click();
  await clean(page, "help");
}

async function poseLost(lab: Lab, page: Page): Promise<void> {
  await lab.visit("light=overcast&size=32&noise=0.2&beta=60&overlap=0.2");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("lost");
  await clean(page, "a pose that is lost");
}

const settled = (page: Page) => expect(page.locator(".learn-figure")).toHaveAttribute("aria-busy", "false");

async function learn(page: Page): Promise<void> {
  await page.goto("./#learn");
  await settled(page);
  const links = await page
    .locator(".learn-contents a[data-to]")
    .evaluateAll((all) => all.map((link) => link.getAttribute("href") ?? ""));
  expect(links).toHaveLength(LESSONS.length + 1);
  for (const link of links) {
    await page.goto(`./${link}`);
    if (!link.endsWith("exercises")) await settled(page);
    else await expect(page.locator(".learn-exercises")).toBeVisible();
    await clean(page, link);
  }
  await page.goto("./#learn&at=pose&slides");
  await settled(page);
  await clean(page, "slides");
  await page.keyboard.press("q");
  await settled(page);
  await clean(page, "a question on a slide");
  await page.locator(".learn-count").click();
  await clean(page, "the list of slides");
}

async function tables(page: Page): Promise<void> {
  await page.goto("./#tables");
  await expect(page.getByRole("heading", { name: "Table 1" }).first()).toBeVisible();
  await clean(page, "before anything has run");
  await page.locator(".heat-cell").first().click();
  await expect(page.locator("#tables .heat-cell[data-value]").first()).toBeVisible();
  await clean(page, "one cell");
}

async function rig(page: Page): Promise<void> {
  await answerChecks(page, "off");
  await page.goto("./#rig");
  await clean(page, "files, none yet");
  await page.getByRole("button", { name: "Load an example" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await clean(page, "files");
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await clean(page, "calibrations");
  await page.getByRole("button", { name: "Run the check" }).click();
  await expect(page.locator(".rig-bar").first()).toBeVisible();
  await clean(page, "verdict");
}

async function recordings(page: Page): Promise<void> {
  const robot = await bridge([driver(await smallFrames(), IDENTITY, { compress: true })]);
  try {
    await page.goto("./#rig");
    await page
      .locator("#rig input[type=file]:not([webkitdirectory])")
      .first()
      .setInputFiles(fileURLToPath(new URL("../fixtures/recordings/walk-lz4.bag", import.meta.url)));
    await expect(page.locator(".rig-recording").getByRole("status")).toHaveText("3 frames taken");
    await clean(page, "a recording");
    await page.getByText("Connect to a robot").click();
    await page.getByLabel("Address of the bridge").fill(robot.address);
    await page.getByRole("button", { name: "Connect" }).click();
    await expect(page.locator(".rig-live").getByLabel("Depth of")).toBeVisible();
    await clean(page, "a robot");
  } finally {
    await robot.close();
  }
}

async function rivals(lab: Lab, page: Page): Promise<void> {
  await lab.visit("surface=vase&light=window&beta=30&size=64&noise=0.08");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("ambiguous");
  await clean(page, "a pose with a rival");
}

test.use({ contextOptions: { reducedMotion: "reduce" } });
test("the Lab before, while and after a run, with its settings and help", LONG, ({ lab: opened, page }) =>
  lab(opened, page),
);
test("a Lab whose pose is lost", ({ lab: opened, page }) => poseLost(opened, page));
test("a Lab whose pose has a rival", LONG, ({ lab: opened, page }) => rivals(opened, page));
for (const locale of ["en-US", ...LANGUAGES])
  test.describe(() => {
    test.use({ locale });
    test(`every lesson, the exercises and a slide, ${locale}`, LONG, ({ page }) => learn(page));
  });
test("the Tables, and a cell of theirs", LONG, ({ page }) => tables(page));
test("the three steps of Check a rig", LONG, ({ page }) => rig(page));
test("a recording and a robot in Check a rig", LONG, ({ page }) => recordings(page));
