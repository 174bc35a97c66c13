/** A lecture with the slides: questions to the class, answers that a link hides, chosen slides, and figures that are there at once. */

import type { Page } from "@playwright/test";
import { LESSONS, control, figure, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";
import { type SlideText, textsIn, tooSmall } from "./slide-text";

const dialog = (page: Page) => page.locator("dialog.learn-slides");
const asked = (page: Page) => dialog(page).locator(".learn-guess[data-asked]");
/** The exercise on a slide. */
const exercise = (page: Page) => dialog(page).locator(".learn-asked[data-asked]");
const count = (page: Page) => dialog(page).locator(".learn-count");

/** Guesses the first choice or a number, and compares. */
async function guess(page: Page): Promise<void> {
  const form = asked(page);
  const typed = form.locator("input[type=number]");
  if ((await typed.count()) > 0) await typed.fill("3");
  else await form.locator("label").first().click();
  await form.locator("button[type=submit]").click();
}

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

test("a slide does not wait for the figure of the slide before", async ({ lab, page }) => {
  // A thread that computes the pose never answers, and takes no other request either.
  await page.addInitScript(() => {
    const post = Worker.prototype.postMessage as (this: Worker, ...all: unknown[]) => void;
    const stuck = new WeakSet<Worker>();
    Worker.prototype.postMessage = function (this: Worker, ...all: unknown[]) {
      const [request] = all as [{ lesson?: string }];
      if (request.lesson === "pose") stuck.add(this);
      if (!stuck.has(this)) post.apply(this, all);
    };
  });
  await page.goto("./#learn&at=pose&slides");
  await expect(page.locator('.learn-slide [data-lesson="pose"]')).toBeVisible();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator('.learn-slide [data-lesson="loop"]')).toBeVisible();
  await settled(page);
  await expect(page.locator(".learn-slide .learn-blank")).toHaveCount(0);
  expect(lab.complaints).toEqual([]);
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
  await expect(dialog(page).getByRole("button", { name: show })).toBeVisible();
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
    await exercise(page).locator("summary").click();
    await expect(exercise(page).locator("details p").first()).toBeVisible();
    await page.keyboard.press("a");
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

test("without the link there is no such button at a lesson, and answers are shown", async ({ page, say }) => {
  await open(page, "at=relief");
  await expect(page.getByRole("button", { name: say("interface.answers.hide", "Hide answers") })).toBeHidden();
  await page.getByRole("button", { name: say("interface.slides", "Slides") }).click();
  await expect(dialog(page)).toBeVisible();
  await expect(dialog(page).locator(".learn-slide-bar .learn-answers")).toBeHidden();
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

/** Holds back every message to a thread of Learn until `go` is called, and counts complete figures. */
async function watchThreads(page: Page, isHeld: boolean): Promise<void> {
  await page.addInitScript((isHeld) => {
    const state = { done: 0, held: isHeld ? ([] as (() => void)[]) : undefined };
    Object.assign(window, {
      threads: state,
      go: () => {
        const held = state.held ?? [];
        state.held = undefined;
        for (const pass of held) pass();
      },
    });
    const Own = Worker;
    window.Worker = class extends Own {
      constructor(...all: ConstructorParameters<typeof Worker>) {
        super(...all);
        this.addEventListener("message", ({ data }: MessageEvent<{ done?: boolean }>) => {
          if (data.done) state.done++;
        });
      }
      override postMessage(message: unknown): void {
        const pass = () => super.postMessage(message);
        if (state.held) state.held.push(pass);
        else pass();
      }
    };
  }, isHeld);
}

const boxes = (page: Page): Promise<number[]> =>
  page
    .locator(".learn-slide :is(h2, .learn-gist, .learn-formula, .learn-figure, .learn-controls, .learn-numbers)")
    .evaluateAll((all) =>
      all.flatMap((each) => {
        const { left, top, width, height } = each.getBoundingClientRect();
        return [left, top, width, height].map(Math.round);
      }),
    );

test("a slide has its text and the frame of its figure before anything is computed", LONG, async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await watchThreads(page, true);
  for (const id of LESSONS) {
    await page.goto("about:blank");
    await page.goto(`./#learn&at=${id}&slides`);
    await expect(page.locator(".learn-slide .learn-blank").first()).toBeVisible();
    await expect(page.locator(".learn-computing").first()).toBeVisible();
    const [before, panels] = [await boxes(page), await page.locator(".learn-blank").count()];
    await page.evaluate(() => (window as unknown as { go(): void }).go());
    await settled(page);
    await expect(page.locator(".learn-blank")).toHaveCount(0);
    expect(await page.locator(".learn-slide .learn-panel").count(), id).toBe(panels);
    expect(await boxes(page), id).toEqual(before);
  }
  expect(lab.complaints).toEqual([]);
});

test("the next slide's figure is computed in advance, and is there at once", async ({ lab, page }) => {
  await watchThreads(page, false);
  const done = () => page.evaluate(() => (window as unknown as { threads: { done: number } }).threads.done);
  await open(page, "at=relief&slides");
  await expect.poll(done).toBe(2);
  const isBusy = await page.locator(".learn-slide").evaluate((holder) => {
    const key = new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true });
    holder.querySelector("h2")?.dispatchEvent(key);
    return [holder.querySelector("[data-lesson]")?.getAttribute("data-lesson"), holder.querySelector(".learn-blank")];
  });
  expect(isBusy).toEqual(["strips", null]);
  await expect(figure(page)).toHaveAttribute("aria-busy", "false");
  // A drag changes the figure as on any slide.
  await slide(page, "lx", 0.1);
  await settled(page);
  expect(lab.complaints).toEqual([]);
});

test("plots of slides are legible: 200 px wide at least, and pictures 128 px", LONG, async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  for (const id of LESSONS) {
    await open(page, `at=${id}&slides`);
    await expect(figure(page)).toHaveAttribute("aria-busy", "false");
    const widths = (selector: string) =>
      page.locator(selector).evaluateAll((all) => all.map((each) => each.getBoundingClientRect().width));
    for (const width of await widths(".learn-slide .learn-plot")) expect(width, id).toBeGreaterThanOrEqual(200);
    for (const width of await widths(".learn-slide .learn-canvas")) expect(width, id).toBeGreaterThanOrEqual(128);
  }
});

