/** The figures and formulas of slides: there at once, as large as the slide allows, and legible. */

import type { Page } from "@playwright/test";
import { LESSONS, figure, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";

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

test("on a phone the formula of a slide stands below its sentence, which has the whole width", async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  for (const id of ["normal", "strips", "colours"]) {
    await open(page, `at=${id}&slides`);
    const boxOf = async (part: string) =>
      (await page.locator(`.learn-slide ${part}`).boundingBox()) ?? { y: 0, width: 0, height: 0 };
    const [sentence, formula] = [await boxOf(".learn-gist"), await boxOf(".learn-formula")];
    expect(sentence.width, id).toBeGreaterThan(300);
    expect(formula.y, id).toBeGreaterThanOrEqual(sentence.y + sentence.height);
  }
});

test("a slide lists the symbols of its formula if the pictures stay large", async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  const symbols = page.locator(".learn-slide .learn-symbols");
  for (const id of ["normal", "lambert", "relief", "grey", "colours", "surface"]) {
    await open(page, `at=${id}&slides`);
    await expect(symbols, id).toBeVisible();
    // The choice is the same when it is made again, with the figure drawn.
    await expect(figure(page)).toHaveAttribute("aria-busy", "false");
    await page.setViewportSize({ width: 1281, height: 720 });
    await page.evaluate(() => new Promise(requestAnimationFrame));
    await expect(symbols, `${id} after its figure`).toBeVisible();
    await page.setViewportSize({ width: 1280, height: 720 });
  }
  await page.keyboard.press("q");
  await expect(symbols).toBeHidden();
  // Eight symbols would take three lines from four pictures. They appear over the controls while the formula is pointed at or focused.
  await open(page, "at=strips&slides");
  await expect(symbols).toBeHidden();
  const formula = page.locator(".learn-slide .learn-formula");
  await formula.hover();
  await expect(symbols).toBeVisible();
  await page.mouse.move(0, 0);
  await expect(symbols).toBeHidden();
  await formula.focus();
  await expect(symbols).toBeVisible();
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

test("the line of each colour stands out from both ends of the map's colours and from its own edge", async ({
  page,
}) => {
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    await open(page, "at=colours");
    for (const ink of ["red", "green", "blue"]) {
      const line = page.locator(`[data-panel="landscape"] .learn-mark.learn-ink-${ink}:not(.halo)`);
      const stroke = await line.evaluate((each) => getComputedStyle(each).stroke);
      // Viridis runs from a dark violet to a bright yellow.
      for (const ground of ["rgb(68, 1, 84)", "rgb(253, 231, 37)", "rgb(255, 255, 255)"])
        expect(contrast(stroke, ground), `${ink}, ${colorScheme}`).toBeGreaterThanOrEqual(3);
    }
  }
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
