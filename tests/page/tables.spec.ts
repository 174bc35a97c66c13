/** The Tables: cells are computed here, and each can be watched in the Lab. */

import type { Locator, Page } from "@playwright/test";
import { LONG, expect, test } from "./lab";
import { Messages } from "./messages";
import { atWidths, innerWidth } from "./widths";

const cell = (page: Page, id: string): Locator => page.locator(`.heat-cell[data-cell="${id}"]`);
const inState = (page: Page, state: string): Locator => page.locator(`.heat .heat-cell[data-state="${state}"]`);

async function openTables(page: Page, state = ""): Promise<void> {
  await page.goto(`./#tables${state ? `&${state}` : ""}`);
  await expect(page.locator(".heat")).toBeVisible();
}

/** A cell's number, once it is computed. */
async function computed(page: Page, id: string): Promise<number> {
  await expect(cell(page, id)).toHaveAttribute("data-state", "done");
  return Number(await cell(page, id).getAttribute("data-value"));
}

test("the navigation leads to the Tables and back, and the Lab keeps its settings", async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await lab.open("surface=vase");
  await page.getByRole("link", { name: "Tables" }).click();
  await expect(page.getByRole("heading", { name: "The paper's tables, computed here" })).toBeVisible();
  await expect(page.getByText("our built-in bust stands in for it")).toBeVisible();
  await expect(page.getByRole("button", { name: "Play" })).toBeHidden();
  await expect(page).toHaveURL(/#tables&show=table1/);
  // The Lab's keys are inactive.
  await page.keyboard.press("s");
  await page.getByRole("link", { name: "Lab" }).click();
  await expect(page).toHaveURL(/surface=vase/);
  await expect(page.getByLabel("Surface", { exact: true })).toHaveValue("vase");
  await expect(lab.iteration).toHaveText("0");
  await lab.reaches("ready");
  expect(await messages.count("advance")).toBe(0);
});

test("the Lab alone loads nothing of the Tables", async ({ lab, page }) => {
  const asked: string[] = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  await lab.open();
  const ofTheLab = asked.filter((path) => /\.(js|css)$/.test(path)).length;
  await page.getByRole("link", { name: "Tables" }).click();
  await expect(page.locator(".heat")).toBeVisible();
  expect(asked.filter((path) => /\.(js|css)$/.test(path)).length).toBeGreaterThan(ofTheLab);
  // Before a cell runs, the page holds only one instance of the numerics.
  expect(asked.filter((path) => path.endsWith(".wasm"))).toHaveLength(1);
});

test("a cell is run where it is pressed, and the Lab plays that very run", LONG, async ({ lab, page }) => {
  const id = "table2B/64/colourful/unknown/20/0.5";
  await openTables(page, "show=table2B&size=64&light=unknown&lightName=colourful");
  await expect(cell(page, id)).toHaveAccessibleName(/β 20°, overlap 0.5: not run; the paper: 0\.344°/);
  await cell(page, id).click();
  const degrees = await computed(page, id);
  expect(degrees).toBeGreaterThan(0);
  expect(degrees).toBeLessThan(3);
  await expect(page.locator(".outcome")).toHaveText(/^\d\.\d+°$/);
  await expect(cell(page, id)).toHaveAccessibleName(/: \d\.\d+°(, .+)?; the paper: 0\.344°$/);

  await page.getByRole("link", { name: "Watch this run" }).click();
  await expect(page.locator("#status")).toHaveAttribute("data-state", "converged");
  // The same scene with the same noise, so the answers agree to the last digits.
  expect(Math.abs((await lab.errorDegrees()) - degrees)).toBeLessThan(1e-9);
  await expect(page.getByLabel("Overlap", { exact: true }).first()).toHaveValue("0.5");
  await expect(page).not.toHaveURL(/play/);

  await page.goBack();
  await expect(cell(page, id)).toHaveAttribute("data-value", String(degrees));
  await expect(cell(page, id)).toHaveAttribute("aria-pressed", "true");
});

test("the bare grid of Table 2A is exact, here and in the Lab", LONG, async ({ lab, page }) => {
  const id = "table2A/60/1";
  await openTables(page, "show=table2A");
  await cell(page, id).click();
  expect(await computed(page, id)).toBeLessThan(1e-4);
  await page.getByRole("link", { name: "Watch this run" }).click();
  await expect(page.locator("#status")).toHaveAttribute("data-state", "converged");
  await expect(page.getByLabel("Protocol", { exact: true })).toHaveValue("grid");
  await lab.unfold();
  await expect(page.getByLabel("Protocol", { exact: true })).toBeVisible();
  await expect(page.getByLabel("Size", { exact: true })).toBeHidden();
  expect(await lab.errorDegrees()).toBeLessThan(1e-4);
});

