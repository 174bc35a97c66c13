/** A lecture with the slides: questions to the class, answers that a link hides, and chosen slides. */

import type { Page } from "@playwright/test";
import { asked, dialog, exercise, guess } from "./asked";
import { closeSilently, reportEnd } from "./closing";
import { LESSONS, control, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";
import { type SlideText, textsIn, tooSmall } from "./slide-text";

const count = (page: Page) => dialog(page).locator(".learn-count");

/** What is wrong with a slide: small text, text outside the card or the window, and parts below the edge. */
async function faults(page: Page): Promise<string[]> {
  const over = await page
    .locator(".learn-slide")
    .evaluate(({ scrollHeight, clientHeight }) => scrollHeight - clientHeight);
  const card = await page.locator(".learn-slide .learn-figure").boundingBox();
  const width = page.viewportSize()?.width ?? 0;
  const texts = (await textsIn(page, ".learn-slide")).filter(({ drawing }) => drawing === undefined);
  const beside = ({ isInFigure, right }: SlideText) => isInFigure && card !== null && right > card.x + card.width;
  const below = ({ isInFigure, bottom }: SlideText) => isInFigure && card !== null && bottom > card.y + card.height;
  return [
    ...(over > 0 ? [`${over} px below the slide`] : []),
    ...tooSmall(texts),
    ...texts.filter(below).map(({ words }) => `below the card: ${words}`),
    ...texts.filter(({ right }) => right > width).map(({ words }) => `beyond the edge: ${words}`),
    ...texts.filter(beside).map(({ words }) => `beside the card: ${words}`),
  ];
}

test("each question fits its slide, and its answer comes after the guess", LONG, async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.setViewportSize({ width: 1280, height: 720 });
  for (const id of LESSONS) {
    await open(page, `at=${id}&slides`);
    const questions = await page.locator(".learn-guess").count();
    expect(questions, id).toBeGreaterThan(0);
    for (let at = 0; at < questions; at++) {
      await page.keyboard.press("q");
      await expect(asked(page)).toHaveCount(1);
      await expect(dialog(page).locator(".learn-gist, .learn-formula").first()).toBeHidden();
      await expect(asked(page).locator(".learn-answer")).toBeEmpty();
      await settled(page);
      expect(await faults(page), `${id}, question ${at + 1}`).toEqual([]);
      await guess(page);
      await expect(asked(page).locator(".learn-answer")).not.toBeEmpty();
      await settled(page);
      expect(await faults(page), `${id}, answer ${at + 1}`).toEqual([]);
    }
    const exercises = await dialog(page).locator(".learn-asked").count();
    for (let at = 0; at < exercises; at++) {
      await page.keyboard.press("q");
      await expect(exercise(page)).toBeVisible();
      await settled(page);
      expect(await faults(page), `${id}, exercise ${at + 1}`).toEqual([]);
      await exercise(page).locator("summary").click();
      // The answer speaks about the figure, so both are seen.
      await expect(dialog(page).locator(".learn-figure .learn-canvas").first()).toBeVisible();
      expect(await faults(page), `${id}, answer of exercise ${at + 1}`).toEqual([]);
    }
    await page.keyboard.press("q");
    await expect(asked(page)).toHaveCount(0);
    await expect(exercise(page)).toHaveCount(0);
    await expect(dialog(page).locator(".learn-gist")).toBeVisible();
    await expect(dialog(page).locator(".learn-figure")).toBeVisible();
  }
  expect(lab.complaints).toEqual([]);
});

test("a question on a slide takes the arrow keys only from those who tab to it", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await open(page, "at=relief&slides");
  await page.keyboard.press("q");
  await guess(page);
  await expect(asked(page).locator(".learn-answer")).not.toBeEmpty();
  await asked(page).locator("label").last().click();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="strips"]')).toBeVisible();
  await page.keyboard.press("ArrowLeft");
  await expect(asked(page)).toHaveCount(0);
  // The question begins anew, for another class.
  await page.keyboard.press("q");
  await expect(asked(page).locator("button[type=submit]")).toBeDisabled();
  await asked(page).locator("input").first().focus();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="relief"]')).toBeVisible();
  // After a typed number, too.
  await open(page, "at=grey&slides");
  await page.keyboard.press("q");
  await asked(page).locator("input").fill("3");
  await page.keyboard.press("Enter");
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="colours"]')).toBeVisible();
  expect(lab.complaints).toEqual([]);
});

