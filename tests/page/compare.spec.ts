/** A pinned run next to the following one, and a light set coefficient by coefficient. */

import type { Locator, Page } from "@playwright/test";
import { decode } from "fast-png";
import { DRAWN, covered, goToClouds, still } from "./clouds";
import { LONG, expect, test, type Lab } from "./lab";

const boxOf = (lab: Lab, title: string): Locator =>
  lab.page.locator("figure.view > .canvas", { has: lab.page.locator(`canvas[aria-label^="${title}:"]`) });

/** Share of the pixels that differ between two screenshots, without the wipe's line at the right edge. */
async function differing(box: Locator, before: Buffer): Promise<number> {
  const [a, b] = [decode(before), decode(await box.screenshot())];
  expect([b.width, b.height]).toEqual([a.width, a.height]);
  let count = 0;
  for (let i = 0; i < a.width * a.height; i++) {
    if (i % a.width >= a.width - 4) continue;
    if ([0, 1, 2].some((c) => Math.abs((a.data[i * a.channels + c] ?? 0) - (b.data[i * b.channels + c] ?? 0)) > 8))
      count++;
  }
  return count / (a.width * a.height);
}

test("a pinned run stays in the charts, and in the pictures left of the wipe", async ({ lab, page }) => {
  await lab.open("size=64");
  await expect(page.getByLabel("wipe")).toBeDisabled();
  for (const count of ["1", "2"]) {
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText(count);
  }
  const colour = boxOf(lab, "Colour");
  await page.mouse.move(2, 2);
  const before = await colour.screenshot();
  await page.getByRole("button", { name: "Pin this run" }).click();
  await expect(page.locator("#pinned-words")).toHaveText(/^iteration 2, \d+\.\d\d° off$/);
  await expect(page.locator("#objective-chart")).toHaveAttribute("aria-label", /Pinned: objective .*total: from \d/);

  await lab.unfold();
  await page.getByLabel("Light", { exact: true }).first().selectOption("overcast");
  await lab.reaches("ready");
  await page.locator("#input > summary").click();
  await expect(lab.iteration).toHaveText("0");
  // No run has started since, but the curves of the pinned run are shown.
  await expect(page.locator("#objective-chart")).toHaveAttribute(
    "aria-label",
    /^Objective over the iterations\. total: none yet.*Pinned: objective .*total: from \d/,
  );
  await expect(page.locator("#objective-chart .pinned-curve").first()).toBeHidden();
  const drawn = () =>
    page.locator("#objective-chart canvas").evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height) ?? new ImageData(1, 1);
      let coloured = 0;
      for (let i = 0; i < data.length; i += 4)
        if (
          (data[i + 3] ?? 0) > 128 &&
          Math.max(data[i] ?? 0, data[i + 1] ?? 0, data[i + 2] ?? 0) -
            Math.min(data[i] ?? 0, data[i + 1] ?? 0, data[i + 2] ?? 0) >
            60
        )
          coloured++;
      return coloured;
    });
  await expect.poll(drawn).toBeGreaterThan(50);

  const wipe = page.getByLabel("wipe");
  await page.mouse.move(2, 2);
  await wipe.fill("100");
  await expect.poll(() => differing(colour, before)).toBeLessThan(0.005);
  await wipe.fill("0");
  await expect.poll(() => differing(colour, before)).toBeGreaterThan(0.2);
  const present = await colour.screenshot();
  await wipe.fill("50");
  await expect.poll(() => differing(colour, before)).toBeGreaterThan(0.1);
  await expect.poll(() => differing(colour, present)).toBeGreaterThan(0.1);

  await page.getByRole("button", { name: "Unpin" }).click();
  await expect(page.locator(".pinned")).toHaveCount(0);
  await expect.poll(drawn).toBe(0);
});

test(
  "the surfaces of a pinned run are seen left of the wipe, from wherever they are looked at",
  LONG,
  async ({ lab, page }) => {
    // Stops animations.
    await page.emulateMedia({ reducedMotion: "reduce" });
    await lab.open("size=64");
    await goToClouds(page);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    const clouds = page.locator("#clouds-box");
    await expect(page.locator("#clouds-note")).toBeHidden();
    await expect.poll(() => covered(page.locator("#clouds-canvas"))).toBeGreaterThan(DRAWN);
    const before = await still(clouds);
    await page.getByRole("button", { name: "Pin this run" }).click();
    await lab.unfold();
    await page.getByLabel("Surface", { exact: true }).selectOption("vase");
    await lab.reaches("ready");
    await page.locator("#input > summary").click();
    const wipe = page.getByLabel("wipe");
    await wipe.fill("100");
    // The pinned surfaces are moved to the present object's place and seen from the present viewpoint.
    await expect.poll(() => differing(clouds, before)).toBeLessThan(0.1);
    const pinned = await clouds.screenshot();
    await wipe.fill("0");
    await expect.poll(() => differing(clouds, pinned)).toBeGreaterThan(0.1);
    const present = await clouds.screenshot();
    await wipe.fill("50");
    for (const whole of [pinned, present]) await expect.poll(() => differing(clouds, whole)).toBeGreaterThan(0.04);
    await page.getByRole("button", { name: "Unpin" }).click();
    await expect.poll(() => differing(clouds, present)).toBeLessThan(0.005);
  },
);