test("all cells run one after the other, and stop when told to", LONG, async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await openTables(page, "show=table2A");
  const stop = page.getByRole("button", { name: "Stop" });
  await expect(stop).toBeDisabled();
  // The third cell never ends, so that the run is under way when it is stopped.
  await messages.hold("cell", 2);
  await page.getByRole("button", { name: "Run all" }).click();
  await expect(inState(page, "done")).toHaveCount(2);
  await expect(inState(page, "running")).toHaveCount(1);
  await expect(inState(page, "waiting")).toHaveCount(27);
  await stop.click();
  await expect(inState(page, "running")).toHaveCount(0);
  await expect(inState(page, "waiting")).toHaveCount(0);
  await expect(stop).toBeDisabled();
  await expect(page.locator(".progress")).toHaveText("2 of 30");

  // The remaining cells continue, and leaving the place stops them as well.
  await messages.lose();
  await messages.hold("cell", 1);
  await page.getByRole("button", { name: "Run row β 90°" }).click();
  await expect(inState(page, "done")).toHaveCount(3);
  await expect(inState(page, "running")).toHaveCount(1);
  await page.getByRole("link", { name: "Lab" }).click();
  await lab.reaches("ready");
  await page.goBack();
  await expect(inState(page, "running")).toHaveCount(0);
  await expect(inState(page, "waiting")).toHaveCount(0);
  await expect(inState(page, "done")).toHaveCount(3);
});

test("arrows lead from cell to cell, and enter runs one", async ({ lab, page }) => {
  await openTables(page, "show=table2A");
  await cell(page, "table2A/20/0.125").focus();
  for (const key of ["ArrowDown", "ArrowDown", "ArrowRight", "ArrowUp"]) await page.keyboard.press(key);
  await expect(cell(page, "table2A/40/0.25")).toBeFocused();
  await page.keyboard.press("Enter");
  expect(await computed(page, "table2A/40/0.25")).toBeLessThan(1e-4);
  await expect(cell(page, "table2A/40/0.25")).toBeFocused();
  expect(lab.complaints).toEqual([]);
});

test("figures are drawn from the cells that are done, and the rows can be taken away", async ({ lab, page }) => {
  await openTables(page, "show=figure4");
  await page.getByRole("button", { name: "Run all" }).click();
  await expect(inState(page, "done")).toHaveCount(3);
  await expect(page.locator(".curves canvas")).toHaveCount(2);
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: "Export" }).click();
  const stream = await (await waiting).createReadStream();
  const chunks: Buffer[] = [];
  for await (const chunk of stream) chunks.push(Buffer.from(chunk as Uint8Array));
  const json = JSON.parse(Buffer.concat(chunks).toString()) as {
    figure4: { iteration: number; degrees: number; depthRmse: number }[];
  };
  expect(json.figure4[0]).toMatchObject({ run: "search", protocol: "2A", iteration: 1 });
  expect(lab.complaints).toEqual([]);
});

test("a cell that fails says so in words, and the next one runs", async ({ lab, page }) => {
  // The first cell is answered as the worker does after a panic, because the numerics cannot be made to panic.
  await page.addInitScript(() => {
    let tasks = 0;
    const send = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (this: Worker, message: { cell?: { id: string } }) {
      if (!message.cell || ++tasks !== 1) return send.call(this, message);
      const fault = { code: "panic", message: "the numerics broke off", fatal: true };
      this.dispatchEvent(new MessageEvent("message", { data: { id: message.cell.id, fault } }));
    };
  });
  await openTables(page, "show=table2A");
  await cell(page, "table2A/20/1").click();
  await expect(cell(page, "table2A/20/1")).toHaveAttribute("data-state", "failed");
  await expect(page.locator(".outcome")).toHaveText("failed: the numerics broke off");
  await page.getByRole("button", { name: "Run again" }).click();
  expect(await computed(page, "table2A/20/1")).toBeLessThan(1e-4);
  expect(lab.complaints).toEqual([]);
});

test("no table sticks out from 390 to 1600 px", LONG, async ({ lab, page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await openTables(page);
  await page.locator(".heat-cell").first().click();
  await expect(page.locator(".heat-cell[data-value]").first()).toBeVisible();
  for (const tab of await page.locator(".tab").all()) {
    await tab.click();
    await expect(tab).toHaveAttribute("aria-current", "true");
    await atWidths(page, [390, 1280, 1600], async (width) =>
      expect(await innerWidth(page), `${await tab.innerText()} at ${width} px`).toBeLessThanOrEqual(width),
    );
  }
  expect(lab.complaints).toEqual([]);
});