test("a guess that is compared before its question is drawn gets its answer", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await open(page, "at=relief&stretch=0.5&slides");
  // The state that reveals the answer is the one in which the slide opens, so its drawing is known and shown at once.
  await dialog(page).evaluate((slides) => {
    slides.dispatchEvent(new KeyboardEvent("keydown", { key: "q" }));
    const form = slides.querySelector<HTMLFormElement>(".learn-guess[data-asked]");
    form?.querySelector("input")?.click();
    form?.requestSubmit();
  });
  await expect(asked(page).locator(".learn-answer")).not.toBeEmpty();
  expect(lab.complaints).toEqual([]);
});

test("the button names what the next press brings", async ({ lab, page, say }) => {
  await open(page, "at=grey&slides");
  const button = dialog(page).getByRole("button", { name: / \(Q\)$/ });
  const question = say("interface.slides.ask", "Question {number} (Q)");
  const sentence = say("interface.slides.sentence", "Sentence (Q)");
  await expect(button).toHaveText(question.replace("{number}", "1"));
  await button.click();
  await expect(button).toHaveText(say("interface.slides.exercise", "Exercise (Q)"));
  await button.click();
  await expect(button).toHaveText(sentence);
  await button.click();
  await expect(button).toHaveText(question.replace("{number}", "1"));
  await open(page, "at=relief&slides");
  await page.keyboard.press("q");
  await expect(button).toHaveText(question.replace("{number}", "2"));
  await page.keyboard.press("q");
  await expect(button).toHaveText(sentence);
  expect(lab.complaints).toEqual([]);
});

test("a link begins each slide with its question, whose answer no panel shows before the guess", async ({
  lab,
  page,
}) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await open(page, "slides=lambert,strips&ask");
  for (const [id, panel] of [
    ["lambert", "law"],
    ["strips", "map"],
  ] as const) {
    await expect(page.locator(`.learn-slide [data-lesson="${id}"]`)).toBeVisible();
    await expect(page).toHaveURL(new RegExp(`at=${id}.*&slides=lambert,strips&ask$`));
    await expect(asked(page)).toHaveCount(1);
    await expect(dialog(page).locator(".learn-gist")).toBeHidden();
    await settled(page);
    await expect(dialog(page).locator(`[data-panel="${panel}"]`)).toBeAttached();
    await expect(dialog(page).locator(`[data-panel="${panel}"]`)).toBeHidden();
    await guess(page);
    await expect(dialog(page).locator(`[data-panel="${panel}"]`)).toBeVisible();
    await page.keyboard.press("q");
    await expect(dialog(page).locator(".learn-gist")).toBeVisible();
    await page.keyboard.press("ArrowRight");
  }
  // Without that part of the link, a slide begins with its sentence.
  await open(page, "slides=lambert,strips");
  await expect(dialog(page).locator(".learn-gist")).toBeVisible();
  await expect(dialog(page).locator('[data-panel="law"]')).toBeVisible();
  expect(lab.complaints).toEqual([]);
});

test("the third lesson opens with two equal surfaces, so that its figure does not answer its question", async ({
  page,
}) => {
  await open(page, "at=relief");
  await expect(control(page, "stretch")).toHaveValue("1");
  await expect(page.locator('[data-number="paint"]')).toHaveAttribute("data-value", /^1(\.0+\d*)?$/);
});

