/** The slides of Learn: each fits its screen, and the browser's Back turns them like pages. */

import type { Locator, Page } from "@playwright/test";
import { LESSONS, open } from "./figure";
import { LONG, expect, test } from "./lab";
import { textsIn, tooSmall } from "./slide-text";

/** The states with the longest texts. */
const WORDIEST = ["pose&run=register&offset=40", "failure&case=symmetry&amount=100", "failure&amount=100"];

test("each slide fits its screen, whatever its figure has to say", LONG, async ({ lab, page }) => {
  for (const state of [...LESSONS, ...WORDIEST]) {
    await open(page, `at=${state}&slides`);
    await expect(page.locator(".learn-slide .learn-figure")).toHaveAttribute("aria-busy", "false");
    for (const [width, height] of [
      [1280, 720],
      [1366, 768],
      [1600, 900],
      [1920, 1080],
    ] as const) {
      await page.setViewportSize({ width, height });
      const below = () =>
        page.locator(".learn-slide").evaluate(({ scrollHeight, clientHeight }) => scrollHeight - clientHeight);
      await expect.poll(below, { message: `${state} at ${width} px` }).toBeLessThanOrEqual(0);
    }
  }
  expect(lab.complaints).toEqual([]);
});

/** The smallest text of a slide if it is too small, and the axis labels that end outside their plot. */
async function textOf(page: Page): Promise<{ small: string[]; cut: string[] }> {
  const texts = await textsIn(page, ".learn-slide");
  const cut = texts.filter(
    ({ drawing, left, right }) => drawing && (left < drawing.left - 1 || right > drawing.right + 1),
  );
  return { small: tooSmall(texts), cut: cut.map(({ words }) => words) };
}

test("the bar and the list of the slides show their text, whole and large enough", async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await open(page, "at=normal&answers=hidden&slides");
  await page.locator(".learn-count").click();
  await expect(page.locator(".learn-overview")).toBeVisible();
  const texts = [
    ...(await textsIn(page, ".learn-slide-bar > .learn-overview")),
    ...(await textsIn(page, ".learn-slide-bar")),
  ];
  expect(texts.length).toBeGreaterThan(LESSONS.length);
  expect(tooSmall(texts)).toEqual([]);
  expect(texts.filter(({ isCut }) => isCut)).toEqual([]);
  expect(texts.filter(({ left, right, top, bottom }) => left < 0 || right > 1280 || top < 0 || bottom > 720)).toEqual(
    [],
  );
  expect(lab.complaints).toEqual([]);
});

test("text of a slide can be read from the last row, and no axis label is cut", LONG, async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  for (const state of LESSONS) {
    await open(page, `at=${state}&slides`);
    await expect(page.locator(".learn-slide .learn-figure")).toHaveAttribute("aria-busy", "false");
    await expect.poll(() => textOf(page), { message: state }).toEqual({ small: [], cut: [] });
  }
  expect(lab.complaints).toEqual([]);
});

/** Pairs of texts of a plot that overlap, and texts above or below their plot. */
const struck = (page: Page): Promise<string[]> =>
  page.locator(".learn-plot").evaluateAll((plots) =>
    plots.flatMap((plot) => {
      const edges = plot.getBoundingClientRect();
      const texts = [...plot.querySelectorAll("text")].map((text) => {
        const { left, right, top, bottom } = text.getBoundingClientRect();
        return { words: text.textContent ?? "", left, right, top, bottom };
      });
      const out = texts.filter(({ top, bottom }) => top < edges.top - 2 || bottom > edges.bottom + 2);
      const pairs = texts.flatMap((a, i) => texts.slice(i + 1).map((b) => [a, b] as const));
      const overlaps = pairs.filter(
        ([a, b]) => a.left < b.right && b.left < a.right && a.top + 3 < b.bottom && b.top + 3 < a.bottom,
      );
      return [...out.map(({ words }) => words), ...overlaps.map(([a, b]) => `${a.words} on ${b.words}`)];
    }),
  );

test("no text of a plot lies on another, beside a lesson or on its slide", LONG, async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  for (const id of LESSONS)
    for (const state of [`at=${id}`, `at=${id}&slides`]) {
      await open(page, state);
      await expect(page.locator(".learn-figure")).toHaveAttribute("aria-busy", "false");
      await expect.poll(() => struck(page), { message: state }).toEqual([]);
    }
  expect(lab.complaints).toEqual([]);
});

test("an axis of angles has ticks at parts of a right angle", async ({ page }) => {
  await open(page, "at=lambert");
  const ticks = page.locator('[data-panel="law"] .tick[text-anchor="middle"]');
  const angles = (await ticks.allTextContents()).map(Number);
  expect(angles).toContain(60);
  expect(angles.filter((angle) => angle % 15 !== 0)).toEqual([]);
});

