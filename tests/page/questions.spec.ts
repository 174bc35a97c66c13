/** Questions in a lecture: answers one by one, the state that the lecturer prepared, and the keys. */

import type { Page } from "@playwright/test";
import { asked, dialog, exercise, guess } from "./asked";
import { control, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";

const answer = (page: Page) => asked(page).locator(".learn-answer");

test.beforeEach(({ page }) => page.emulateMedia({ reducedMotion: "reduce" }));

test(
  "a link hides every answer of a deck, and A shows only that of the present question",
  LONG,
  async ({ lab, page }) => {
    await page.setViewportSize({ width: 1280, height: 720 });
    await open(page, "slides=lambert,relief,strips,grey,colours&ask&answers=hidden");
    for (const [id, questions] of [
      ["lambert", 1],
      ["relief", 2],
      ["strips", 1],
      ["grey", 1],
      ["colours", 1],
    ] as const) {
      await expect(page.locator(`.learn-slide [data-lesson="${id}"]`)).toBeVisible();
      for (let at = 0; at < questions; at++) {
        await guess(page);
        await expect(asked(page).locator(".learn-noted"), `${id}, question ${at + 1}`).not.toBeEmpty();
        await expect(answer(page)).toBeHidden();
        const state = new URL(page.url()).hash;
        await page.keyboard.press("a");
        await expect(answer(page)).toBeVisible();
        await expect(answer(page).locator("strong")).toHaveCount(1);
        await settled(page);
        expect(new URL(page.url()).hash).not.toBe(state);
        await expect(page).toHaveURL(/&answers=hidden/);
        // Taken away again, with the figure's answer.
        await page.keyboard.press("a");
        await expect(answer(page)).toBeHidden();
        await settled(page);
        expect(new URL(page.url()).hash).toBe(state);
        await page.keyboard.press("a");
        await expect(answer(page)).toBeVisible();
        await page.keyboard.press("q");
      }
      await page.keyboard.press("ArrowRight");
    }
    expect(lab.complaints).toEqual([]);
  },
);

test("an exercise after a question whose answer was shown begins with a hidden answer", async ({ lab, page }) => {
  await open(page, "at=grey&slides&answers=hidden");
  await page.keyboard.press("q");
  await page.keyboard.press("a");
  await expect(answer(page)).toBeVisible();
  await page.keyboard.press("q");
  await expect(exercise(page)).toBeVisible();
  await expect(exercise(page).locator("details")).toBeHidden();
  await page.keyboard.press("a");
  await expect(exercise(page).locator("details p").first()).toBeVisible();
  // The text of the lesson hides them as well.
  await page.keyboard.press("Escape");
  await expect(page.locator(".learn-main .learn-answer").first()).toBeHidden();
  expect(lab.complaints).toEqual([]);
});

test("A shows an answer without a guess, and says nothing of right or wrong", async ({ lab, page, say }) => {
  for (const [id, hides] of [
    ["relief", ""],
    ["lambert", ""],
    ["relief", "&answers=hidden"],
  ] as const) {
    await open(page, "at=normal");
    await open(page, `at=${id}&slides${hides}`);
    const button = dialog(page).getByRole("button", { name: `${say("interface.answer", "Answer")} (A)` });
    await expect(button).toBeHidden();
    await page.keyboard.press("q");
    await expect(button).toBeVisible();
    await settled(page);
    await page.keyboard.press("a");
    await settled(page);
    await expect(control(page, id === "relief" ? "stretch" : "level")).toHaveValue("0.5");
    const words = say(`lessons.${id}.guesses.0.answer`, id === "relief" ? "One that changes from" : "At 60°");
    await expect(answer(page)).toHaveText(new RegExp(`^${words.slice(0, 10)}`));
    await expect(answer(page).locator("strong")).toHaveCount(0);
    await button.click();
    await expect(answer(page)).toBeHidden();
    if (hides === "") await expect(page).not.toHaveURL(/answers/);
    // A guess is compared as before.
    await page.keyboard.press("a");
    await expect(answer(page)).toBeVisible();
    await guess(page);
    await expect(answer(page).locator("strong")).toHaveCount(1);
  }
  expect(lab.complaints).toEqual([]);
});

test("after the questions the figure is in the state that the lecturer prepared", LONG, async ({ lab, page }) => {
  for (const [id, settings] of [
    ["relief", { stretch: "0.4", slope: "0.2" }],
    ["lambert", { level: "0.3" }],
    ["grey", { turn: "35" }],
    ["colours", { colour: "0.6" }],
    ["strips", { px: "0.6", py: "0.3" }],
  ] as const) {
    await open(page, `at=${id}&slides`);
    for (const [name, value] of Object.entries(settings)) await slide(page, name, Number(value));
    await settled(page);
    const isPrepared = async () => {
      for (const [name, value] of Object.entries(settings)) await expect(control(page, name)).toHaveValue(value);
    };
    const gist = dialog(page).locator(".learn-gist");
    await page.keyboard.press("q");
    for (let most = 4; most > 0 && !(await gist.isVisible()); most--) {
      await page.keyboard.press("a");
      await page.keyboard.press("q");
    }
    await expect(gist).toBeVisible();
    await isPrepared();
    // Also after a slide that was left at its question, and by the browser's Back.
    for (const back of [() => page.keyboard.press("ArrowLeft"), () => page.goBack()]) {
      await page.keyboard.press("q");
      await page.keyboard.press("a");
      await page.keyboard.press("ArrowRight");
      await expect(page.locator(`.learn-slide [data-lesson="${id}"]`)).toBeHidden();
      await back();
      await expect(page.locator(`.learn-slide [data-lesson="${id}"]`)).toBeVisible();
      await isPrepared();
    }
    // And beside the text, if the slides end at a question.
    await page.keyboard.press("q");
    await page.keyboard.press("Escape");
    await expect(dialog(page)).toBeHidden();
    await isPrepared();
  }
  expect(lab.complaints).toEqual([]);
});

test("a question that is left while its answer moves the figure stops that", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "no-preference" });
  await open(page, "at=lambert&slides");
  await page.keyboard.press("q");
  await page.keyboard.press("a");
  await expect(control(page, "level")).not.toHaveValue("0.95");
  await page.keyboard.press("q");
  await expect(control(page, "level")).toHaveValue("0.7");
  await page.waitForTimeout(500);
  await expect(control(page, "level")).toHaveValue("0.7");
  expect(lab.complaints).toEqual([]);
});

test("Enter compares a choice that was made with the pointer", async ({ lab, page }) => {
  await open(page, "at=relief&slides");
  await page.keyboard.press("q");
  await page.keyboard.press("Enter");
  await expect(answer(page)).toBeEmpty();
  await asked(page).locator("label").first().click();
  await page.keyboard.press("Enter");
  await expect(answer(page).locator("strong")).toHaveCount(1);
  expect(lab.complaints).toEqual([]);
});

test("a list whose choice was made with the pointer leaves the arrow keys to the slides", async ({ lab, page }) => {
  await open(page, "at=normal&slides");
  const list = control(page, "surface");
  await list.click();
  await list.selectOption("ball");
  await expect(list).not.toBeFocused();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="lambert"]')).toBeVisible();
  // With the Tab key, the list keeps them.
  await page.keyboard.press("ArrowLeft");
  await expect(page.locator('.learn-slide [data-lesson="normal"]')).toBeVisible();
  await list.focus();
  await page.keyboard.press("ArrowUp");
  await expect(list).toHaveValue("vase");
  await expect(list).toBeFocused();
  expect(lab.complaints).toEqual([]);
});
