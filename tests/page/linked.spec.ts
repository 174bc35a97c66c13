/** When a pixel is hovered, every view highlights the corresponding place. */

import { readFile } from "node:fs/promises";
import type { Locator } from "@playwright/test";
import init, { sample } from "../../pkg/index.js";
import { expect, test, type Lab } from "./lab";
import { Messages } from "./messages";

const size = 64;
/** The pose is given and fixed, so that the display can be checked against it. */
const TRUE_POSE = `size=${size}&beta=20&lighting=known&start=truth&registration=fixed`;

test.beforeAll(async () => {
  await init(await readFile(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)));
});

const canvasOf = (lab: Lab, title: string): Locator => lab.page.locator(`canvas[aria-label^="${title}:"]`);
const figureOf = (lab: Lab, title: string): Locator => lab.page.locator("figure.view", { has: canvasOf(lab, title) });

async function middle(part: Locator): Promise<{ x: number; y: number }> {
  const box = await part.boundingBox();
  if (!box) throw new Error("it is on the page");
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

/** The pixel that a view names, or undefined. */
async function pixelOf(lab: Lab, title: string): Promise<[number, number] | undefined> {
  const found = /^(\d+), (\d+): (?!none)/.exec((await figureOf(lab, title).locator(".readout").textContent()) ?? "");
  return found ? [Number(found[1]), Number(found[2])] : undefined;
}

/** Hovers at a share of a view's sides and waits for the answer. */
async function point(lab: Lab, title: string, across: number, down: number): Promise<void> {
  const canvas = canvasOf(lab, title);
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  if (!box) throw new Error("the view is on the page");
  await lab.page.mouse.move(2, 2);
  await expect(lab.page.locator("#probe")).toBeHidden();
  await lab.page.mouse.move(box.x + across * box.width, box.y + down * box.height);
  await expect(figureOf(lab, title).locator(".readout")).toHaveText(/^\d+, \d+: /);
}

async function openAtTruth(lab: Lab): Promise<void> {
  await lab.visit(TRUE_POSE);
  await lab.page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
}

test("its counterpart is marked where the true pose says", async ({ lab }) => {
  const { depth, pose, truth } = sample({ surface: "bust", light: "colourful", size, angles: { beta: 20 } });
  await openAtTruth(lab);
  let seen = 0;
  for (const [across, down] of [
    [0.45, 0.3],
    [0.5, 0.2],
    [0.4, 0.5],
    [0.35, 0.85],
  ] as const) {
    await point(lab, "Normals", across, down);
    const [mine, theirs] = [await pixelOf(lab, "Normals"), await pixelOf(lab, "Refined depth")];
    if (!mine || !theirs) continue;
    // Coordinates of an orthographic view are pixels about its middle.
    const half = (size - 1) / 2;
    const from = [theirs[0] - half, theirs[1] - half, truth.depth[theirs[1] * depth.width + theirs[0]] ?? NaN];
    const to = [0, 1].map(
      (row) =>
        pose.scale * from.reduce((sum, value, c) => sum + (pose.rotation[3 * row + c] ?? NaN) * value, 0) +
        (pose.translation[row] ?? NaN) +
        half,
    );
    expect(Math.hypot((to[0] ?? NaN) - mine[0], (to[1] ?? NaN) - mine[1])).toBeLessThan(1.5);

    // The mark is at the named pixel: hovering there names it again and leads back.
    const mark = await middle(figureOf(lab, "Refined depth").locator(".dot"));
    const box = await canvasOf(lab, "Refined depth").boundingBox();
    if (!box) throw new Error("the view is on the page");
    await point(lab, "Refined depth", (mark.x - box.x) / box.width, (mark.y - box.y) / box.height);
    expect(await pixelOf(lab, "Refined depth")).toEqual(theirs);
    const back = await pixelOf(lab, "Normals");
    expect(back && Math.hypot(back[0] - mine[0], back[1] - mine[1])).toBeLessThan(2.5);
    seen++;
  }
  expect(seen).toBeGreaterThan(1);
});

test("a card says what is known of the pixel, in a fixed size", async ({ lab, page }) => {
  await openAtTruth(lab);
  const card = page.locator("#probe");
  await expect(card).toBeHidden();
  const heights = new Set<number>();
  for (const title of ["Normals", "Refined depth", "Colour"]) {
    await point(lab, title, 0.45, 0.3);
    await expect(card).toBeVisible();
    heights.add((await card.boundingBox())?.height ?? 0);
    const numbers = async (name: string) =>
      (
        await card
          .locator("tr", { has: page.getByRole("rowheader", { name, exact: true }) })
          .locator("td:not(.unit)")
          .allTextContents()
      )
        .filter(Boolean)
        .map((text) => Number(text.replace("−", "-")));
    await expect.poll(async () => (await numbers("log colour")).length).toBe(3);
    const [log, predicted, residual, normal] = [
      await numbers("log colour"),
      await numbers("predicted"),
      await numbers("residual"),
      await numbers("normal"),
    ];
    expect(log.every(Number.isFinite)).toBe(true);
    // Each number is shown with three decimals.
    expect(
      Math.abs(Math.hypot(...log.map((value, c) => value - (predicted[c] ?? NaN))) - (residual[0] ?? NaN)),
    ).toBeLessThan(0.003);
    expect(Math.hypot(...normal)).toBeCloseTo(1, 2);
    const [own, view] = [await card.boundingBox(), await canvasOf(lab, title).boundingBox()];
    // The card does not cover the hovered view.
    expect(
      own &&
        view &&
        (own.x > view.x + view.width ||
          own.x + own.width < view.x ||
          own.y > view.y + view.height ||
          own.y + own.height < view.y),
    ).toBe(true);
  }
  expect(heights.size).toBe(1);
});

test("the surfaces show the point, and can be pointed at", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await openAtTruth(lab);
  await expect(page.locator("#clouds-note")).toBeHidden();
  await page.getByRole("button", { name: "Home", exact: true }).click();
  await point(lab, "Colour", 0.45, 0.3);
  const before = await pixelOf(lab, "Colour");
  const marks = page.locator("#clouds-box .dot");
  await expect(marks.filter({ visible: true })).toHaveCount(2);
  const [image, depth] = [
    await middle(page.locator("#clouds-box .dot.image")),
    await middle(page.locator("#clouds-box .dot.depth")),
  ];
  // Under the true pose the surfaces coincide.
  expect(Math.hypot(image.x - depth.x, image.y - depth.y)).toBeLessThan(25);
  await page.mouse.move(image.x, image.y);
  await expect(page.locator("#probe")).toBeVisible();
  await expect
    .poll(async () => {
      const now = await pixelOf(lab, "Colour");
      return before && now ? Math.hypot(now[0] - before[0], now[1] - before[1]) : Infinity;
    })
    .toBeLessThan(3);
  await page.mouse.move(2, 2);
  await expect(marks.filter({ visible: true })).toHaveCount(0);
});

