/** The short path for own files: four steps that hold the same files as the settings. */

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { Page } from "@playwright/test";
import { closeSilently, reportEnd } from "./closing";
import { LONG, expect, test } from "./lab";
import { slot } from "./ownfiles";
import { cameraJson, colourPng, depthPng, drop, maskPng, roomPng } from "./uploads";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

const path = (page: Page) => page.getByRole("dialog", { name: "Your own pictures" });
const step = (page: Page, name: string) => path(page).getByRole("button", { name: new RegExp(`^\\d ${name}`) });
const press = (page: Page, name: string) => path(page).getByRole("button", { name, exact: true }).click();

async function openPath(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Your own pictures" }).click();
  await expect(path(page)).toBeVisible();
}

test("files dropped onto it fill all steps, each with its thumbnail, and Run plays them", async ({ lab, page }) => {
  await lab.open("size=32");
  await openPath(page);
  await expect(step(page, "Picture")).toHaveAttribute("aria-current", "step");
  await expect(step(page, "Picture")).toContainText("open");
  await drop(page, "dialog.first-run", [colourPng("a.png"), depthPng("b.png"), maskPng("c.png"), cameraJson("k.json")]);
  for (const name of ["Picture", "Depth", "Masks"]) {
    await expect(step(page, name)).toContainText("there");
    await expect(step(page, name).locator("canvas")).toBeVisible();
  }
  await press(page, "Next");
  await expect(path(page).getByText("b.png")).toBeVisible();
  await expect(path(page).locator(".range")).toContainText(/Stored numbers 100 to \d+, which is 0\.1 to .* m\./);
  await path(page).getByRole("spinbutton", { name: "Unit" }).fill("0.002");
  await page.keyboard.press("Tab");
  await expect(path(page).locator(".range")).toContainText("which is 0.2 to");
  await press(page, "Next");
  await press(page, "Next");
  await expect(step(page, "Go")).toContainText("ready");
  await expect(path(page).locator(".expect")).toContainText("49 converge");
  await expect(path(page).locator(".expect")).toContainText("The depth map has no mask");
  await expect(path(page).locator(".expect")).toContainText("Both cameras are known");
  await press(page, "Run");
  await expect(path(page)).toBeHidden();
  await expect(lab.iteration).not.toHaveText("0");
});

test("it keeps its parts if it is opened again before the browser reports its end", async ({ lab, page }) => {
  await lab.open("size=32");
  await openPath(page);
  const dialog = page.locator("dialog.first-run");
  await expect(dialog.getByText("Colour image")).toBeVisible();
  await closeSilently(dialog);
  await openPath(page);
  await reportEnd(dialog);
  await expect(dialog.getByText("Colour image")).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(path(page)).toBeHidden();
  await lab.unfold();
  await expect(slot(lab, 0)).toContainText("Colour image");
});

test("it can be left and resumed, and what was given in the slots is there", async ({ lab, page }) => {
  await lab.open("size=32");
  await openPath(page);
  await page.getByLabel("Colour image", { exact: true }).setInputFiles(colourPng());
  await expect(step(page, "Picture")).toContainText("there");
  await page.keyboard.press("Escape");
  await expect(path(page)).toBeHidden();
  // The settings have their parts again, in their order.
  await lab.unfold();
  await expect(slot(lab, 0)).toContainText("a.png");
  await expect(page.locator(".slot strong")).toHaveText(["Colour image", "Depth map", "Colour mask", "Depth mask"]);
  await page.getByLabel("Depth map", { exact: true }).setInputFiles(depthPng());
  await lab.reaches("ready");
  await openPath(page);
  await expect(step(page, "Masks")).toHaveAttribute("aria-current", "step");
  await expect(step(page, "Depth")).toContainText("there");
});

test("a mask is drawn by the silhouette that the page finds, and can be undone", async ({ lab, page }) => {
  await lab.open("size=32");
  await openPath(page);
  await drop(page, "dialog.first-run", [roomPng(), depthPng()]);
  await expect(step(page, "Depth")).toContainText("there");
  await step(page, "Masks").click();
  await press(page, "Draw on the picture");
  const tool = page.getByRole("dialog", { name: /The object in room/ });
  await expect(tool).toBeVisible();
  await tool.getByRole("button", { name: "Find the silhouette" }).click();
  await expect(tool.getByText(/Draw a rectangle around the object/)).toBeVisible();
  const board = await tool.locator(".rig-mask-layer").boundingBox();
  if (!board) throw new Error("the picture is seen");
  const at = (share: number) => [board.x + share * board.width, board.y + share * board.height] as const;
  await page.mouse.move(...at(0.03));
  await page.mouse.down();
  await page.mouse.move(...at(0.97), { steps: 4 });
  await page.mouse.up();
  const share = tool.getByText(/% of the image is used/);
  const drawn = await share.textContent();
  await tool.getByRole("button", { name: "Find the silhouette" }).click();
  await expect(tool.getByText("Draw over what is wrong")).toBeVisible();
  await expect(share).not.toHaveText(drawn ?? "");
  await tool.getByRole("button", { name: "Undo stroke" }).click();
  await expect(share).toHaveText(drawn ?? "");
  await tool.getByRole("button", { name: "Done" }).click();
  await expect(step(page, "Masks")).toContainText("there");
  await press(page, "Undo mask");
  await expect(step(page, "Masks")).toContainText("optional");
  await expect(path(page).getByRole("button", { name: "Undo mask" })).toBeDisabled();
});