test("a link followed while the slides close opens its lesson", async ({ lab, page }) => {
  await open(page, "at=grey&slides");
  await dialog(page).evaluate((slides: HTMLDialogElement) => {
    slides.close();
    location.hash = "#learn&at=colours&noise=0.1";
  });
  await expect(page.locator('[data-lesson="colours"].learn-lesson')).toBeVisible();
  await expect(control(page, "noise")).toHaveValue("0.1");
  await expect(page).toHaveURL(/at=colours/);
  expect(lab.complaints).toEqual([]);
});

test("a link hides every answer until a button or a key shows it", async ({ lab, page, say }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("./#learn&at=exercises&answers=hidden");
  const exercises = page.locator(".learn-exercises");
  await expect(exercises.locator("li").first()).toBeVisible();
  await expect(exercises.locator("details:visible")).toHaveCount(0);
  const show = say("interface.answers.show", "Show answers");
  const hide = say("interface.answers.hide", "Hide answers");
  await exercises.getByRole("button", { name: show }).click();
  await expect(exercises.locator("details:visible")).toHaveCount(5);
  await expect(page).not.toHaveURL(/answers/);
  await exercises.getByRole("button", { name: hide }).click();
  await expect(page).toHaveURL(/#learn&at=exercises&answers=hidden/);
  // They stay hidden on the way through the page, and after a reload.
  await page.locator('.learn-contents a[data-to="relief"]').click();
  await expect(page).toHaveURL(/answers=hidden/);
  await page.reload();
  const form = page.locator(".learn-guess").first();
  await form.locator("label").nth(1).click();
  await form.locator("button[type=submit]").click();
  await expect(form.locator(".learn-noted")).toHaveText(
    say("interface.guess.noted", "Your guess is noted. The answer is still hidden."),
  );
  await expect(form.locator(".learn-answer")).toBeEmpty();
  await expect(control(page, "stretch")).toHaveValue("1");
  await page.locator(".learn-text").getByRole("button", { name: show }).click();
  await expect(form.locator(".learn-answer")).not.toBeEmpty();
  await expect(control(page, "stretch")).toHaveValue("0.5");
  // The same on a slide, by a key.
  await page.goto("./#learn&at=pose&answers=hidden&slides");
  await expect(dialog(page)).toBeVisible();
  await page.keyboard.press("q");
  await guess(page);
  await expect(control(page, "run")).toHaveValue("hold");
  await expect(asked(page).locator(".learn-answer")).toBeHidden();
  await page.keyboard.press("a");
  await expect(asked(page).locator(".learn-answer")).toBeVisible();
  await expect(asked(page).locator(".learn-answer")).not.toBeEmpty();
  await expect(control(page, "run")).toHaveValue("register");
  await page.keyboard.press("a");
  await expect(asked(page).locator(".learn-answer")).toBeHidden();
  expect(lab.complaints).toEqual([]);
});

test(
  "each exercise is on a slide, with its states as buttons and an answer that a link hides",
  LONG,
  async ({ lab, page }) => {
    await page.emulateMedia({ reducedMotion: "reduce" });
    await open(page, "at=loop&answers=hidden&slides");
    await page.keyboard.press("q");
    await page.keyboard.press("q");
    await expect(exercise(page).locator("details")).toBeHidden();
    await expect(control(page, "offset")).toHaveValue("0");
    await exercise(page).locator("button").nth(1).click();
    await expect(control(page, "offset")).toHaveValue("20");
    await page.keyboard.press("a");
    await expect(exercise(page).locator("details p").first()).toBeVisible();
    await page.keyboard.press("a");
    await expect(exercise(page).locator("details p").first()).toBeHidden();
    await page.keyboard.press("a");
    await exercise(page).locator("summary").click();
    await expect(exercise(page).locator("details p").first()).toBeHidden();
    await expect(dialog(page).locator(".learn-figure")).toBeVisible();
    // The text of a lesson shows no exercise.
    await page.keyboard.press("Escape");
    await expect(page.locator(".learn-main .learn-asked")).toBeHidden();
    let found = 0;
    for (const id of LESSONS) {
      await open(page, `at=${id}`);
      found += await page.locator(".learn-asked").count();
    }
    expect(found).toBe(5);
    expect(lab.complaints).toEqual([]);
  },
);

test("a button above the exercises hides answers once one of them is open", async ({ page, say }) => {
  await page.goto("./#learn&at=exercises");
  const exercises = page.locator(".learn-exercises");
  const hide = exercises.getByRole("button", { name: say("interface.answers.hide", "Hide answers") });
  await expect(exercises.locator("summary").first()).toBeVisible();
  await expect(hide).toBeHidden();
  await exercises.locator("summary").first().click();
  await hide.click();
  await expect(page).toHaveURL(/#learn&at=exercises&answers=hidden/);
});

test("without the link there is no such button at a lesson or on a slide's sentence", async ({ page, say }) => {
  await open(page, "at=relief");
  await expect(page.getByRole("button", { name: say("interface.answers.hide", "Hide answers") })).toBeHidden();
  await page.getByRole("button", { name: say("interface.slides", "Slides") }).click();
  await expect(dialog(page)).toBeVisible();
  await expect(dialog(page).getByRole("button", { name: / \(A\)$/ })).toBeHidden();
});

test("a link without settings shows the lesson's own, whatever was set before", async ({ lab, page }) => {
  await open(page, "at=grey");
  const initial = await control(page, "turn").inputValue();
  await slide(page, "turn", 120);
  await settled(page);
  // The visitor's own ways keep the setting: another lesson and back, and a reload.
  await page.locator('.learn-contents a[data-to="colours"]').click();
  await expect(page.locator('[data-lesson="colours"].learn-lesson')).toBeVisible();
  await page.locator(".learn-ends a").first().click();
  await expect(control(page, "turn")).toHaveValue("120");
  await page.reload();
  await expect(control(page, "turn")).toHaveValue("120");
  await page.evaluate(() => (location.hash = "#learn&at=grey&slides"));
  await expect(dialog(page)).toBeVisible();
  await expect(control(page, "turn")).toHaveValue(initial);
  // The other slides begin with their own settings as well.
  await page.keyboard.press("Escape");
  await open(page, "at=colours&noise=0.1");
  await page.evaluate(() => (location.hash = "#learn&at=grey&slides"));
  await expect(dialog(page)).toBeVisible();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="colours"]')).toBeVisible();
  await expect(control(page, "noise")).not.toHaveValue("0.1");
  await slide(page, "noise", 0.07);
  await page.reload();
  await expect(control(page, "noise")).toHaveValue("0.07");
  expect(lab.complaints).toEqual([]);
});

test("slides are counted, chosen by a link in its order, and found in a list", async ({ lab, page, say }) => {
  await open(page, "slides=grey,strips,nothing,pose,strips");
  await expect(page.locator('.learn-slide [data-lesson="grey"]')).toBeVisible();
  await expect(count(page)).toHaveText(/^1 \/ 3/);
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="strips"]')).toBeVisible();
  await expect(page).toHaveURL(/at=strips(&lang=\w+)?&slides=grey,strips,pose$/);
  await page.keyboard.press("ArrowRight");
  await expect(count(page)).toHaveText(/^3 \/ 3/);
  await expect(page.getByRole("button", { name: say("interface.slides.next", "Next lesson") })).toBeDisabled();
  await page.reload();
  await expect(count(page)).toHaveText(/^3 \/ 3/);
  // The list: chosen slides first, in their order; a tick adds one, and a press goes there.
  await count(page).click();
  const rows = dialog(page).locator(".learn-overview li");
  await expect(rows).toHaveCount(LESSONS.length);
  await expect(rows.first()).toContainText(say("lessons.grey.title", "One grey light is not enough"));
  await expect(rows.nth(2).locator("input")).toBeDisabled();
  await rows
    .filter({ hasText: say("lessons.normal.title", "What a normal is") })
    .locator("input")
    .check();
  await expect(count(page)).toHaveText(/^3 \/ 4/);
  await rows.nth(1).locator("input").uncheck();
  await expect(page).toHaveURL(/&slides=grey,pose,normal$/);
  await rows
    .filter({ hasText: say("lessons.normal.title", "What a normal is") })
    .locator("button")
    .click();
  await expect(page.locator('.learn-slide [data-lesson="normal"]')).toBeVisible();
  await expect(dialog(page).locator(".learn-overview")).toBeHidden();
  await page.goBack();
  await expect(page.locator('.learn-slide [data-lesson="pose"]')).toBeVisible();
  // Escape closes the list before the slides. The button of a lesson shows the chosen slides again, because the lecture goes on with them.
  await count(page).click();
  await page.keyboard.press("Escape");
  await expect(dialog(page).locator(".learn-overview")).toBeHidden();
  await expect(dialog(page)).toBeVisible();
  await page.keyboard.press("Escape");
  const show = page.getByRole("button", { name: say("interface.slides", "Slides") });
  await show.click();
  await expect(count(page)).toHaveText(/^2 \/ 3/);
  await expect(page).toHaveURL(/&slides=grey,pose,normal$/);
  await count(page).click();
  await dialog(page)
    .getByRole("button", { name: say("interface.overview.all", "All"), exact: true })
    .click();
  await expect(count(page)).toHaveText(/ \/ 15/);
  await page.keyboard.press("Escape");
  await page.keyboard.press("Escape");
  // A lesson that was not chosen is shown among all.
  await open(page, "slides=grey,pose");
  await page.keyboard.press("Escape");
  await open(page, "at=strips");
  await show.click();
  await expect(count(page)).toHaveText(/^4 \/ 15/);
  await expect(page).toHaveURL(/&slides$/);
  expect(lab.complaints).toEqual([]);
});

