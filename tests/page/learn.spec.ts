/** Learn: each lesson's figure reacts to its controls, links open their state, the keyboard turns slides. */

import { readFile } from "node:fs/promises";
import type { Page } from "@playwright/test";
import { LESSONS, control, figure, number, open, settled, slide } from "./figure";
import { LONG, expect, test } from "./lab";
import { atWidths, innerWidth, narrowest } from "./widths";

function fingerprint(page: Page, panel: string): Promise<number> {
  return page.locator(`[data-panel="${panel}"] canvas`).evaluate((canvas: HTMLCanvasElement) => {
    const data =
      canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? new Uint8ClampedArray();
    return data.reduce((sum, value) => (sum * 31 + value) % 1_000_003, 7);
  });
}

test(
  "each lesson says where its method is written down, names its controls and pictures, and fits from 320 to 2560 px",
  LONG,
  async ({ page }) => {
    const papers: string[] = [];
    await page.setViewportSize(narrowest);
    for (const id of LESSONS) {
      await open(page, `at=${id}`);
      await expect(page.locator(`[data-lesson="${id}"]`)).toBeVisible();
      papers.push(...(await referencesOf(page)));
      expect(
        await page
          .locator("#learn :is(input, select)")
          .evaluateAll((all) => all.filter((control) => (control as HTMLInputElement).labels?.length === 0).length),
        id,
      ).toBe(0);
      expect(
        await page
          .locator("#learn :is(canvas, svg.learn-plot)")
          .evaluateAll((all) => all.filter((picture) => !picture.getAttribute("aria-label")).length),
        id,
      ).toBe(0);
      await atWidths(page, [320, 390, 600, 700, 1280, 1600, 2560], (width) => fits(page, id, width));
    }
    expect(papers.length).toBeGreaterThan(8);
    for (const link of papers) expect(link).toMatch(/^https:\/\/(arxiv\.org\/abs|doi\.org)\//);
  },
);

/** A lesson's links, except those to documents, whose headings are checked to exist. */
async function referencesOf(page: Page): Promise<string[]> {
  const links = await page
    .locator(".learn-more a")
    .evaluateAll((all) => all.map((link) => (link as HTMLAnchorElement).href));
  const headings = links.flatMap((link) => {
    const [, file = "", anchor = ""] = /\/(docs\/.+\.md)#(.+)$/.exec(link) ?? [];
    return file === "" ? [] : [{ file, anchor }];
  });
  expect(headings.length).toBeGreaterThan(0);
  for (const { file, anchor } of headings) expect(await anchorsOf(file), file).toContain(anchor);
  return links.filter((link) => !link.includes("/docs/"));
}

/** The anchors of a document's headings. */
async function anchorsOf(file: string): Promise<string[]> {
  const text = await readFile(new URL(`../../${file}`, import.meta.url), "utf8");
  return [...text.matchAll(/^#+ (.+)$/gm)].map(([, heading = ""]) =>
    heading
      .toLowerCase()
      .replace(/[^\w\s-]/g, "")
      .replace(/\s/g, "-"),
  );
}

async function fits(page: Page, id: string, width: number): Promise<void> {
  await settled(page);
  expect(await innerWidth(page), `${id} at ${width} px`).toBeLessThanOrEqual(width);
  // On a phone, long formulas scroll sideways, and each picture has its own row.
  if (width >= 1280) {
    const cut = await page
      .locator(".learn-formula")
      .evaluateAll((all) => all.map(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth));
    expect(
      cut.filter((px) => px > 0),
      `${id} at ${width} px`,
    ).toEqual([]);
  } else if (width >= 390) {
    const tops = await page
      .locator(".learn-panel:not(.learn-wide)")
      .evaluateAll((all) => all.map((panel) => Math.round(panel.getBoundingClientRect().top)));
    expect(
      tops.filter((top) => tops.filter((other) => other === top).length === 1),
      `${id} at ${width} px`,
    ).toEqual([]);
  }
}

test("no exercise and no slide sticks out from 320 to 2560 px", LONG, async ({ page }) => {
  const widths = [320, 390, 1280, 1600, 2560];
  await page.setViewportSize(narrowest);
  await page.goto("./#learn&at=exercises");
  await expect(page.locator(".learn-exercises")).toBeVisible();
  await atWidths(page, widths, async (width) =>
    expect(await innerWidth(page), `exercises at ${width} px`).toBeLessThanOrEqual(width),
  );
  await page.goto("./#learn&at=pose&slides");
  await atWidths(page, widths, async (width) => {
    await settled(page);
    expect(
      await page.locator(".learn-slide").evaluate((slide) => slide.scrollWidth - slide.clientWidth),
      `a slide at ${width} px`,
    ).toBe(0);
  });
});

test("on a phone the figure stands below what it is about, and above the long text", async ({ page, say }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open(page, "at=pose");
  const top = async (selector: string) => (await page.locator(selector).first().boundingBox())?.y ?? NaN;
  expect(await top(".learn-figure")).toBeGreaterThan(await top(".learn-formula"));
  expect(await top(".learn-figure")).toBeLessThan(await top(".learn-formula ~ p"));
  await page.getByRole("button", { name: say("interface.slides", "Slides") }).click();
  await expect(page.locator(".learn-slide .learn-figure")).toBeVisible();
});

test(
  "pictures of a row stand in line, no plot leaves a hole beside it, and its type is never small, on slides neither",
  LONG,
  async ({ page }) => {
    const look = () =>
      figure(page).evaluate((box) => {
        const panels = [...box.querySelectorAll(".learn-panel")];
        const edges = (element: Element | null | undefined) => element?.getBoundingClientRect() ?? new DOMRect();
        const top = (panel: Element) => Math.round(edges(panel).top);
        const rows = [...new Set(panels.map(top))].map((at) => panels.filter((panel) => top(panel) === at));
        const crooked = rows.filter(
          (row) =>
            new Set(row.map((panel) => Math.round(edges(panel.querySelector(".learn-canvas, .learn-plot-box")).top)))
              .size > 1,
        ).length;
        const right = edges(box.querySelector(".learn-panels")).right;
        const plots = [...box.querySelectorAll<SVGSVGElement>(".learn-plot")];
        const holes = plots.filter((plot) =>
          rows.every(
            (row) =>
              !row.some((panel) => panel.contains(plot)) ||
              row.every((panel) => Math.round(edges(panel).right) < Math.round(right)),
          ),
        ).length;
        const unscaled = plots.filter((plot) =>
          ["middle", "end"].some((axis) => plot.querySelectorAll(`.tick[text-anchor="${axis}"]`).length < 2),
        ).length;
        return { crooked, holes, unscaled, type: Math.min(...plots.map((plot) => 11 * (plot.getScreenCTM()?.a ?? 0))) };
      });
    for (const id of ["grey", "surface", "prior", "pose", "sensor"]) {
      for (const mode of ["", "&slides"]) {
        await open(page, `at=${id}${mode}`);
        await expect(page.locator(`${mode ? ".learn-slide " : ""}[data-lesson="${id}"]`)).toBeVisible();
        await expect.poll(async () => (await look()).type, `${id}${mode}`).toBeGreaterThan(11.5);
        expect(await look(), `${id}${mode}`).toMatchObject({ crooked: 0, holes: 0, unscaled: 0 });
      }
    }
  },
);

test("the Lab alone loads nothing of Learn, and Learn leaves the Lab alone", async ({ lab, page, say }) => {
  const asked: string[] = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  await lab.open();
  const before = asked.filter((path) => /\.(js|css)$/.test(path)).length;
  await page.locator("#to-learn").click();
  await expect(page.getByRole("heading", { name: say("lessons.normal.title", "What a normal is") })).toBeVisible();
  await settled(page);
  expect(asked.filter((path) => /\.(js|css)$/.test(path)).length).toBeGreaterThan(before);
  await expect(page.getByRole("button", { name: "Play" })).toBeHidden();
  await page.locator("#to-lab").click();
  await lab.reaches("ready");
});

test("6: the light and the albedo change the predicted colour, and a drag chooses the normal", async ({
  lab,
  page,
}) => {
  await open(page, "at=pixel");
  const red = await number(page, "red");
  await slide(page, "albedo", 0.5);
  expect((await number(page, "red")) - red).toBeCloseTo(Math.log(0.5), 5);
  const bust = await fingerprint(page, "bust");
  await slide(page, "beta", 60);
  await settled(page);
  expect(await fingerprint(page, "bust")).not.toBe(bust);
  const ball = await page.locator('[data-panel="ball"] .learn-canvas').boundingBox();
  if (!ball) throw new Error("There is no ball.");
  await page.mouse.move(ball.x + ball.width / 2, ball.y + ball.height / 2);
  await page.mouse.down();
  await page.mouse.move(ball.x + 0.2 * ball.width, ball.y + 0.5 * ball.height, { steps: 4 });
  await page.mouse.up();
  await expect(page).toHaveURL(/nx=-0\.5\d/);
  expect(lab.complaints).toEqual([]);
});

test("7: a dent under the turned lamp is the bump's picture", async ({ lab, page }) => {
  await open(page, "at=grey&turn=60");
  const apart = await number(page, "difference");
  expect(apart).toBeGreaterThan(0.05);
  await slide(page, "turn", 180);
  expect(await number(page, "difference")).toBeLessThan(1e-3);
  // On a flat surface, no lamp produces a difference that slopes alone could explain.
  await slide(page, "height", 0);
  expect(await number(page, "difference")).toBeLessThan(apart);
  expect(lab.complaints).toEqual([]);
});

test("8: colour makes the curve short and the normals right; noise does not", async ({ lab, page }) => {
  await open(page, "at=colours&colour=0&noise=0.01");
  const [grey, curve] = [await number(page, "degrees"), await number(page, "explained")];
  await slide(page, "colour", 1);
  const coloured = await number(page, "degrees");
  expect(coloured).toBeLessThan(0.2 * grey);
  expect(await number(page, "explained")).toBeLessThan(0.3 * curve);
  await slide(page, "noise", 0.1);
  expect(await number(page, "degrees")).toBeGreaterThan(2 * coloured);
  await control(page, "light").selectOption("window");
  await slide(page, "noise", 0.01);
  expect(await number(page, "degrees")).toBeGreaterThan(2 * coloured);
  expect(lab.complaints).toEqual([]);
});

test("9: a step leaves no trace, robust weights bring it back where a way leads around it", async ({ lab, page }) => {
  await open(page, "at=surface&step=0");
  expect(await number(page, "error")).toBeLessThan(0.2);
  await slide(page, "step", 8);
  const robust = [await number(page, "error"), await number(page, "jump")];
  await control(page, "robust").uncheck();
  const plain = [await number(page, "error"), await number(page, "jump")];
  expect(plain[0]).toBeGreaterThan(1.5 * (robust[0] ?? NaN));
  expect(plain[1]).toBeLessThan(robust[1] ?? NaN);
  await control(page, "robust").check();
  await control(page, "through").check();
  expect(await number(page, "error")).toBeGreaterThan(2 * (robust[0] ?? NaN));
  expect(lab.complaints).toEqual([]);
});

test("10: more prior, better normals; none at all where its weight is zero", LONG, async ({ lab, page }) => {
  await open(page, "at=prior&share=0");
  const none = await number(page, "degrees");
  await slide(page, "share", 50);
  const half = await number(page, "degrees");
  expect(half).toBeLessThan(0.7 * none);
  await slide(page, "share", 100);
  expect(await number(page, "degrees")).toBeLessThan(half);
  // Eight shares, computed one after the other.
  await expect(page.locator('[data-panel="figure5"] circle')).toHaveCount(8);
  await slide(page, "weight", -4);
  await expect(control(page, "weight")).toHaveAttribute("aria-valuetext", "0");
  expect(await number(page, "degrees")).toBeCloseTo(none, 1);
  expect(lab.complaints).toEqual([]);
});

test("11: a wrong pose leaves a residual, and registration comes home", LONG, async ({ lab, page, say }) => {
  await open(page, "at=pose&offset=0");
  const right = await number(page, "residual");
  await slide(page, "offset", 20);
  expect(await number(page, "residual")).toBeGreaterThan(3 * right);
  expect(await number(page, "error")).toBeCloseTo(20, 3);
  await control(page, "run").selectOption("register");
  expect(await number(page, "error")).toBeLessThan(1);
  await expect(page.locator('[data-number="status"]')).toHaveText(say("statuses.converged", "converged"));
  // Too far away, the initial pose is kept, as the text says, and the page describes in words what the library names by an option.
  await slide(page, "offset", 40);
  await settled(page);
  await expect(page.locator('[data-number="status"]')).toHaveText(
    new RegExp(`^${say("statuses.ambiguous", "ambiguous")}: ${say("runs.initial-pose-kept", "no pose within")}`),
  );
  expect(await number(page, "error")).toBeCloseTo(40, 3);
  await control(page, "run").selectOption("search");
  await expect(page.locator('[data-number="status"]')).toHaveText(new RegExp(`^${say("statuses.search", "search")}`));
  expect(await number(page, "error")).toBeLessThan(1);
  expect(lab.complaints).toEqual([]);
});

test("12: valleys merge near the prior, and the loop is drawn with its stages", async ({ lab, page, say }) => {
  await open(page, "at=loop&offset=0");
  expect(await number(page, "minima")).toBeGreaterThan(1);
  await slide(page, "weight", 0);
  expect(await number(page, "minima")).toBe(1);
  expect(await number(page, "end")).toBeLessThan(10);
  await slide(page, "offset", 20);
  expect(await number(page, "end")).toBeGreaterThan(10);
  await expect(page.locator(".learn-loop li")).toHaveCount(5);
  await expect(page.locator(".learn-loop li").nth(1)).toHaveText(say("lessons.loop.stages.1", "Normals"));
  expect(lab.complaints).toEqual([]);
});

test("10, 11: a curve's axes stand still from its first drawing to its last", LONG, async ({ page }) => {
  // Records every text of the plots as it is drawn.
  await page.addInitScript(() => {
    const seen = new Set<string>();
    Object.assign(window, { seen });
    new MutationObserver(() => {
      const plot = document.querySelector(':is([data-panel="curve"], [data-panel="figure5"]) svg');
      const words = [...(plot?.querySelectorAll("text") ?? [])].map(
        (text) => `${text.textContent} at ${text.getAttribute("x")} ${text.getAttribute("y")}`,
      );
      if (plot && words.length > 0) seen.add([plot.getAttribute("viewBox"), ...words].join(", "));
    }).observe(document, { childList: true, subtree: true });
  });
  for (const [state, points] of [
    ["prior&share=20", 8],
    ["pose&offset=40", 13],
    ["pose&light=colourful", 13],
    ["pose&light=overcast", 13],
  ] as const) {
    await page.goto("about:blank");
    await open(page, `at=${state}`);
    await expect(page.locator(':is([data-panel="curve"], [data-panel="figure5"]) circle')).toHaveCount(points);
    const axes = await page.evaluate(() => [...(window as unknown as { seen: Set<string> }).seen]);
    // One drawing for each width: a plot is drawn once before its size is known.
    expect(new Set(axes.map((drawn) => drawn.split(",")[0])).size, state).toBe(axes.length);
  }
});

test("13: the refined depth is better than the measured one, as far as the picture is good", async ({ lab, page }) => {
  await open(page, "at=sensor&noise=0.3&holes=10");
  const before = await number(page, "before");
  expect(await number(page, "after")).toBeLessThan(0.7 * before);
  expect(await number(page, "normalsAfter")).toBeLessThan(0.7 * (await number(page, "normalsBefore")));
  expect(await number(page, "filled")).toBeGreaterThan(50);
  const after = await number(page, "after");
  await slide(page, "picture", 0.2);
  expect(await number(page, "after")).toBeGreaterThan(1.1 * after);
  expect(await number(page, "before")).toBeCloseTo(before, 6);
  await slide(page, "noise", 0.8);
  expect(await number(page, "before")).toBeGreaterThan(2 * before);
  expect(lab.complaints).toEqual([]);
});

test("14: paint goes into the albedo, and so does nearly all of a shadow", async ({ lab, page }) => {
  await open(page, "at=paint&paint=0.8");
  expect(await number(page, "likeness")).toBeGreaterThan(0.7);
  const lit = await number(page, "lit");
  await slide(page, "paint", 0);
  await slide(page, "shadow", 0.9);
  expect(await number(page, "taken")).toBeGreaterThan(80);
  expect(await number(page, "shaded")).toBeGreaterThan(3 * lit);
  expect(await number(page, "shaded")).toBeGreaterThan(3 * (await number(page, "lit")));
  expect(lab.complaints).toEqual([]);
});

test("15: what can't be seen is said", LONG, async ({ lab, page, say }) => {
  await open(page, "at=failure&case=overlap&amount=0");
  await expect(page.locator('[data-number="status"]')).toHaveText(say("statuses.converged", "converged"));
  expect(await number(page, "error")).toBeLessThan(1);
  const sigma = await number(page, "sigma");
  await slide(page, "amount", 95);
  expect(await number(page, "sigma")).toBeGreaterThan(3 * sigma);
  await slide(page, "amount", 100);
  await settled(page);
  await expect(page.locator('[data-number="status"]')).toHaveText(
    new RegExp(`^(${say("statuses.ambiguous", "ambiguous")}|${say("statuses.lost", "lost")})`),
  );
  await control(page, "case").selectOption("symmetry");
  await expect(page.locator('[data-number="status"]')).toContainText(
    say("directions.rotation about z", "rotation about z is not observable"),
  );
  expect(lab.complaints).toEqual([]);
});

test("links of the exercises open the state they speak of", async ({ lab, page }) => {
  await page.goto("./#learn&at=exercises");
  const exercises = page.locator(".learn-exercises > ol > li");
  await expect(exercises).toHaveCount(5);
  for (const answer of await page.locator(".learn-exercises details").all())
    await expect(answer).not.toHaveAttribute("open", "");
  await expect(page.locator(".learn-exercises")).not.toContainText(/[{}_]/);
  const links = await page
    .locator(".learn-links a")
    .evaluateAll((all) => all.map((link) => link.getAttribute("href") ?? ""));
  expect(links.length).toBeGreaterThanOrEqual(5);
  for (const link of links.filter((address) => address.startsWith("#learn"))) {
    await page.goto(`./${link}`);
    const asked = new URLSearchParams(link.slice(1));
    await expect(page.locator(`.learn-lesson[data-lesson="${asked.get("at")}"]`)).toBeVisible();
    for (const [key, value] of asked) {
      if (key === "learn" || key === "at") continue;
      const control = page.locator(`.learn-controls [name="${key}"]`);
      const isBox = (await control.getAttribute("type")) === "checkbox";
      if (isBox) await expect(control).toBeChecked({ checked: value === "1" });
      else await expect(control).toHaveValue(value);
    }
  }
  const lab_ = links.find((address) => !address.startsWith("#learn")) ?? "";
  await page.goto(`./${lab_.replace("&play", "")}`);
  await lab.reaches("ready");
  await expect(page.getByLabel("Surface", { exact: true })).toHaveValue("bust");
});

test("an address brings a lesson back, and what is no value of a control is passed over", async ({
  lab,
  page,
  say,
}) => {
  await open(page, "at=colours&colour=0.5&noise=7&light=moon&px=abc");
  await expect(page.locator('.learn-controls input[name="colour"]')).toHaveValue("0.5");
  await expect(page.locator('.learn-controls input[name="noise"]')).toHaveValue("0.1");
  await expect(control(page, "light")).toHaveValue("colourful");
  await page.reload();
  await settled(page);
  await expect(page.locator('.learn-controls input[name="colour"]')).toHaveValue("0.5");
  // The settings are kept after a visit to another lesson.
  await page
    .getByRole("navigation", { name: say("interface.lessons", "Lessons") })
    .getByRole("link", { name: say("lessons.sensor.title", "Refining the sensor") })
    .click();
  await expect(page.getByRole("heading", { name: say("lessons.sensor.title", "Refining the sensor") })).toBeVisible();
  await page
    .getByRole("navigation", { name: say("interface.lessons", "Lessons") })
    .getByRole("link", { name: say("lessons.colours.title", "Three colours") })
    .click();
  await expect(page.locator('.learn-controls input[name="colour"]')).toHaveValue("0.5");
  expect(lab.complaints).toEqual([]);
});