test("before the first slide and after the last there is none, and the buttons say so", async ({ page, say }) => {
  await page.goto("./#learn&at=normal&slides");
  const previous = page.getByRole("button", { name: say("interface.slides.previous", "Previous lesson") });
  const next = page.getByRole("button", { name: say("interface.slides.next", "Next lesson") });
  await expect(page.getByRole("heading", { name: say("lessons.normal.title", "What a normal is") })).toBeVisible();
  await expect(previous).toBeDisabled();
  await next.click();
  await expect(page.getByRole("heading", { name: say("lessons.lambert.title", "Light and angle") })).toBeVisible();
  await expect(previous).toBeEnabled();
  await page.goto("./#learn&at=paint&slides");
  await expect(page.getByRole("heading", { name: say("lessons.paint.title", "Shadows and paint") })).toBeVisible();
  await next.click();
  await expect(page.getByRole("heading", { name: say("lessons.failure.title", "When it fails") })).toBeVisible();
  await expect(next).toBeDisabled();
});

test("the browser's Back turns a slide back, then leads to the lesson, and Forward again", async ({
  lab,
  page,
  say,
}) => {
  await page.goto("./#learn&at=pose");
  await page
    .getByRole("navigation", { name: say("interface.lessons", "Lessons") })
    .getByRole("link", { name: say("lessons.pixel.title", "What a pixel shows") })
    .click();
  const heading = (title: string) => page.getByRole("heading", { name: title });
  const slides = page.locator("dialog.learn-slides");
  await page.getByRole("button", { name: say("interface.slides", "Slides") }).click();
  await expect(slides).toBeVisible();
  await page.keyboard.press("ArrowRight");
  await expect(heading(say("lessons.grey.title", "One grey light is not enough"))).toBeVisible();
  // A changed setting adds no entry to the history.
  await slides.locator('input[name="turn"]').fill("90");
  await expect(page).toHaveURL(/at=grey&turn=90(&lang=\w+)?&slides$/);
  await page.keyboard.press("PageDown");
  await expect(heading(say("lessons.colours.title", "Three colours"))).toBeVisible();
  await page.goBack();
  await expect(heading(say("lessons.grey.title", "One grey light is not enough"))).toBeVisible();
  await expect(slides.locator('input[name="turn"]')).toHaveValue("90");
  await page.goBack();
  await expect(heading(say("lessons.pixel.title", "What a pixel shows"))).toBeVisible();
  await expect(slides).toBeVisible();
  await page.goBack();
  await expect(slides).toBeHidden();
  await expect(heading(say("lessons.pixel.title", "What a pixel shows"))).toBeVisible();
  await expect(page).toHaveURL(/at=pixel(&lang=\w+)?$/);
  await page.goForward();
  await expect(slides).toBeVisible();
  await expect(heading(say("lessons.pixel.title", "What a pixel shows"))).toBeVisible();
  // After a visit to the Lab, Learn shows the lesson and not its slides.
  await page.goto("./#size=32");
  await lab.reaches("ready");
  await page.locator("#to-learn").click();
  await expect(slides).toBeHidden();
  await expect(
    page.locator(".learn-main").getByRole("heading", { name: say("lessons.pixel.title", "What a pixel shows") }),
  ).toBeVisible();
  expect(lab.complaints).toEqual([]);
});

test("a slide uses a beamer's screen, and no figure is below its edge", async ({ lab, page }) => {
  await page.setViewportSize({ width: 1920, height: 1080 });
  await page.goto("./#learn&at=pose&slides");
  const slide = page.locator(".learn-slide");
  await expect(slide.locator(".learn-panel").first()).toBeVisible();
  expect((await slide.locator(".learn-figure").boundingBox())?.width).toBeGreaterThan(0.9 * 1920);
  expect(
    await slide.locator("h2").evaluate((title) => Number.parseFloat(getComputedStyle(title).fontSize)),
  ).toBeGreaterThan(48);
  expect(await slide.evaluate(({ scrollHeight, clientHeight }) => scrollHeight - clientHeight)).toBeLessThanOrEqual(0);
  expect(lab.complaints).toEqual([]);
});

