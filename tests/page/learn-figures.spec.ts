/** What the figures of the lessons draw for the sentences beside them, and how they mark numbers that are not up to date. */

import type { Page } from "@playwright/test";
import { LESSONS, open, slide } from "./figure";
import { LONG, expect, test } from "./lab";

/** The line of an ink in a panel, as its path. */
const line = (page: Page, panel: string, ink: string) =>
  page.locator(`[data-panel="${panel}"] path.learn-ink-${ink}:not(.halo)`);

test("8: the map has the curve of each colour, and they meet at the true normal", async ({ lab, page }) => {
  await open(page, "at=colours&colour=1&noise=0");
  const paths = async () => {
    const found: string[] = [];
    for (const ink of ["red", "green", "blue"]) {
      await expect(line(page, "landscape", ink)).toHaveCount(1);
      found.push((await line(page, "landscape", ink).getAttribute("d")) ?? "");
    }
    return found;
  };
  const coloured = await paths();
  for (const path of coloured) expect(path.length).toBeGreaterThan(100);
  expect(new Set(coloured).size).toBe(3);
  // Light of one colour leaves one curve.
  await slide(page, "colour", 0);
  await expect.poll(async () => new Set(await paths()).size).toBe(1);
  expect(lab.complaints).toEqual([]);
});

test("2: rays show the cone of the normals that have the chosen intensity", async ({ lab, page }) => {
  await open(page, "at=lambert");
  const rays = page.locator('[data-panel="ball"] .fine.learn-ink-normal');
  await expect(rays).toHaveCount(1);
  const path = (await rays.getAttribute("d")) ?? "";
  expect(path.match(/M50.00 50.00L/g)?.length).toBe(16);
  await slide(page, "level", 0.9);
  await expect.poll(() => rays.getAttribute("d")).not.toBe(path);
  expect(lab.complaints).toEqual([]);
});

/** Messages to the threads, held back until they are let go. */
async function holdRequests(page: Page): Promise<{ hold(): Promise<void>; release(): Promise<void> }> {
  await page.addInitScript(() => {
    const held: (() => void)[] = [];
    const state = { isHeld: false, held };
    Object.assign(window, { requests: state });
    const post = Worker.prototype.postMessage as (this: Worker, ...all: unknown[]) => void;
    Worker.prototype.postMessage = function (this: Worker, ...all: unknown[]) {
      if (state.isHeld) held.push(() => post.apply(this, all));
      else post.apply(this, all);
    };
  });
  const set = (isHeld: boolean) =>
    page.evaluate((isHeld) => {
      const { requests } = window as unknown as { requests: { isHeld: boolean; held: (() => void)[] } };
      requests.isHeld = isHeld;
      if (!isHeld) for (const send of requests.held.splice(0)) send();
    }, isHeld);
  return { hold: () => set(true), release: () => set(false) };
}

test("pictures that are soon computed do not fade, and numbers are marked at once", async ({ page }) => {
  await open(page, "at=surface");
  const fades = (selector: string, property: string) =>
    page
      .locator(selector)
      .first()
      .evaluate((each, property) => {
        each.closest("[aria-busy]")?.setAttribute("aria-busy", "true");
        const { transitionProperty, transitionDelay } = getComputedStyle(each);
        return transitionProperty === property ? Number.parseFloat(transitionDelay) : NaN;
      }, property);
  expect(await fades(".learn-panels .learn-canvas", "opacity")).toBeGreaterThanOrEqual(0.4);
  expect(await fades(".learn-numbers dd", "font-weight")).toBeLessThanOrEqual(0.2);
});

test("the figure follows a drag that is faster than its computation, marked as earlier", async ({ lab, page }) => {
  await open(page, "at=lambert");
  const seen = await page.locator('[data-number="angle"]').evaluate(async (number) => {
    const numbers = number.closest(".learn-numbers");
    const seen: string[] = [];
    const note = () =>
      seen.push(`${number.textContent}${numbers?.getAttribute("aria-busy") === "true" ? " earlier" : ""}`);
    new MutationObserver(note).observe(number, { childList: true, characterData: true, subtree: true });
    const slider = document.querySelector<HTMLInputElement>('.learn-controls [name="level"]');
    for (const level of ["0.5", "0.95"]) {
      if (slider) slider.value = level;
      slider?.dispatchEvent(new Event("input"));
    }
    while (!seen.some((each) => each.startsWith("18"))) await new Promise(requestAnimationFrame);
    return seen;
  });
  expect(seen).toEqual(["60° earlier", "18°"]);
  expect(lab.complaints).toEqual([]);
});

test("numbers lose their weight and pictures fade after a drag until the new ones are there", async ({ lab, page }) => {
  const requests = await holdRequests(page);
  const parts = [page.locator(".learn-figure .learn-numbers"), page.locator(".learn-figure .learn-panels")];
  await open(page, "at=surface&step=2");
  const number = page.locator('[data-number="jump"]');
  const picture = page.locator(".learn-panels .learn-canvas").first();
  const isCurrent = async () => {
    for (const part of parts) await expect(part).toHaveAttribute("aria-busy", "false");
    await expect(picture).toHaveCSS("opacity", "1");
    await expect(number).toHaveCSS("font-weight", "600");
  };
  await isCurrent();
  const before = await page.locator('[data-number="jump"]').textContent();
  await requests.hold();
  await slide(page, "step", 8);
  for (const part of parts) await expect(part).toHaveAttribute("aria-busy", "true");
  await expect.poll(() => picture.evaluate((each) => Number(getComputedStyle(each).opacity))).toBeLessThan(0.6);
  await expect(number).toHaveCSS("font-weight", "400");
  await expect(page.locator('[data-number="jump"]')).toHaveText(before ?? "?");
  // The controls are those of the new state already.
  await expect(page.locator(".learn-controls")).toHaveCSS("opacity", "1");
  await requests.release();
  await isCurrent();
  await expect(page.locator('[data-number="jump"]')).not.toHaveText(before ?? "?");
  expect(lab.complaints).toEqual([]);
});

