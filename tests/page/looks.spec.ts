/** The page on small and large screens, in dark and light colours. */

import { expect, test } from "./lab";
import { atWidths, innerWidth, narrowest } from "./widths";

test("nothing sticks out from 320 to 2560 px", async ({ lab, page }) => {
  await page.setViewportSize(narrowest);
  await lab.open();
  await atWidths(page, [320, 390, 1280, 1600, 2560], async (width) => {
    expect(await innerWidth(page), `at ${width} px`).toBeLessThanOrEqual(width);
    await expect(page.getByRole("button", { name: "Play" })).toBeInViewport();
  });
});

test("on a phone the input is folded and the views can be swiped", async ({ lab, page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await lab.open();
  await expect(page.getByLabel("Surface", { exact: true })).toBeHidden();
  await page.getByText("Settings", { exact: true }).click();
  await expect(page.getByLabel("Surface", { exact: true })).toBeVisible();
  const swiped = await page.locator("#image-views").evaluate((row) => row.scrollWidth > row.clientWidth);
  expect(swiped).toBe(true);
});

test("dark and light follow the system, and the visitor", async ({ lab, page }) => {
  const lightness = () =>
    page.evaluate(() => {
      const numbers = getComputedStyle(document.documentElement).backgroundColor.match(/[\d.]+/g) ?? [];
      return numbers.slice(0, 3).reduce((sum, value) => sum + Number(value), 0) / 3;
    });
  await page.emulateMedia({ colorScheme: "dark" });
  await lab.open();
  expect(await lightness()).toBeLessThan(64);
  await page.emulateMedia({ colorScheme: "light" });
  expect(await lightness()).toBeGreaterThan(192);
  await page.getByRole("button", { name: "Switch to the dark theme" }).click();
  expect(await lightness()).toBeLessThan(64);
  await page.reload();
  expect(await lightness()).toBeLessThan(64);
});

test("the first paint needs little, and nothing comes from elsewhere", async ({ lab, page }) => {
  const elsewhere: string[] = [];
  const home = new URL(test.info().project.use.baseURL ?? "").host;
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (url.protocol.startsWith("http") && url.host !== home) elsewhere.push(request.url());
  });
  // Scripts that the document itself requests, including static imports but not chunks that load later.
  const html = await (await page.request.get("./")).text();
  const early = [...html.matchAll(/<(?:script|link rel="modulepreload")[^>]* (?:src|href)="([^"]+\.js)"/g)].map(
    ([, path]) => path ?? "",
  );
  const { gzipSync } = await import("node:zlib");
  let bytes = 0;
  for (const path of early) bytes += gzipSync(await (await page.request.get(path)).body()).length;
  expect(bytes).toBeGreaterThan(10_000);
  expect(bytes).toBeLessThan(60_000);
  await lab.open();
  expect(elsewhere).toEqual([]);
});

test("the shortest page runs on the main thread", async ({ lab, page }) => {
  await page.goto("./shortest.html");
  await expect(page.locator("output")).toHaveText(/ converged: beta (19|20)\.\d\d \(true: 20\)$/);
  expect(lab.complaints).toEqual([]);
});

test("the Lab looks the same after the Tables", async ({ lab, page }) => {
  await lab.open();
  const look = () =>
    page
      .locator("#fields-sample .heading")
      .first()
      .evaluate((heading) => {
        const { fontSize, color } = getComputedStyle(heading);
        return `${fontSize} ${color}`;
      });
  const before = await look();
  await page.getByRole("link", { name: "Tables" }).click();
  await expect(page.getByRole("heading", { name: "Table 1" }).first()).toBeVisible();
  await page.getByRole("link", { name: "Lab" }).click();
  await lab.reaches("ready");
  expect(await look()).toBe(before);
});

test("an enlarged view comes into sight", async ({ lab, page }) => {
  await lab.open();
  expect(await page.evaluate(() => (scrollTo({ top: 5000, behavior: "instant" }), scrollY))).toBeGreaterThan(200);
  await page.keyboard.press("1");
  await expect(page.locator("figure[data-large]")).toBeInViewport({ ratio: 0.9 });
  // A view that shares its row takes the whole row when enlarged.
  await page.keyboard.press("7");
  const widthOf = async (box: string) => (await page.locator(box).filter({ visible: true }).boundingBox())?.width;
  expect(await widthOf("#views > section")).toBe(await widthOf("#views"));
});