test("a link that is followed before the slides report their end shows its lesson alone", async ({ lab, page }) => {
  const follow = async (hash: string) => {
    await closeSilently(dialog(page));
    await page.evaluate((hash) => (location.hash = hash), hash);
  };
  await open(page, "slides=grey,normal");
  await expect(page.locator('.learn-slide [data-lesson="grey"]')).toBeVisible();
  await follow("#learn&slides=normal,grey");
  await expect(page.locator('.learn-slide [data-lesson="normal"]')).toBeVisible();
  await reportEnd(dialog(page));
  await expect(page.locator('.learn-slide [data-lesson="normal"]')).toBeVisible();
  await follow("#learn&at=strips");
  await expect(page.locator('.learn-main > [data-lesson="strips"]')).toBeVisible();
  await reportEnd(dialog(page));
  await expect(page.locator('.learn-main > [data-lesson="strips"]')).toBeVisible();
  await expect(page.locator(".learn-lesson")).toHaveCount(1);
  expect(lab.complaints).toEqual([]);
});

test("an address brings the exercises in place of the slides", async ({ lab, page }) => {
  await open(page, "at=grey&slides");
  await page.keyboard.press("q");
  await expect(asked(page)).toHaveCount(1);
  await page.evaluate(() => (location.hash = "#learn&at=exercises"));
  await expect(page.locator(".learn-exercises")).toBeVisible();
  await reportEnd(dialog(page));
  await expect(page.locator(".learn-exercises")).toBeVisible();
  await expect(page).toHaveURL(/at=exercises/);
  await open(page, "at=grey");
  await expect(asked(page)).toHaveCount(0);
  expect(lab.complaints).toEqual([]);
});

test("the page for teachers is linked from the lessons and from the help", async ({ page, say }) => {
  const teachers = /\/docs\/guide\/learn\.md$/;
  await open(page, "at=normal");
  const link = page.locator(".learn-contents").getByRole("link", { name: say("interface.teachers", "For teachers") });
  await expect(link).toHaveAttribute("href", teachers);
  await page.locator("#help-button").click();
  const help = page.locator("#help").getByRole("link", { name: say("interface.teachers", "For teachers") });
  await expect(help).toBeVisible();
  await expect(help).toHaveAttribute("href", teachers);
});
