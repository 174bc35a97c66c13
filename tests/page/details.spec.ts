/** Details of the page: what is read is counted, what is pointed at covers nothing, and numbers and labels are those of the figure. */

import { decode } from "fast-png";
import { still } from "./clouds";
import { control, figure, number, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";
import { own } from "./ownfiles";
import { answerChecks } from "./rig";
import { openFrames, open as openRig, put, run } from "./rigsteps";
import { colourPng, depthPng, drop } from "./uploads";

test("of files that are not understood none counts as read", async ({ page }) => {
  await openRig(page);
  const notes = (name: string) => ({
    name,
    mimeType: "text/plain",
    buffer: Buffer.from("Date: Monday\nPlace: hall\n"),
  });
  await put(page, [notes("notes.txt"), notes("more.txt")]);
  await expect(page.locator("#rig .rig-step:not([hidden])")).toContainText("0 of 2 files read");
  await expect(page.locator(".rig-files li").first()).toContainText("it is text in an unknown format");
});

test("the buttons of three calibrations stand near each other on a wide screen, at the slider's stops", async ({
  lab,
  page,
}) => {
  await page.setViewportSize({ width: 1920, height: 1080 });
  await answerChecks(page, "off");
  await openFrames(page);
  await run(page);
  const stops = page.locator(".rig-stops");
  await expect(stops.getByRole("button")).toHaveCount(3);
  const [row, slider] = await Promise.all([
    stops.boundingBox(),
    page.getByRole("slider", { name: "Calibration shown" }).boundingBox(),
  ]);
  expect(row?.width).toBeLessThanOrEqual(3 * 12 * 16);
  expect(Math.abs((row?.width ?? 0) - (slider?.width ?? NaN))).toBeLessThan(2);
  expect(lab.complaints).toEqual([]);
});

test("without a size, intrinsics whose centre is far from the picture's are doubted", async ({ lab, page }) => {
  await own(lab);
  const camera = {
    name: "color.json",
    mimeType: "application/json",
    buffer: Buffer.from(JSON.stringify({ fx: 900, fy: 900, cx: 639.5, cy: 359.5 })),
  };
  await drop(page, "body", [colourPng(), depthPng(), camera]);
  await expect(page.locator(".remarks")).toContainText(
    "have their principal point outside the picture (639.5, 359.5 of 48x48): they may be for another size, about 1280x720.",
  );
});

test("the card of a pixel leaves the top free when the pointer is in the lower half of the window", async ({
  lab,
  page,
}) => {
  await page.setViewportSize({ width: 1280, height: 500 });
  await lab.open("size=32");
  const canvas = page.locator('canvas[aria-label^="Colour:"]');
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  const [x, y] = [(box?.x ?? 0) + (box?.width ?? 0) / 2, (box?.y ?? 0) + (box?.height ?? 0) / 2];
  expect(y).toBeGreaterThan(250);
  await page.mouse.move(x, y);
  const card = await page.locator("#probe").boundingBox();
  const top = await page.locator("header.top").boundingBox();
  expect(card?.y).toBeGreaterThan((top?.y ?? 0) + (top?.height ?? 0));
});

test("on a phone the speed can be read whole, and the hint on the surfaces covers none of them", async ({
  browser,
  baseURL,
}) => {
  const context = await browser.newContext({ hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });
  const page = await context.newPage();
  await page.goto(`${baseURL}#size=64&start=truth`);
  await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
  const [text, room] = await page.locator("#pace").evaluate((select: HTMLSelectElement) => {
    const { font, paddingLeft, paddingRight } = getComputedStyle(select);
    const context = document.createElement("canvas").getContext("2d");
    if (context) context.font = font;
    const widths = [...select.options].map(({ text }) => context?.measureText(text).width ?? Infinity);
    return [Math.max(...widths), select.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight)];
  });
  expect(text).toBeLessThanOrEqual(room ?? 0);
  const [speed, count] = await Promise.all([page.locator("#pace").boundingBox(), page.locator(".count").boundingBox()]);
  expect((speed?.x ?? Infinity) + (speed?.width ?? 0)).toBeLessThanOrEqual(count?.x ?? 0);
  await page.locator("#clouds-box").scrollIntoViewIfNeeded();
  await expect(page.locator("#clouds-note")).toBeHidden();
  const hint = page.locator("#clouds-fingers");
  await expect(hint).toBeVisible();
  const clip = await hint.boundingBox();
  if (!clip) throw new Error("There is no hint.");
  await hint.evaluate((element) => (element.style.visibility = "hidden"));
  await page.getByRole("button", { name: "Step", exact: true }).dispatchEvent("click");
  await expect(page.locator("#iteration")).toHaveText("1");
  await still(page.locator("#clouds-canvas"));
  const { data, channels } = decode(await page.screenshot({ clip }));
  const differs = (at: number) => [0, 1, 2].some((c) => Math.abs((data[at + c] ?? 0) - (data[c] ?? 0)) > 24);
  expect(Array.from({ length: data.length / channels }, (_, i) => differs(i * channels)).filter(Boolean)).toEqual([]);
  await context.close();
});

test("each case of the last lesson names what its slider changes", async ({ page }) => {
  await open(page, "at=failure&amount=100");
  for (const [value, label, reading] of [
    ["symmetry", "Part of the nose removed", "100 %"],
    ["overlap", "Part of the depth map cut away", "95 %"],
    ["texture", "Strength of the print", "100 %"],
    ["turn", "Rotation between the views", "°"],
  ] as const) {
    await control(page, "case").selectOption(value);
    await settled(page);
    await expect(page.locator(".learn-controls")).toContainText(label);
    await expect(control(page, "amount")).toHaveAttribute("aria-valuetext", new RegExp(`${reading}$`));
  }
  await expect(page.locator("#learn")).not.toContainText(/\d%/);
});

test("a logarithmic slider has two significant digits", async ({ page }) => {
  await open(page, "at=prior");
  const said: string[] = [];
  for (const value of [-3, -2.5, -1.3, -0.7, 0, 0.6, 1]) {
    await slide(page, "weight", value);
    said.push((await control(page, "weight").getAttribute("aria-valuetext")) ?? "");
  }
  for (const words of said) expect(words).toMatch(/^(0|0\.0*[1-9]\d?|[1-9]\d?|\d\.\d)$/);
  expect(new Set(said).size).toBe(said.length);
});

test("albedo and remainder of the painted picture are those of a colour", async ({ page }) => {
  await open(page, "at=paint");
  const names = await page
    .locator(".learn-formula [data-symbol]")
    .evaluateAll((all) => all.map((symbol) => symbol.getAttribute("data-symbol")));
  expect(names).toEqual(expect.arrayContaining(["aj", "ej"]));
  expect(names).not.toEqual(expect.arrayContaining(["a"]));
  expect(names).not.toEqual(expect.arrayContaining(["e"]));
  expect(await number(page, "likeness")).toBeGreaterThan(0);
});

test("at 2560 px a figure fills the window beside its text", LONG, async ({ page }) => {
  await page.setViewportSize({ width: 2560, height: 1440 });
  for (const id of ["grey", "surface", "pose"]) {
    await open(page, `at=${id}`);
    await expect.poll(async () => (await figure(page).boundingBox())?.height ?? 0, id).toBeGreaterThan(0.6 * 1440);
  }
});
