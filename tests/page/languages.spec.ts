/** Learn in other languages: the choice of a language, no remaining English, and room for longer words. */

import type { Page } from "@playwright/test";
import { LESSONS, control, open, settled } from "./figure";
import { LONG, expect, test } from "./lab";
import { LANGUAGES, sayIn } from "./language";
import { atWidths, narrowest } from "./widths";

const say = sayIn("de");
const language = (page: Page) => page.locator(".learn-language");
const shows = async (page: Page, code: string, title: string): Promise<void> => {
  await expect(page.locator(".learn-lesson h2")).toContainText(title);
  await expect(page.locator("html")).toHaveAttribute("lang", code);
};

test("the language is chosen by hand, remembered, and part of the address", async ({ lab, page }) => {
  await open(page, "at=grey&turn=90");
  await shows(page, "en", "One grey light");
  await expect(page).not.toHaveURL(/lang/);
  await language(page).selectOption("de");
  await shows(page, "de", say("lessons.grey.title", ""));
  await expect(page).toHaveURL(/at=grey&turn=90&lang=de$/);
  await expect(control(page, "turn")).toHaveValue("90");
  await expect(language(page)).toBeFocused();
  await expect(page).toHaveTitle(`${say("interface.learn", "")}, bimodal-stereo`);
  // If the address names no language, the page keeps the chosen one.
  await page.goto("about:blank");
  await open(page, "at=grey");
  await shows(page, "de", say("lessons.grey.title", ""));
  await language(page).selectOption("en");
  await shows(page, "en", "One grey light");
  await expect(page).not.toHaveURL(/lang/);
  expect(lab.complaints).toEqual([]);
});

test("a link brings its language, and the other parts of the page stay English", async ({ lab, page }) => {
  await open(page, "at=pixel&lang=de");
  await shows(page, "de", say("lessons.pixel.title", ""));
  await expect(page.locator("#to-learn")).toHaveText(say("interface.learn", ""));
  // A number, its sign and its unit, as the language writes them.
  await expect(page.locator('[data-number="red"]')).toHaveText(/^[−]?\d,\d{3}$/);
  await page.locator("#to-lab").click();
  await lab.reaches("ready");
  await expect(page.locator("html")).toHaveAttribute("lang", "en");
  await expect(page.locator("#to-learn")).toHaveText("Learn");
  await expect(page.locator("#theme")).toHaveAccessibleName(/^Switch to the/);
  await expect(page).toHaveTitle("bimodal-stereo");
  await page.locator("#to-learn").click();
  await shows(page, "de", say("lessons.pixel.title", ""));
  await expect(page.locator("#theme")).toHaveAccessibleName(
    new RegExp(say("interface.theme.light", "").split(" ")[0] ?? ""),
  );
  // The page ignores an unknown language.
  await page.goto("about:blank");
  await open(page, "at=pixel&lang=xx");
  await shows(page, "en", "What a pixel shows");
  expect(lab.complaints).toEqual([]);
});

test("without a choice the browser's languages decide, unless the address says otherwise", async ({
  browser,
  baseURL,
}) => {
  for (const [locale, code] of [
    ["de-AT", "de"],
    ["fr-FR", "en"],
    ["en-GB", "en"],
  ] as const) {
    const context = await browser.newContext({ locale, ...(baseURL ? { baseURL } : {}) });
    const page = await context.newPage();
    await page.goto("./#learn&at=pixel");
    await expect(page.locator(".learn-lesson")).toBeVisible();
    await expect(page.locator("html"), locale).toHaveAttribute("lang", code);
    await page.goto("./#learn&at=pixel&lang=en");
    await shows(page, "en", "What a pixel shows");
    await context.close();
  }
});

test("a catalogue that can't be loaded leaves the page in English", async ({ page }) => {
  await page.route(/\/de-[^/]*\.js$/, (route) => route.abort());
  await page.goto("./#learn&at=pixel&lang=de");
  await expect(page.locator(".learn-lesson h2")).toContainText("What a pixel shows");
  await expect(page.locator("html")).toHaveAttribute("lang", "en");
});

