/** A worker that is slow or silent: what was asked for last is what happens, and nothing has to be waited for. */

import type { Page } from "@playwright/test";
import { expect, test } from "./lab";

/** The first `silent` steps are swallowed, as a step would be that takes for ever; all else arrives late. */
async function slow(page: Page, silent: number, milliseconds: number): Promise<void> {
  await page.addInitScript(([silent, milliseconds]) => {
    let steps = 0;
    const send = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (this: Worker, message: { kind?: string }, options?: StructuredSerializeOptions | Transferable[]) {
      // The thread that draws the clouds is as quick as ever.
      if (message.kind === undefined) return send.call(this, message, options as StructuredSerializeOptions);
      if (message.kind === "advance" && ++steps <= silent) return;
      setTimeout(() => send.call(this, message), milliseconds);
    };
  }, [silent, milliseconds] as const);
}

test("reset works while a step runs", async ({ lab, page }) => {
  await slow(page, 1, 0);
  await lab.open();
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("playing");
  await page.getByRole("button", { name: "Reset" }).click();
  await lab.reaches("ready");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
});

test("another input replaces one that is being worked on", async ({ lab, page }) => {
  await lab.open("surface=ripples");
  const ripples = await lab.fingerprint("Colour");
  await slow(page, 1, 0);
  await page.goto("about:blank");
  await lab.open("surface=bust");
  await page.keyboard.press("s");
  await page.getByLabel("Surface", { exact: true }).selectOption("ripples");
  await lab.reaches("ready");
  expect(await lab.fingerprint("Colour")).toBe(ripples);
  await page.getByLabel("Surface", { exact: true }).blur();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
});

test("of several wishes the last one counts", async ({ lab, page }) => {
  await lab.open("surface=vase");
  const vase = await lab.fingerprint("Colour");
  await slow(page, 0, 150);
  await page.goto("about:blank");
  await lab.open("surface=bust");
  const surface = page.getByLabel("Surface", { exact: true });
  for (const name of ["ripples", "bust", "vase"]) await surface.selectOption(name);
  await page.getByLabel("Start", { exact: true }).selectOption("near");
  await page.getByLabel("Start", { exact: true }).blur();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  expect(await lab.fingerprint("Colour")).toBe(vase);

  // A refusal in between leaves the pair on the screen and the one in the worker the same.
  await surface.selectOption("ripples");
  await page.getByLabel("Overlap", { exact: true }).first().fill("7");
  await page.keyboard.press("Enter");
  await lab.reaches("error");
  expect(await lab.fingerprint("Colour")).toBe(vase);
  await page.getByLabel("Start", { exact: true }).focus();
  await page.getByLabel("Start", { exact: true }).blur();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  expect(await lab.fingerprint("Colour")).toBe(vase);
});

test("where every frame is late the search still ends", async ({ lab, page }) => {
  // Frames so late are played stage by stage, and a search has hundreds of them.
  await slow(page, 0, 400);
  await lab.visit("light=colourful");
  await page.getByRole("button", { name: "Play" }).click();
  await expect(lab.iteration).not.toHaveText("0", { timeout: 30_000 });
});
