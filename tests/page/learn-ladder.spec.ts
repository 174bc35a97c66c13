/** The first lessons of Learn, the buttons of the tasks, the guesses, and the highlighting of related parts. */

import type { Page } from "@playwright/test";
import { LESSONS, figure, number, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";

const tries = (page: Page) => page.locator(".learn-try");
const look = (page: Page) => page.locator(".learn-look");
const input = (page: Page, name: string) => page.locator(`.learn-controls [name="${name}"]`);
const state = (page: Page): Promise<string> =>
  page.locator(".learn-controls :is(input, select)").evaluateAll((all) =>
    all
      .map((control) => {
        const { name, type, checked, value } = control as HTMLInputElement;
        return `${name}=${type === "checkbox" ? checked : value}`;
      })
      .join("&"),
  );

test("each task's button sets the figure and says beside it what to look for", LONG, async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  for (const id of LESSONS) {
    await open(page, `at=${id}`);
    const count = await tries(page).count();
    expect(count, id).toBeGreaterThan(2);
    for (let index = 0; index < count; index++) {
      const before = await state(page);
      const words = await page.locator(".learn-tries p").nth(index).textContent();
      await tries(page).nth(index).click();
      await settled(page);
      expect(await state(page), `${id}, task ${index + 1}`).not.toBe(before);
      await expect(look(page)).toContainText(words ?? "?");
      await expect(figure(page)).toBeInViewport();
    }
  }
  expect(lab.complaints).toEqual([]);
});

test("a button moves its slider slowly, and whoever takes a control ends that", async ({ page }) => {
  await open(page, "at=relief");
  const seen = new Set<string>();
  await tries(page).first().click();
  await expect
    .poll(async () => {
      seen.add(await input(page, "stretch").inputValue());
      return input(page, "stretch").inputValue();
    })
    .toBe("0.2");
  expect(seen.size).toBeGreaterThan(2);
  await tries(page).first().click();
  await expect.poll(() => input(page, "stretch").inputValue()).not.toBe("0.2");
  await input(page, "slope").press("ArrowRight");
  const stopped = await input(page, "stretch").inputValue();
  await page.waitForTimeout(500);
  await expect(input(page, "stretch")).toHaveValue(stopped);
});

test("a link ends the move of a slider", async ({ page }) => {
  await page.clock.install();
  await open(page, "at=relief");
  await tries(page).first().click();
  await expect(input(page, "stretch")).not.toHaveValue("1");
  await open(page, "at=relief&stretch=-1");
  await expect(input(page, "stretch")).toHaveValue("-1");
  await page.clock.runFor(3000);
  await expect(input(page, "stretch")).toHaveValue("-1");
});

test("a choice is compared with the answer, after the figure has shown it", async ({ lab, page }) => {
  await open(page, "at=relief&stretch=-1");
  const guess = page.locator(".learn-guess").first();
  const compare = guess.getByRole("button", { name: "Compare" });
  await expect(compare).toBeDisabled();
  await guess.getByLabel("No albedo can").check();
  // The state that the question is about.
  await expect(input(page, "stretch")).toHaveValue("1");
  await expect(guess.getByRole("status")).toBeEmpty();
  await compare.click();
  await expect(guess.getByRole("status")).toHaveText(
    /^Not quite\. You guessed: No albedo can\. One that changes from place to place\./,
  );
  await expect(input(page, "stretch")).toHaveValue("0.5");
  await guess.getByLabel("One that changes").check();
  await compare.click();
  await expect(guess.getByRole("status")).toHaveText(/^Right\./);
  expect(lab.complaints).toEqual([]);
});

test("a typed number is compared with the figure's own", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await open(page, "at=lambert");
  const guess = page.locator(".learn-guess");
  await guess.getByLabel("Your guess").fill("45");
  await guess.getByRole("button", { name: "Compare" }).click();
  await expect(guess.getByRole("status")).toHaveText(/^Not quite\. You guessed: 45°\. At 60°, because/);
  await guess.getByLabel("Your guess").fill("58");
  await guess.getByLabel("Your guess").press("Enter");
  await expect(guess.getByRole("status")).toHaveText(/^Close\./);
  await open(page, "at=surface");
  await guess.getByLabel("Your guess").fill("8");
  await guess.getByRole("button", { name: "Compare" }).click();
  await expect(guess.getByRole("status")).toHaveText(/You guessed: 8 px\. None\./);
  expect(lab.complaints).toEqual([]);
});