test("the arrow keys move it", async ({ lab, page }) => {
  await openAtTruth(lab);
  await page.mouse.move(2, 2);
  await canvasOf(lab, "Normals").focus();
  await page.keyboard.press("ArrowRight");
  await expect(figureOf(lab, "Normals").locator(".readout")).toHaveText(/^\d+, \d+: /);
  await expect(page.locator("#probe")).toBeVisible();
  const before = await pixelOf(lab, "Normals");
  for (const key of ["ArrowRight", "ArrowRight", "ArrowUp"]) await page.keyboard.press(key);
  await expect.poll(() => pixelOf(lab, "Normals")).toEqual([(before?.[0] ?? NaN) + 2, (before?.[1] ?? NaN) - 1]);
  expect(await pixelOf(lab, "Depth")).toEqual(await pixelOf(lab, "Normals"));
  await page.locator("#play").focus();
  await expect(page.locator("#probe")).toBeHidden();
});

test("of many moves the last counts, and the worker is asked one thing at a time", async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await openAtTruth(lab);
  await point(lab, "Colour", 0.6, 0.4);
  const last = await pixelOf(lab, "Colour");
  await point(lab, "Colour", 0.3, 0.4);
  const first = await pixelOf(lab, "Colour");
  expect(first).not.toEqual(last);
  const box = await canvasOf(lab, "Colour").boundingBox();
  if (!box) throw new Error("the view is on the page");
  const before = await messages.count("probe");
  await messages.hold("probe");
  for (let move = 1; move <= 10; move++)
    await page.mouse.move(box.x + (0.3 + 0.03 * move) * box.width, box.y + 0.4 * box.height);
  expect(await messages.count("probe")).toBe(before + 1);
  // Until the answer arrives, the last position and numbers stay.
  expect(await pixelOf(lab, "Depth")).toEqual(first);
  await messages.release();
  await expect.poll(() => messages.count("probe")).toBe(before + 2);
  await expect.poll(() => pixelOf(lab, "Depth")).toEqual(last);
});

test.describe("by touch", () => {
  test.use({ hasTouch: true, viewport: { width: 390, height: 844 } });

  test("the card goes when anything else is touched", async ({ lab, page }) => {
    await lab.open("size=32");
    const card = page.locator("#probe");
    await page.locator("canvas[aria-label^='Colour:']").tap();
    await expect(card).toBeVisible();
    await page.locator("#lead").tap();
    await expect(card).toBeHidden();
  });
});