test("a range of depths becomes the mask of the depth map", async ({ lab, page }) => {
  await lab.open("size=32");
  await openPath(page);
  await drop(page, "dialog.first-run", [colourPng(), depthPng()]);
  await expect(step(page, "Depth")).toContainText("there");
  await step(page, "Masks").click();
  await press(page, "Draw on the depth map, or restrict its depths");
  const tool = page.getByRole("dialog", { name: /The object in b/ });
  await tool.getByLabel("Farthest depth, m").fill("0.2");
  await tool.getByRole("button", { name: "Done" }).click();
  await expect(path(page).getByText(/mask of b\.png/)).toBeVisible();
  await expect(path(page).getByText(/a mask of (?!0 )\d+/)).toBeVisible();
});

test("by keyboard alone: from the button to the run", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.getByRole("button", { name: "Your own pictures" }).focus();
  await page.keyboard.press("Enter");
  await expect(path(page)).toBeVisible();
  await page.getByLabel("Colour image", { exact: true }).setInputFiles(colourPng());
  for (const _ of [1, 2, 3]) {
    await path(page).getByRole("button", { name: /^Next/ }).focus();
    await page.keyboard.press("Enter");
  }
  await expect(path(page).getByRole("button", { name: "Run" })).toBeDisabled();
  await expect(path(page)).toContainText("Still needs a depth map.");
  await step(page, "Depth").focus();
  await page.keyboard.press("Enter");
  await page.getByLabel("Depth map", { exact: true }).setInputFiles(depthPng());
  await step(page, "Go").focus();
  await page.keyboard.press("Enter");
  await lab.reaches("ready");
  await path(page).getByRole("button", { name: "Run" }).focus();
  await page.keyboard.press("Enter");
  await expect(lab.iteration).not.toHaveText("0");
});

test("a rendered pair is taken as files with its true pose", LONG, async ({ lab, page }) => {
  await lab.visit("size=32");
  await openPath(page);
  await path(page).getByText("No pictures at hand?").click();
  const cards = path(page).locator(".render");
  await expect(cards).toHaveCount(6);
  // They open below the end of the dialog, which scrolls to them.
  await expect(cards.first()).toBeInViewport({ ratio: 0.5 });
  await expect(cards.last()).toContainText("Fails");
  await expect(cards.first().locator("canvas")).toHaveAttribute("width", "320", { timeout: 60_000 });
  await cards.nth(1).click();
  for (const name of ["Picture", "Depth", "Masks"]) await expect(step(page, name)).toContainText("there");
  await step(page, "Go").click();
  await expect(path(page).locator(".expect")).toContainText("silhouettes give the pose to a degree or two");
  await lab.reaches("ready");
  await press(page, "Run");
  await lab.reaches("converged");
  expect(await lab.errorDegrees()).toBeLessThan(1);
  // The light of files cannot be dragged.
  await expect(page.locator("#next")).toContainText("Rotate the surfaces, or download");
});

test("it fits a phone and has no violation of axe's rules in either colour scheme", async ({ lab, page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await lab.open("size=32");
  await openPath(page);
  await drop(page, "dialog.first-run", [colourPng(), depthPng(), maskPng()]);
  await expect(step(page, "Masks")).toContainText("there");
  await page.evaluate(AXE);
  for (const name of ["Picture", "Depth", "Masks", "Go"]) {
    await step(page, name).click();
    await expect(step(page, name)).toHaveAttribute("aria-current", "step");
    for (const button of await path(page).locator(".foot button, .markers button").all()) {
      const box = await button.boundingBox();
      expect(box && box.x >= 0 && box.x + box.width <= 390 && box.height >= 44, name).toBe(true);
    }
    expect(await path(page).evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth)).toBeLessThanOrEqual(
      0,
    );
    for (const colorScheme of ["dark", "light"] as const) {
      await page.emulateMedia({ colorScheme });
      const found = await page.evaluate(async () => {
        const { axe } = window as unknown as {
          axe: { run(on: Document): Promise<{ violations: { id: string; nodes: { target: string[] }[] }[] }> };
        };
        const { violations } = await axe.run(document);
        return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(" ")).join("; ")}`);
      });
      expect.soft(found, `${name}, ${colorScheme}`).toEqual([]);
    }
  }
});
