/** Checks the statements of the lessons about their figures, sentence by sentence, with computed numbers. */

import { readFile } from "node:fs/promises";
import type { Page } from "@playwright/test";
import { number, open, slide } from "./figure";
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

test("2: flat there is nothing to tell apart, under any lamp", async ({ page }) => {
  for (const turn of [0, 60, 180])
    expect((await numbers(page, `grey&height=0&turn=${turn}`, "difference")).difference).toBeLessThan(1e-6);
});

test("3: the window's curve stays long at full colour, and a little noise moves its normals by tens of degrees", async ({
  page,
}) => {
  const lamps = await numbers(page, "colours&colour=1", "explained", "degrees");
  const window = await numbers(page, "colours&colour=1&light=window", "explained", "degrees");
  expect(window.explained).toBeGreaterThan(10 * lamps.explained);
  expect(window.degrees).toBeGreaterThan(10);
  const noisy = await numbers(page, "colours&colour=1&light=window&noise=0.03", "degrees");
  expect(noisy.degrees).toBeGreaterThan(20);
  expect((await numbers(page, "colours&colour=1&noise=0.03", "degrees")).degrees).toBeLessThan(0.1 * noisy.degrees);
});

test("3: noise may give a pixel a colour that no normal has, and then the lowest valley is off by more than what counts", async ({
  page,
}) => {
  const noisy = await numbers(
    page,
    "colours&light=overcast&colour=0.7&noise=0.05&px=0.82&py=0.8",
    "explained",
    "off",
    "good",
  );
  expect(noisy).toMatchObject({ explained: 0, good: 1 });
  expect(noisy.off).toBeGreaterThan(2);
  await slide(page, "noise", 0);
  expect(await number(page, "explained")).toBeGreaterThan(0);
  expect(await number(page, "off")).toBeLessThan(2);
});

test("4: the height found lags behind the step, cut through it is wrong either way, and noise makes the dome too high", async ({
  page,
}) => {
  for (const step of [3, 6, 12])
    expect((await numbers(page, `surface&step=${step}&robust=0`, "jump")).jump).toBeLessThan(0.8 * step);
  const [robust, plain] = [
    await numbers(page, "surface&step=6", "error"),
    await numbers(page, "surface&step=6&robust=0", "error"),
  ];
  expect(robust.error).toBeLessThan(0.6 * plain.error);
  for (const weights of [0, 1])
    expect((await numbers(page, `surface&step=6&through=1&robust=${weights}`, "jump")).jump).toBeLessThan(4);
  expect((await numbers(page, "surface&step=0", "kept")).kept).toBeCloseTo(100, -1);
  const [some, much] = [
    await numbers(page, "surface&step=0&noise=0.1", "kept"),
    await numbers(page, "surface&step=0&noise=0.2", "kept"),
  ];
  expect(some.kept).toBeGreaterThan(101);
  expect(much.kept).toBeGreaterThan(some.kept + 3);
});

test(
  "5: the first priors help more than in proportion, coloured lamps hardly need any, and a heavy one is copied",
  LONG,
  async ({ page }) => {
    const at = async (state: string) => (await numbers(page, `prior&${state}`, "degrees")).degrees;
    const [none, fifth, all] = [await at("share=0"), await at("share=20"), await at("share=100")];
    expect(none - fifth).toBeGreaterThan(0.3 * (none - all));
    const [lamps, told] = [await at("share=0&light=colourful"), await at("share=100&light=colourful")];
    expect(lamps - told).toBeLessThan(0.1 * lamps);
    expect(await at("share=100&weight=1")).toBeLessThan(0.2);
  },
);

test(
  "6: with a wrong pose the valleys merge near the wrong normal, and a robust prior that is far off loses its hold",
  LONG,
  async ({ page }) => {
    const wrong = await numbers(page, "pose&offset=20&weight=1", "minima", "off", "end");
    expect(wrong.minima).toBe(1);
    expect(wrong.end).toBeGreaterThan(0.8 * wrong.off);
    // With the module's own weight.
    const [plain, robust] = [
      await numbers(page, "pose&offset=40&weight=-1.3", "off", "end"),
      await numbers(page, "pose&offset=40&weight=-1.3&robust=1", "end"),
    ];
    expect(plain.off).toBeGreaterThan(23);
    expect(plain.end).toBeGreaterThan(20);
    expect(robust.end).toBeLessThan(0.3 * plain.end);
  },
);

test("6: registration comes home from 20 degrees away on either side", async ({ page }) => {
  for (const offset of [20, -20]) {
    expect((await numbers(page, `pose&offset=${offset}&run=register`, "error")).error).toBeLessThan(1);
    await expect(status(page)).toHaveText("converged");
  }
});