test("slides turn by keys, leave the sliders theirs, and end by escape", async ({ lab, page, say }) => {
  await open(page, "at=grey");
  await page.getByRole("button", { name: say("interface.slides", "Slides") }).press("Enter");
  const slides = page.locator("dialog.learn-slides");
  await expect(slides).toBeVisible();
  await expect(
    slides.getByRole("heading", { name: say("lessons.grey.title", "One grey light is not enough") }),
  ).toBeVisible();
  await expect(
    slides.getByText(say("lessons.grey.text.1", "A normal has two degrees of freedom").slice(0, 35)),
  ).toBeHidden();
  await page.keyboard.press("ArrowRight");
  await expect(slides.getByRole("heading", { name: say("lessons.colours.title", "Three colours") })).toBeVisible();
  await expect(page).toHaveURL(/at=colours.*&slides$/);
  // Arrow keys on a slider move the slider.
  const slider = slides.locator('input[name="colour"]');
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  await expect(slider).toHaveValue("0.32");
  // After a drag of the slider, arrow keys turn slides again, and Space does not scroll the page behind.
  const drag = async (input: Locator) => {
    const box = (await input.boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
    await page.mouse.click(box.x + 0.8 * box.width, box.y + 0.5 * box.height);
  };
  await drag(slider);
  await page.keyboard.press("Space");
  expect(await page.evaluate(() => scrollY)).toBe(0);
  await page.keyboard.press("ArrowLeft");
  await expect(
    slides.getByRole("heading", { name: say("lessons.grey.title", "One grey light is not enough") }),
  ).toBeVisible();
  await page.keyboard.press("ArrowLeft");
  await expect(slides.getByRole("heading", { name: say("lessons.pixel.title", "What a pixel shows") })).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(slides).toBeHidden();
  await expect(page.getByRole("heading", { name: say("lessons.pixel.title", "What a pixel shows") })).toBeVisible();
  await expect(
    page.getByText(say("lessons.pixel.text.0", "A matte surface under one distant lamp").slice(0, 38)),
  ).toBeVisible();
  await expect(page).not.toHaveURL(/slides/);
  expect(lab.complaints).toEqual([]);
});

test("Home and End lead to the first and the last slide of the choice, and B blanks the screen", async ({
  lab,
  page,
}) => {
  await open(page, "at=grey&slides=lambert,grey,pose");
  const at = (id: string) => page.locator(`.learn-slide [data-lesson="${id}"]`);
  await page.keyboard.press("End");
  await expect(at("pose")).toBeVisible();
  await page.keyboard.press("Home");
  await expect(at("lambert")).toBeVisible();
  const dialog = page.locator("dialog.learn-slides");
  const cover = () =>
    dialog.evaluate((each) => {
      const { content, backgroundColor, position } = getComputedStyle(each, "::after");
      return content === "none" ? "none" : `${position} ${backgroundColor}`;
    });
  expect(await cover()).toBe("none");
  await page.keyboard.press("b");
  expect(await cover()).toBe("fixed rgb(0, 0, 0)");
  await page.keyboard.press("b");
  expect(await cover()).toBe("none");
  // A presenter's clicker sends a point. The first key on a black screen only wakes it.
  await page.keyboard.press(".");
  expect(await cover()).toBe("fixed rgb(0, 0, 0)");
  await page.keyboard.press("ArrowRight");
  expect(await cover()).toBe("none");
  await expect(at("lambert")).toBeVisible();
  await page.keyboard.press("ArrowRight");
  await expect(at("grey")).toBeVisible();
  await page.keyboard.press("b");
  await page.keyboard.press("Escape");
  await expect(dialog).toBeVisible();
  expect(await cover()).toBe("none");
  // In a number that is being typed, the point is a part of it.
  await page.keyboard.press("q");
  await page.keyboard.type("1.5");
  await expect(dialog.locator("[data-asked] input")).toHaveValue("1.5");
  expect(await cover()).toBe("none");
  await page.keyboard.press("ControlOrMeta+A");
  await page.keyboard.press("Delete");
  await page.keyboard.press(".");
  expect(await cover()).toBe("fixed rgb(0, 0, 0)");
  expect(lab.complaints).toEqual([]);
});

test("two buttons tick all slides or only the present one", async ({ lab, page, say }) => {
  await open(page, "at=grey&slides");
  await page.locator(".learn-count").click();
  const overview = page.locator(".learn-overview");
  await overview.getByRole("button", { name: say("interface.overview.none", "None"), exact: true }).click();
  await expect(page.locator(".learn-count")).toHaveText(/^1 \/ 1/);
  await expect(page).toHaveURL(/&slides=grey$/);
  await overview.getByRole("button", { name: say("interface.overview.all", "All"), exact: true }).click();
  await expect(page.locator(".learn-count")).toHaveText(/^7 \/ 15/);
  await expect(page).toHaveURL(/&slides$/);
  expect(lab.complaints).toEqual([]);
});

test("a number is typed as soon as its question appears, and keys still turn an unanswered slide", async ({
  lab,
  page,
}) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await open(page, "at=grey&slides");
  await page.keyboard.press("q");
  const form = page.locator(".learn-slide .learn-guess[data-asked]");
  await expect(form.locator("input[type=number]")).toBeFocused();
  await page.keyboard.type("3");
  await page.keyboard.press("Enter");
  await expect(form.locator(".learn-answer")).not.toBeEmpty();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="colours"]')).toBeVisible();
  await page.keyboard.press("ArrowLeft");
  await expect(page.locator('.learn-slide [data-lesson="grey"]')).toBeVisible();
  await page.keyboard.press("q");
  await expect(form.locator("input[type=number]")).toBeFocused();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="colours"]')).toBeVisible();
  expect(lab.complaints).toEqual([]);
});
