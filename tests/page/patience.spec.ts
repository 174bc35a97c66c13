/** With a slow or silent worker, the latest request wins and nothing blocks. */

import { LONG, expect, test } from "./lab";
import { Messages } from "./messages";

test("reset works while a step runs", LONG, async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await lab.open();
  await messages.hold("advance");
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("playing");
  await expect.poll(() => messages.count("advance")).toBe(1);
  await messages.lose();
  await page.getByRole("button", { name: "Reset" }).click();
  await lab.reaches("ready");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
});

test("another input replaces one that is being worked on", LONG, async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await lab.open("surface=ripples");
  const ripples = await lab.fingerprint("Colour");
  await page.goto("about:blank");
  await lab.open("surface=bust");
  await lab.unfold();
  await messages.hold("advance");
  await page.keyboard.press("s");
  await expect.poll(() => messages.count("advance")).toBe(1);
  await messages.lose();
  await page.getByLabel("Surface", { exact: true }).selectOption("ripples");
  await lab.reaches("ready");
  expect(await lab.fingerprint("Colour")).toBe(ripples);
  await page.getByLabel("Surface", { exact: true }).blur();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
});

test("of several requests the last one counts", LONG, async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await lab.open("surface=vase");
  const vase = await lab.fingerprint("Colour");
  await page.goto("about:blank");
  await lab.open("surface=bust");
  await lab.unfold();
  const surface = page.getByLabel("Surface", { exact: true });
  const start = page.getByLabel("Start", { exact: true });
  // All requests are made before the worker receives the first.
  await messages.hold();
  for (const name of ["ripples", "bust", "vase"]) await surface.selectOption(name);
  await start.selectOption("near");
  await start.blur();
  await messages.release();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  expect(await lab.fingerprint("Colour")).toBe(vase);

  // After a refusal, screen and worker have the same pair, even if another pair was requested in between.
  await messages.hold();
  await surface.selectOption("ripples");
  await page.getByLabel("Overlap", { exact: true }).first().fill("7");
  await page.keyboard.press("Enter");
  await messages.release();
  await lab.reaches("error");
  await expect(lab.iteration).toHaveText("0");
  expect(await lab.fingerprint("Colour")).toBe(vase);
  await start.focus();
  await start.blur();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  expect(await lab.fingerprint("Colour")).toBe(vase);
});

/**
 * A clock for the worker that depends on the worker's actions: it advances by 5 ms whenever the time is read, as after each slice of the
 * search, and by 400 ms before each request.
 */
const CLOCK = "let now = 0; performance.now = () => (now += 5); addEventListener('message', () => (now += 400));";

/** Limit of the requests until the first iteration is done; with that clock it takes 16. */
const MOST_FRAMES = 40;

test("where every frame is late the search still ends", LONG, async ({ lab, page }) => {
  await page.route(/worker[^/]*\.js$/, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `${CLOCK}${await response.text()}` });
  });
  // With such late frames a run is played stage by stage, and a search has hundreds of slices.
  const messages = await Messages.of(page, 400);
  await lab.visit("size=64&light=colourful");
  await page.getByRole("button", { name: "Play" }).click();
  await expect(lab.iteration).not.toHaveText("0");
  expect(await messages.count("advance")).toBeLessThan(MOST_FRAMES);
});