test("a view without values has no range of earlier ones, and the surfaces' legend names what is drawn", async ({
  lab,
  page,
}) => {
  await lab.open();
  const shape = page.getByText("shape from the image", { exact: true });
  await expect(shape).toBeHidden();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await expect(shape).toBeVisible();
  const lowest = page.getByLabel("Depth: lowest value shown", { exact: true });
  await expect(lowest).not.toHaveValue("0");
  await lab.unfold();
  await page.getByLabel("Surface", { exact: true }).selectOption("vase");
  await lab.reaches("ready");
  await expect(lab.iteration).toHaveText("0");
  await expect(lowest).toHaveValue("0");
  // The longest text that `short` writes.
  await lowest.fill("5.2e-4");
  expect(await lowest.evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth)).toBeLessThanOrEqual(0);
});

test("a range that is half typed survives the frames that arrive meanwhile", async ({ lab, page }) => {
  await lab.open("size=64");
  const lowest = page.getByLabel("Depth: lowest value shown", { exact: true });
  const highest = page.getByLabel("Depth: highest value shown", { exact: true });
  const before = await highest.inputValue();
  await lowest.fill("-9");
  // The button is clicked without a pointer event, because that would commit the value.
  await page.locator("#step").evaluate((button: HTMLButtonElement) => button.click());
  await expect(lab.iteration).toHaveText("1");
  await expect(highest).not.toHaveValue(before);
  await expect(lowest).toHaveValue("-9");
  await page.keyboard.press("Enter");
  await expect(page.getByLabel("Depth: range follows the values, auto", { exact: true })).toHaveAttribute(
    "aria-pressed",
    "false",
  );
  await lowest.blur();
  await expect(lowest).toHaveValue("-9.00");
});

test.describe("on a phone", () => {
  test.use({ hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });

  test("the number of the iteration is in sight wherever the bar is scrolled to", async ({ lab, page }) => {
    await lab.visit("size=32");
    await expect(lab.iteration).toBeInViewport({ ratio: 1 });
    const bar = page.locator("#bar");
    for (const left of [150, 5000]) {
      expect(
        await bar.evaluate((bar, left) => (bar.scrollTo({ left, behavior: "instant" }), bar.scrollLeft), left),
      ).toBeGreaterThan(100);
      await expect(lab.iteration).toBeInViewport({ ratio: 1 });
    }
    await expect(page.locator(".stage").last()).toBeInViewport({ ratio: 1 });
  });

  test("all of the verdict is on the first screen, below the surfaces", async ({ lab, page }) => {
    await lab.visit("size=64");
    const [verdict, bar, hero] = await Promise.all(
      ["#panel", "#bar", "#hero"].map((box) => page.locator(box).boundingBox()),
    );
    expect((verdict?.y ?? 0) + (verdict?.height ?? 0)).toBeLessThanOrEqual(bar?.y ?? 0);
    expect(verdict?.y).toBeGreaterThan((hero?.y ?? 0) + (hero?.height ?? 0));
  });
});

test("on a tablet the verdict is on the first screen, and stages that do not fit leave the controls where they are", async ({
  lab,
  page,
}) => {
  await page.setViewportSize({ width: 820, height: 1180 });
  await lab.visit("size=64");
  const [verdict, bar] = await Promise.all(["#status", "#bar"].map((box) => page.locator(box).boundingBox()));
  expect((verdict?.y ?? 0) + (verdict?.height ?? 0)).toBeLessThan(bar?.y ?? 0);
  const widths = (box: string) =>
    page.locator(box).evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth);
  expect(await widths("#stages")).toBeGreaterThan(0);
  expect(await widths("#bar")).toBe(0);
  // No stage wraps.
  const [stages] = await page
    .locator("#stages")
    .evaluateAll((all) =>
      all.map(({ clientHeight, firstElementChild }) => [clientHeight, firstElementChild?.clientHeight ?? 0]),
    );
  expect(stages?.[0]).toBe(stages?.[1]);
});

test("what is focused on the bar scrolls nothing: it is in sight already", async ({ lab, page }) => {
  await lab.visit("size=64");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  for (const id of ["play", "step", "stage-step"]) {
    await expect(page.locator(`#${id}`)).toBeFocused();
    expect(await page.evaluate(() => scrollY)).toBe(0);
    await page.keyboard.press("Tab");
  }
});