test("a slide lists the symbols of its formula if the pictures stay large", async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  const symbols = dialog(page).locator(".learn-symbols");
  for (const id of ["normal", "lambert", "relief", "grey", "colours", "surface"]) {
    await open(page, `at=${id}&slides`);
    await expect(symbols, id).toBeVisible();
  }
  await page.keyboard.press("q");
  await expect(symbols).toBeHidden();
  // Eight symbols would take three lines from four pictures.
  await open(page, "at=strips&slides");
  await expect(symbols).toBeHidden();
});

test("pictures of slides take the room that is free", LONG, async ({ page }) => {
  for (const [width, height] of [
    [1280, 720],
    [1920, 1080],
  ] as const) {
    await page.setViewportSize({ width, height });
    for (const id of LESSONS) {
      await open(page, `at=${id}&slides`);
      await expect(figure(page)).toHaveAttribute("aria-busy", "false");
      const { small, below } = await figure(page).evaluate((card) => {
        const bottom = (part: Element) => part.getBoundingClientRect().bottom;
        const lowest = Math.max(...[...card.querySelectorAll(".learn-panel > :last-child")].map(bottom));
        const isSmall = (canvas: HTMLElement) => {
          const { clientWidth = 0, clientHeight = 0 } = canvas.parentElement ?? {};
          return canvas.clientWidth < Math.min(clientWidth, clientHeight) - 1;
        };
        const pictures = [...card.querySelectorAll<HTMLElement>(".learn-canvas")];
        return { small: pictures.filter(isSmall).length, below: bottom(card) - lowest };
      });
      expect(small, `${id} at ${width} px`).toBe(0);
      expect(below, `${id} at ${width} px`).toBeLessThan(0.03 * height);
    }
  }
});

/** Contrast of two colours by the definition of WCAG 2. */
function contrast(a: string, b: string): number {
  const luminance = (colour: string): number => {
    const [red = 0, green = 0, blue = 0] = (colour.match(/[\d.]+/g) ?? []).map(Number).map((value) => {
      const share = value / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const [dark = 0, light = 0] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (light + 0.05) / (dark + 0.05);
}

test("strips and isophotes stand out from white and from black parts of a picture", async ({ page }) => {
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    for (const id of ["lambert", "strips"]) {
      await open(page, `at=${id}`);
      const strokes = await page
        .locator(".learn-mark.fine")
        .evaluateAll((all) => [...new Set(all.map((each) => getComputedStyle(each).stroke))]);
      expect(strokes.length, id).toBeGreaterThan(0);
      for (const stroke of strokes)
        for (const ground of ["rgb(255, 255, 255)", "rgb(0, 0, 0)"])
          expect(contrast(stroke, ground), `${id}, ${colorScheme}: ${stroke}`).toBeGreaterThanOrEqual(3);
    }
  }
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

test("formulas have no sign that only a mathematics font has", LONG, async ({ page }) => {
  for (const id of LESSONS) {
    await open(page, `at=${id}`);
    const found = await page.locator(".learn-text math").evaluateAll((all) => {
      // A browser writes letters of the mathematical block of Unicode for "math-auto".
      const others = [...all]
        .flatMap((each) => [...each.querySelectorAll("mi")])
        .filter((each) => {
          const isLetter = (each.textContent ?? "").length === 1;
          return isLetter && getComputedStyle(each).textTransform !== "none";
        });
      const raised = [...all]
        .flatMap((each) => [...each.querySelectorAll("msup")])
        .filter((each) => {
          return each.lastElementChild?.textContent === "′";
        });
      const signs = [...all].map((each) => each.textContent ?? "").join("");
      return { others: others.length, raised: raised.length, signs: [...new Set(signs)].join("") };
    });
    // Latin and Greek letters, and the signs that Liberation and DejaVu have alike.
    expect(found.signs, id).toMatch(/^[ -~À-ÿΑ-ω·′−∑∂≈→\s]*$/);
    expect([found.others, found.raised], id).toEqual([0, 0]);
  }
});