test("7: the refined normals hold where the sensor's get rough, and depth gains as well", async ({ page }) => {
  const quiet = await numbers(page, "sensor", "before", "after", "normalsBefore", "normalsAfter");
  const rough = await numbers(page, "sensor&noise=1", "before", "after", "normalsBefore", "normalsAfter");
  for (const { before, after, normalsBefore, normalsAfter } of [quiet, rough]) {
    expect(after).toBeLessThan(0.5 * before);
    expect(normalsAfter).toBeLessThan(0.5 * normalsBefore);
  }
  expect(rough.normalsBefore).toBeGreaterThan(1.5 * quiet.normalsBefore);
  expect(rough.normalsAfter).toBeLessThan(1.2 * quiet.normalsAfter);
  expect((await numbers(page, "sensor&holes=40", "filled")).filled).toBeGreaterThan(90);
});

test("8: under coloured lamps hue says less, and the normals are worse", async ({ page }) => {
  const [window, lamps] = [
    await numbers(page, "paint", "likeness", "degrees"),
    await numbers(page, "paint&light=colourful", "likeness", "degrees"),
  ];
  // The text states the direction; a difference of a twentieth is visible.
  expect(lamps.degrees).toBeGreaterThan(1.05 * window.degrees);
  expect(lamps.likeness).toBeLessThan(window.likeness);
});

test(
  "9: print and a quarter turn leave too little, the round disc warns by its sigma and rivals, not by its residual",
  LONG,
  async ({ page }) => {
    const [bare, printed] = [
      await numbers(page, "failure&case=texture&amount=0", "residual"),
      await numbers(page, "failure&case=texture&amount=100", "residual"),
    ];
    expect(printed.residual).toBeGreaterThan(1.5 * bare.residual);
    await expect(status(page)).toHaveText(
      /^lost: the rotation is uncertain by \d+ degrees \(one sigma\): rotation about [xyz]$/,
    );
    const [beside, turned] = [
      await numbers(page, "failure&case=turn&amount=0", "sigma"),
      await numbers(page, "failure&case=turn&amount=100", "sigma"),
    ];
    expect(turned.sigma).toBeGreaterThan(5 * beside.sigma);
    await expect(status(page)).toHaveText(/^(lost|ambiguous): .+/);
    const good = await numbers(page, "failure&case=symmetry&amount=0", "residual", "sigma", "rivals");
    const round = await numbers(page, "failure&case=symmetry&amount=100", "residual", "sigma", "rivals");
    expect(round.residual).toBeLessThan(1.2 * good.residual);
    expect(round.sigma).toBeGreaterThan(20 * good.sigma);
    expect([good.rivals, round.rivals > 0]).toEqual([0, true]);
  },
);

test(
  "9: the line between ambiguous and lost is where the text says, and the figures keep to it",
  LONG,
  async ({ page }) => {
    const verdict = await source("src/estimator/verdict.rs");
    const doubtful = Number(/^ {12}tolerance: ([\d.]+),$/m.exec(await source("src/options.rs"))?.[1]);
    const [largest, unobservable] = ["LARGEST_SIGMA", "UNOBSERVABLE"].map((name) =>
      Number(new RegExp(`const ${name}: f64 = ([\\d.]+);`).exec(verdict)?.[1]),
    ) as [number, number];
    for (const state of ["overlap&amount=0", "overlap&amount=100", "texture&amount=50"]) {
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
  await answers(page, `beyond about ${((constant("PRIOR_SCALE") * 180) / Math.PI).toFixed(0)}°`);
  const { OPTIONS } = (await import("../../pkg/options.js")) as {
    OPTIONS: {
      lambda: { members: { prior: { default: number } } };
      startTolerance: { members: { degrees: { default: number } } };
      tolerance: { default: number };
    };
  };
  await answers(page, `ambiguous once sigma exceeds ${OPTIONS.tolerance.default}°`);
  await answers(page, `the program uses ${OPTIONS.lambda.members.prior.default} against`);
  await open(page, "at=pose");
  await expect(page.locator(".learn-text")).toContainText(
    `within ${OPTIONS.startTolerance.members.degrees.default}° of it`,
  );
  const noise = Number(/noise: ([\d.]+)/.exec(await source("www/learn/compute/prior.ts"))?.[1]);
  await open(page, "at=prior");
  await expect(page.locator(".learn-text")).toContainText(new RegExp(`${100 * noise}\\s% noise`));
});

/** The answers, which are collapsed at first. */
const answers = (page: Page, words: string) => expect(page.locator(".learn-exercises")).toContainText(words);