test("1: the normal under the pointer is an arrow, and a ring on the ball", async ({ lab, page }) => {
  await open(page, "at=normal&surface=ball");
  const box = await page.locator('[data-panel="surface"] .learn-canvas').boundingBox();
  if (!box) throw new Error("There is no surface.");
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.5 * box.height);
  await expect(input(page, "px")).toHaveValue(/0\.(19|2|21)$/);
  expect(await number(page, "nx")).toBeLessThan(-0.5);
  expect(await number(page, "red")).toBeLessThan(64);
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await expect(input(page, "px")).toHaveValue(/0\.(49|5|51)$/);
  expect(await number(page, "tilt")).toBeLessThan(3);
  expect(lab.complaints).toEqual([]);
});

test("2: a drag on the face moves the lamp, and all isophotes with it", async ({ lab, page }) => {
  await open(page, "at=lambert");
  const line = () => page.locator('[data-panel="vase"] path.fine').getAttribute("d");
  const before = await line();
  const box = await page.locator('[data-panel="bust"] .learn-canvas').boundingBox();
  if (!box) throw new Error("There is no face.");
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.5 * box.height, { steps: 3 });
  await page.mouse.up();
  await settled(page);
  expect(await number(page, "lamp")).toBeGreaterThan(40);
  expect(await line()).not.toBe(before);
  await page.getByLabel("More isophotes").uncheck();
  await settled(page);
  expect((await line()) ?? "").toBe("");
  expect(lab.complaints).toEqual([]);
});

test("12: each press runs one pass of the loop, which brings the pose nearer to the truth", async ({ lab, page }) => {
  await open(page, "at=loop");
  const next = page.locator(".learn-try").first();
  const errors = [await number(page, "pose")];
  for (let pass = 1; pass <= 3; pass++) {
    await next.click();
    await expect(input(page, "pass")).toHaveValue(String(pass));
    errors.push(await number(page, "pose"));
  }
  expect(errors[0]).toBeCloseTo(12, 0);
  expect(errors).toEqual([...errors].sort((a, b) => b - a));
  expect(new Set(errors).size).toBe(4);
  expect(lab.complaints).toEqual([]);
});

test("3, 4, 5: reliefs share a picture, strips follow a face, orders add up", async ({ lab, page }) => {
  await open(page, "at=relief&stretch=0.3&slope=0.2");
  expect(await number(page, "difference")).toBeLessThan(1e-4);
  await page.getByLabel("Move its lamp to match").uncheck();
  expect(await number(page, "difference")).toBeGreaterThan(1);
  await open(page, "at=strips");
  const near = await number(page, "near");
  expect(near).toBeLessThan(0.3);
  await page.getByLabel("Take the spot for a dent").check();
  expect(await number(page, "near")).toBeGreaterThan(10 * near);
  // Where nothing faces the lamp there is no strip, and the figure says why.
  await open(page, "at=strips&lx=0.6&ly=0.6&sx=0.1&sy=0.1");
  expect(await number(page, "strips")).toBe(0);
  await expect(page.locator('[data-panel="picture"]')).toContainText("no surface near this spot faces the lamp");
  await open(page, "at=orders");
  const whole = await number(page, "whole");
  const [first, squares] = [await number(page, "order0"), await number(page, "order2")];
  await slide(page, "constant", 0.4);
  expect(await number(page, "order0")).toBeCloseTo(first - 0.4, 5);
  expect(await number(page, "order2")).toBeCloseTo(squares + 0.4, 5);
  expect(await number(page, "whole")).toBeCloseTo(whole, 5);
  expect(lab.complaints).toEqual([]);
});

test("a symbol under the pointer lights its part of the figure, and the other way round", async ({ page }) => {
  await open(page, "at=lambert");
  await page.locator(".learn-formula .learn-ink-light").hover();
  await expect(page.locator(".learn-panel .learn-ink-light.learn-lit").first()).toBeAttached();
  await expect(page.locator('[data-number="angle"]')).toHaveClass(/learn-lit/);
  await page.locator('[data-number="angle"]').hover();
  await expect(page.locator(".learn-formula .learn-ink-light")).toHaveClass(/learn-lit/);
  await page.locator(".learn-main h2").first().hover();
  await expect(page.locator(".learn-lit")).toHaveCount(0);
});

test("the figure stays beside the tasks, its controls and its first picture in view", async ({ page }) => {
  for (const [width, height] of [
    [1280, 720],
    [1440, 900],
    [1920, 1080],
  ] as const) {
    await page.setViewportSize({ width, height });
    for (const id of ["normal", "lambert", "relief", "strips", "orders", "pose"]) {
      await open(page, `at=${id}`);
      await tries(page).last().scrollIntoViewIfNeeded();
      await expect(page.locator(".learn-controls :is(input, select)").first(), `${id} at ${width}`).toBeInViewport();
      await expect(page.locator(".learn-panel").first(), `${id} at ${width}`).toBeInViewport({ ratio: 0.6 });
    }
  }
});