/** Letters of the formulas that are not symbols: functions, indices of axes and of measured quantities. */
const PLAIN = new Set(["log", "max", "min", "grad", "information", "x", "y", "z", "S", "T"]);

test(
  "each symbol of a formula has its meaning below it, and the fourth lesson's all light a part of the figure",
  LONG,
  async ({ lab, page }) => {
    for (const id of LESSONS) {
      await open(page, `at=${id}`);
      const [unnamed, inFormula, listed] = await page.evaluate(() => {
        const symbols = (part: string) => [...document.querySelectorAll(`${part} [data-symbol]`)];
        const names = (part: string) => [...new Set(symbols(part).map((each) => each.getAttribute("data-symbol")))];
        const letters = [...document.querySelectorAll(".learn-formula mi")].filter(
          (mi) => !mi.closest("[data-symbol]"),
        );
        return [letters.map((mi) => mi.textContent ?? ""), names(".learn-formula"), names(".learn-symbols")] as const;
      });
      expect(
        unnamed.filter((letter) => !PLAIN.has(letter) && letter !== "j"),
        id,
      ).toEqual([]);
      // The text of lesson 6 names the whole light, of which its formula has the parts.
      const ofText = id === "pixel" ? ["L"] : [];
      expect(listed.filter((name) => name !== "j").sort(), id).toEqual([...inFormula, ...ofText].sort());
      if (unnamed.includes("j")) expect(listed, id).toContain("j");
      for (const item of await page.locator(".learn-symbols li").all())
        expect((await item.textContent())?.length).toBeGreaterThan(5);
    }
    await open(page, "at=strips");
    const symbols = page.locator(".learn-formula [data-symbol]");
    for (const symbol of await symbols.all()) {
      await symbol.hover();
      const name = await symbol.getAttribute("data-symbol");
      await expect(page.locator(".learn-figure .learn-lit").first(), name ?? "").toBeAttached();
      await page.locator(".learn-main h2").first().hover();
      await expect(page.locator(".learn-lit")).toHaveCount(0);
    }
    expect(lab.complaints).toEqual([]);
  },
);

/** The symbols before and after each light matrix in a formula. */
const besideLight = (page: Page) =>
  page
    .locator(".learn-formula [data-symbol=M]")
    .evaluateAll((all) =>
      all.map((light) =>
        [light.previousElementSibling, light.nextElementSibling].map((part) =>
          (part?.matches("[data-symbol]") ? part : part?.querySelector("[data-symbol]"))?.getAttribute("data-symbol"),
        ),
      ),
    );

test("no formula gives the plain normal to a 4 by 4 matrix, and no symbol has a hat", LONG, async ({ lab, page }) => {
  let count = 0;
  for (const id of LESSONS) {
    await open(page, `at=${id}`);
    for (const pair of await besideLight(page)) {
      // The refinement's normals, those of the depth, are extended as well.
      for (const name of pair) expect(name, id).toBe("N");
      count++;
    }
    expect(await page.locator(".learn-text mo").allTextContents(), id).not.toEqual(expect.arrayContaining(["^"]));
  }
  expect(count).toBeGreaterThan(5);
  expect(lab.complaints).toEqual([]);
});

test("4: strips and surface fit their frame together, from every side", async ({ lab, page }) => {
  for (const state of ["at=strips", "at=strips&dent=1"]) {
    await open(page, state);
    const panel = page.locator('[data-panel="cloud"]');
    const canvas = panel.locator("canvas");
    const drawnAt = () =>
      canvas.evaluate((each: HTMLCanvasElement) => {
        const { width, height } = each;
        const { data } = each.getContext("2d")?.getImageData(0, 0, width, height) ?? { data: [] };
        const points = Array.from({ length: width * height }, (_, at) => at).filter((at) => data[4 * at + 3] !== 0);
        const isAtEdge = (at: number) => {
          const [x, y] = [at % width, Math.floor(at / width)];
          return Math.min(x, y, width - 1 - x, height - 1 - y) < 2;
        };
        return { all: points.length, cut: points.filter(isAtEdge).length };
      });
    const first = await drawnAt();
    expect(first.all, state).toBeGreaterThan(1000);
    expect(first.cut, state).toBe(0);
    for (const turn of [-90, -50, 0, 90]) {
      await panel.locator("input").fill(String(turn));
      expect((await drawnAt()).cut, `${state}, turned by ${turn}°`).toBe(0);
    }
  }
  expect(lab.complaints).toEqual([]);
});

test("7: at half a turn the difference reads zero", async ({ lab, page }) => {
  await open(page, "at=grey&turn=180");
  await expect(page.locator('[data-number="difference"]')).toHaveText("0.0000");
  expect(lab.complaints).toEqual([]);
});

test("each lesson ends with its summary and what one can do now", LONG, async ({ page }) => {
  for (const id of LESSONS) {
    await open(page, `at=${id}`);
    const ending = page.locator(".learn-can p");
    await expect(ending).toHaveCount(2);
    await expect(ending.first()).toContainText((await page.locator(".learn-gist").textContent()) ?? "?");
    await expect(ending.last()).toContainText("Now: You can ");
  }
});
