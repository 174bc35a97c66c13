/** Numbers of the method that the lessons state, against its source; tests/contract/lesson-claims.test.mjs has what the figures show. */

import { readFile } from "node:fs/promises";
import type { Page } from "@playwright/test";
import { number, open } from "./figure";
import { LONG, expect, test } from "./lab";

/** A figure's numbers in one of its states. */
async function numbers<K extends string>(page: Page, state: string, ...keys: K[]): Promise<Record<K, number>> {
  // Without settings in the address, a lesson keeps its last state; on a reloaded page it has its initial state.
  if (!state.includes("&")) await page.goto("about:blank");
  await open(page, `at=${state}`);
  const found: [K, number][] = [];
  for (const key of keys) found.push([key, await number(page, key)]);
  return Object.fromEntries(found) as Record<K, number>;
}

const status = (page: Page) => page.locator('[data-number="status"]');
const source = (path: string) => readFile(new URL(`../../${path}`, import.meta.url), "utf8");

test(
  "15: the line between ambiguous and lost is where the text says, and the figures keep to it",
  LONG,
  async ({ page }) => {
    const verdict = await source("src/estimator/ending/verdict.rs");
    const doubtful = Number(/^ {12}tolerance: ([\d.]+),$/m.exec(await source("src/options.rs"))?.[1]);
    const [largest, unobservable] = ["LOST_SIGMA", "UNOBSERVABLE"].map((name) =>
      Number(new RegExp(`const ${name}: f64 = ([\\d.]+);`).exec(verdict)?.[1]),
    ) as [number, number];
    // States in which the sigma decides. Between them, albedo that does not fit is another reason.
    for (const state of ["overlap&amount=0", "turn&amount=100", "texture&amount=75"]) {
      const { sigma } = await numbers(page, `failure&case=${state}`, "sigma");
      await expect(status(page), state).toHaveText(
        sigma > largest ? /^lost: / : sigma > doubtful ? /^ambiguous: / : "converged",
      );
    }
    for (const words of [
      `Above ${doubtful}° the status is ambiguous`,
      `Above ${largest}° it is lost`,
      `Above ${unobservable}° the rotation counts as not observable`,
    ])
      await expect(page.locator(".learn-text")).toContainText(words);
  },
);

test("numbers that the text states of the method are the method's own", LONG, async ({ page }) => {
  const shading = await source("src/shape/pixels/shading.rs");
  const constant = (name: string) => Number(new RegExp(`const ${name}: \\w+ = ([\\d.]+);`).exec(shading)?.[1]);
  await open(page, "at=colours");
  await expect(page.locator(".learn-text")).toContainText(`compares ${constant("DIRECTIONS")} directions`);
  await page.goto("./#learn&at=exercises");
  const ignored = ((constant("PRIOR_SCALE") * 180) / Math.PI).toFixed(0);
  await answers(page, `beyond about ${ignored}°`);
  const { OPTIONS } = (await import("../../pkg/options.js")) as {
    OPTIONS: {
      lambda: { members: { prior: { default: number } } };
      startTolerance: { members: { degrees: { default: number } } };
      tolerance: { default: number };
    };
  };
  await answers(page, `ambiguous once sigma exceeds ${OPTIONS.tolerance.default}°`);
  await answers(page, `the program uses ${OPTIONS.lambda.members.prior.default} against`);
  await open(page, "at=loop");
  await expect(page.locator(".learn-text")).toContainText(`more than about ${ignored}° off is ignored`);
  await open(page, "at=pose");
  await expect(page.locator(".learn-text")).toContainText(
    `turn at most ${OPTIONS.startTolerance.members.degrees.default}° from this given pose`,
  );
  const noise = Number(/noise: ([\d.]+)/.exec(await source("www/learn/compute/prior.ts"))?.[1]);
  await open(page, "at=prior");
  await expect(page.locator(".learn-text")).toContainText(new RegExp(`${100 * noise}\\s% noise`));
});

/** The answers, which are collapsed at first. */
const answers = (page: Page, words: string) => expect(page.locator(".learn-exercises")).toContainText(words);