const pinningMovesNothing = async ({ lab, page }: { lab: Lab; page: Page }): Promise<void> => {
  await lab.open("size=64");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const places = () =>
    page.evaluate(() =>
      ["#presets", "#input", "#pin", "#hero"].map((each) => {
        const { x, y } = document.querySelector(each)?.getBoundingClientRect() ?? new DOMRect();
        return [each, Math.round(x + scrollX), Math.round(y + scrollY)];
      }),
    );
  const areWordsWhole = () =>
    page
      .locator("#pinned-words")
      .evaluate((words) => words.scrollHeight <= words.clientHeight && words.scrollWidth <= words.clientWidth);
  for (const width of [390, 768, 1024, 1280, 1600]) {
    await page.setViewportSize({ width, height: 800 });
    const before = await places();
    await page.getByRole("button", { name: "Pin this run" }).click();
    await expect(page.locator("#pinned-words")).toHaveText(/^iteration 1, /);
    expect(await places(), `at ${width} pixels`).toEqual(before);
    expect(await areWordsWhole(), `at ${width} pixels the words are whole`).toBe(true);
    await page.getByRole("button", { name: "Unpin" }).click();
  }
};

test("pinning moves nothing, whatever the screen's width", pinningMovesNothing);

test.describe("by touch", () => {
  test.use({ hasTouch: true, isMobile: true });
  test("pinning moves nothing either", pinningMovesNothing);
});

test("a pinned picture of another size lies where its pixels belong", async ({ lab, page }) => {
  await lab.open("size=128");
  const colour = boxOf(lab, "Colour");
  await page.mouse.move(2, 2);
  await page.getByRole("button", { name: "Pin this run" }).click();
  await lab.unfold();
  await page.getByLabel("Size", { exact: true }).selectOption("64");
  await lab.reaches("ready");
  await page.locator("#input > summary").click();
  const wipe = page.getByLabel("wipe");
  await wipe.fill("0");
  await page.mouse.move(2, 2);
  const small = await colour.screenshot();
  await wipe.fill("100");
  // The same object under the same light, so only edges and finer shading differ.
  await expect.poll(() => differing(colour, small)).toBeLessThan(0.5);
  expect(await differing(colour, small)).toBeGreaterThan(0.001);
});

test(
  "each number of the light has a slider: the picture follows, and undo brings it back",
  LONG,
  async ({ lab, page }) => {
    await lab.open("size=64");
    const before = await lab.fingerprint("Colour");
    await page.getByText("All 27 coefficients").click();
    const sliders = page.locator("#coefficients").getByRole("slider");
    await expect(sliders).toHaveCount(27);
    const slider = page.getByRole("slider", { name: "red, x", exact: true });
    // The value of the built-in light.
    await expect(slider).toHaveValue("0.7");
    await slider.evaluate((input: HTMLInputElement) => {
      input.value = "-0.5";
      input.dispatchEvent(new Event("input", { bubbles: true }));
    });
    await expect.poll(() => lab.fingerprint("Colour")).not.toBe(before);
    await expect(page).toHaveURL(/light=-1\.2\+0\.1\+-0\.9\+-0\.5\+/);
    await lab.reaches("ready");
    await expect(slider).toHaveValue("-0.5");
    const changed = await lab.fingerprint("Colour");
    await lab.unfold();
    await expect(page.getByLabel("Light", { exact: true }).first()).toHaveValue(/^-1\.2 0\.1 /);
    await page.getByRole("button", { name: "Undo" }).click();
    await expect.poll(() => lab.fingerprint("Colour")).toBe(before);
    await expect(slider).toHaveValue("0.7");
    await page.getByRole("button", { name: "Redo" }).click();
    await expect.poll(() => lab.fingerprint("Colour")).toBe(changed);
    // A link restores the coefficient.
    const link = page.url();
    await page.goto("about:blank");
    await page.goto(link);
    await lab.reaches("ready");
    expect(await lab.fingerprint("Colour")).toBe(changed);
    // A named light replaces the coefficients.
    await lab.unfold();
    await page.getByLabel("Light", { exact: true }).first().selectOption("colourful");
    await expect.poll(() => lab.fingerprint("Colour")).toBe(before);
  },
);

test("a slider that is focused says its number", async ({ lab, page }) => {
  await lab.open("size=32&lighting=estimate");
  await expect(page.getByText("All 27 coefficients")).toBeVisible();
  await page.getByText("All 27 coefficients").click();
  await page.locator("#coefficients").getByRole("slider", { name: "green, z²", exact: true }).focus();
  await expect(page.locator("#coefficients output")).toHaveText("green, z²: −0.10");
});