for (const width of [768, 1024]) {
  test(`open settings hide neither inputs nor surfaces at ${width} px`, async ({ lab, page }) => {
    await page.setViewportSize({ width, height: 900 });
    await lab.visit("size=64");
    await lab.unfold();
    const sheet = await page.locator("#input .sheet").boundingBox();
    for (const box of ["#inputs", "#hero", "#outcome"])
      expect((await page.locator(box).boundingBox())?.x).toBeGreaterThan((sheet?.x ?? 0) + (sheet?.width ?? 0));
    await expect(page.locator("#inputs")).toBeInViewport({ ratio: 1 });
    await expect(page.locator("#hero")).toBeInViewport({ ratio: 0.5 });
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
  });
}

test("open settings hide no input, and what has opened them stays under the pointer", async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 800 });
  await lab.visit("size=64");
  const summary = page.locator("#input > summary");
  const before = await summary.boundingBox();
  await summary.click();
  const sheet = await page.locator("#input .sheet").boundingBox();
  for (const box of ["#inputs", "#hero", "#outcome"])
    expect((await page.locator(box).boundingBox())?.x).toBeGreaterThan((sheet?.x ?? 0) + (sheet?.width ?? 0));
  expect(await summary.boundingBox()).toEqual(before);
  // The sheet covers nothing of what is above it either: the places, the sentence, the examples.
  for (const box of [".top", ".lead"]) {
    const above = await page.locator(box).boundingBox();
    expect((above?.y ?? Infinity) + (above?.height ?? 0)).toBeLessThanOrEqual(sheet?.y ?? 0);
  }
  // The whole sheet can be reached, and it stays next to the scrolled content.
  const bar = await page.locator("#bar").boundingBox();
  expect((sheet?.y ?? 0) + (sheet?.height ?? 0)).toBeLessThanOrEqual(bar?.y ?? 0);
  // The surfaces are fully visible, below a title of one line and above their legend.
  const legend = await page.locator("#clouds .legend").boundingBox();
  expect((legend?.y ?? Infinity) + (legend?.height ?? 0)).toBeLessThanOrEqual(bar?.y ?? 0);
  expect(
    await page
      .locator("#clouds .view-title")
      .evaluate(
        (title) => title.getClientRects().length && title.clientHeight / parseFloat(getComputedStyle(title).lineHeight),
      ),
  ).toBeLessThan(1.5);
  await page.locator("#numbers").evaluate((numbers) => numbers.scrollIntoView({ block: "start", behavior: "instant" }));
  await expect(page.locator("#input .sheet")).toBeInViewport({ ratio: 0.9 });
  await page.evaluate(() => scrollTo({ top: 0, behavior: "instant" }));
  await summary.click();
  await expect(page.locator("#inputs")).toBeInViewport({ ratio: 0.5 });
});

test("the footer begins where its place does, on the widest screens too, and before the styles of a place are there", async ({
  lab,
  page,
}) => {
  await page.setViewportSize({ width: 2560, height: 1300 });
  await lab.visit("size=64");
  const release: (() => void)[] = [];
  await page.route(
    "**/*.css",
    (route) => new Promise<void>((resolve) => release.push(() => resolve(route.continue()))),
  );
  const lefts = (place: string) =>
    page.evaluate(
      (boxes) => boxes.map((box) => document.querySelector(box)?.getBoundingClientRect().left),
      [".about", place],
    );
  for (const [link, place, styles] of [
    ["#to-tables", "#tables", 1],
    ["#to-rig", "#rig", 1],
    ["#to-learn", "#learn", 1],
    ["#to-lab", "#lab", 0],
  ] as const) {
    await page.locator(link).click();
    await expect(page.locator(place)).toBeVisible();
    await expect.poll(() => release.length).toBe(styles);
    const [about, main] = await lefts(place);
    expect(about).toBe(main);
    for (const go of release.splice(0)) go();
    await expect(page.locator(place)).not.toBeEmpty();
    const [later, settled] = await lefts(place);
    expect(later).toBe(settled);
  }
});

test("each place has its own help", async ({ lab, page }) => {
  await lab.visit("size=64");
  for (const [link, title, words] of [
    ["#to-learn", "Learn", "each a short text beside a figure"],
    ["#to-tables", "Tables", "beside the paper's number"],
    ["#to-rig", "Check a rig", "Load an example"],
    ["#to-lab", "The Lab", "Choose a pair"],
  ] as const) {
    await page.locator(link).click();
    await page.locator("#help-button").click();
    const help = page.getByRole("dialog", { name: title, exact: true });
    await expect(help).toContainText(words);
    await expect(help.locator("[data-place]:visible")).toHaveCount(1);
    await page.keyboard.press("Escape");
  }
});