test("a guess is compared in the language of the page, with its numbers as that writes them", async ({ page }) => {
  await open(page, "at=relief&lang=de");
  const guess = page.locator(".learn-guess").first();
  await guess.getByLabel(say("lessons.relief.guesses.0.choices.0", "")).check();
  await guess.getByRole("button", { name: say("interface.guess.compare", "") }).click();
  const chose = say("interface.guess.chose", "").replace("{guess}", say("lessons.relief.guesses.0.choices.0", ""));
  await expect(guess.getByRole("status")).toContainText(chose);
  await expect(guess.getByRole("status")).toContainText(say("lessons.relief.guesses.0.answer", ""));
  await open(page, "at=surface");
  const number = page.locator(".learn-guess").first();
  await number.getByLabel(say("interface.guess.yours", "")).fill("7.5");
  await number.getByRole("button", { name: say("interface.guess.compare", "") }).click();
  await expect(number.getByRole("status")).toContainText(say("interface.guess.chose", "").replace("{guess}", "7,5 px"));
});

/** All visible or announced texts of Learn, except those marked as English, such as titles of papers and headings of documents. */
const read = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const parts = [
      ...document.querySelectorAll(".top, #learn, .about, #help[open] :is([data-place='learn'], #help-title, form)"),
    ];
    const own = (element: Element) => {
      const marked = element.closest("[lang]");
      return !marked || marked === document.documentElement;
    };
    return parts.flatMap((part) =>
      [part, ...part.querySelectorAll("*")].filter(own).flatMap((element) => {
        const texts = [...element.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE);
        const attributes = ["aria-label", "aria-valuetext", "title", "alt"].map(
          (name) => element.getAttribute(name) ?? "",
        );
        return [...texts.map((text) => text.textContent ?? ""), ...attributes].filter((words) => words.trim() !== "");
      }),
    );
  });

/** Words that occur in nearly every English sentence and in no German one, and words of English labels. */
const ENGLISH =
  /\b(?:the|of|and|with|is|are|to|by|for|at|light|picture|depth|height|column|error|share|true|found|bump|dent|unit|normals?|noise|remainder|show|close|copy|iteration \d+ of)\b/i;

for (const code of LANGUAGES)
  test.describe(() => {
    test.use({ locale: code });

    test(`no English is left, ${code}`, LONG, async ({ page }) => {
      const states = ["pose&run=register&offset=40", "failure&case=symmetry&amount=100", "failure&case=turn"];
      for (const state of [...LESSONS, ...states]) {
        await open(page, `at=${state}`);
        const words = await read(page);
        expect(words.length, state).toBeGreaterThan(60);
        expect(
          words.filter((each) => ENGLISH.test(each)),
          state,
        ).toEqual([]);
      }
      await page.goto("./#learn&at=exercises");
      await expect(page.locator(".learn-exercises")).toBeVisible();
      await page.locator("#help-button").click();
      expect((await read(page)).filter((each) => ENGLISH.test(each))).toEqual([]);
    });

    test(`no caption, label, number or choice is cut off from 320 to 2560 px, ${code}`, LONG, async ({ page }) => {
      await page.setViewportSize(narrowest);
      for (const id of LESSONS) {
        await open(page, `at=${id}`);
        await atWidths(page, [320, 390, 700, 1280, 1440, 1920, 2560], async (width) => {
          await settled(page);
          expect(await cut(page), `${id} at ${width} px`).toEqual([]);
        });
      }
    });
  });

/** Texts that are cut off, including selects that are narrower than their longest choice. */
const cut = (page: Page): Promise<string[]> =>
  page.locator("#learn").evaluate((learn) => {
    const boxes = [
      ...learn.querySelectorAll<HTMLElement>("figcaption, dt, dd, label, output, button, h2, p:not(.alert)"),
    ];
    const wide = boxes.filter(({ scrollWidth, clientWidth }) => clientWidth > 0 && scrollWidth > clientWidth + 1);
    const narrow = [...learn.querySelectorAll("select")].filter((select) => {
      const free = select.cloneNode(true) as HTMLSelectElement;
      free.style.cssText = "position: absolute; width: auto; visibility: hidden";
      select.after(free);
      const wanted = free.offsetWidth;
      free.remove();
      return wanted > select.offsetWidth + 1;
    });
    return [...wide.map((box) => box.textContent ?? ""), ...narrow.map(({ name, value }) => `${name}: ${value}`)];
  });
