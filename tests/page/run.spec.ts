/** The method runs, by pointer and by keyboard, and its pictures and numbers update. */

import { LONG, expect, test } from "./lab";
import { Messages } from "./messages";

test("a sample runs to convergence with a small pose error", async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await lab.open("surface=bust&light=colourful&size=64&beta=20");
  const before = await lab.fingerprint("Normals");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");
  expect(await lab.errorDegrees()).toBeLessThanOrEqual(1);
  await expect(page.locator("#status")).toHaveText(/^converged, 0\.\d\d° off$/);
  await expect(page.locator("#status")).toHaveAttribute("data-tone", "good");
  expect(await lab.fingerprint("Normals")).not.toBe(before);
  await expect(page.getByRole("button", { name: "Play" })).toHaveAttribute("aria-pressed", "false");

  // Play restarts the run; the second step is held back, so that the first can be seen.
  await messages.hold("advance", 1);
  await page.getByRole("button", { name: "Play" }).click();
  await expect(lab.iteration).toHaveText("1");
  await lab.reaches("playing");
});

test("no stage that has come to rest is said to have taken 0.0 ms", async ({ lab, page }) => {
  await lab.visit("size=32&start=near");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await expect(page.locator("#status")).toHaveAttribute("data-state", /converged|lost|ambiguous/);
  await expect(page.locator("#stages")).toContainText("ms");
  await expect(page.locator("#stages")).not.toContainText(/\D0\.0 ms/);
});

test("keys step, stage, play, pause, reset and enlarge", async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await lab.open();
  const depth = await lab.fingerprint("Depth");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await expect.poll(() => lab.fingerprint("Depth")).not.toBe(depth);

  await page.keyboard.press("t");
  await expect(page.locator(".stage[data-lit]")).toContainText("light");
  await page.keyboard.press("t");
  await expect(page.locator(".stage[data-lit]")).toContainText("shading");

  // The run plays until the other key is pressed, however late.
  await messages.hold("advance");
  await page.keyboard.press(" ");
  await lab.reaches("playing");
  await page.keyboard.press(" ");
  await lab.reaches("paused");
  await messages.release();

  await page.keyboard.press("r");
  await lab.reaches("ready");
  await expect(lab.iteration).toHaveText("0");

  await page.keyboard.press("3");
  await expect(page.getByRole("button", { name: "Enlarge Depth" })).toHaveAttribute("aria-pressed", "true");
  await expect(page.getByRole("img", { name: /^Given depth/ })).toBeHidden();
  await page.keyboard.press("Escape");
  await expect(page.getByRole("img", { name: /^Given depth/ })).toBeVisible();

  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "The Lab" })).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog", { name: "The Lab" })).toBeHidden();
});

test("a view that was alone leaves the page where it stood", async ({ lab, page }) => {
  await lab.open("size=32");
  const top = () => page.evaluate(() => scrollY);
  for (const from of [0, 700]) {
    for (const key of ["1", "3", "9"]) {
      await page.evaluate((from) => scrollTo(0, from), from);
      await page.keyboard.press(key);
      await expect(page.locator("#lab")).toHaveAttribute("data-single", "");
      // Enlarging several in a row counts as one.
      await page.keyboard.press("2");
      await expect(page.getByRole("img", { name: /^Normals:/ })).toBeFocused();
      await page.keyboard.press("Escape");
      await expect(page.locator("#lab")).not.toHaveAttribute("data-single");
      expect(await top(), `${key} from ${from}`).toBe(from);
    }
  }
});

test(
  "who comes back from another place finds the run going on, and one that was paused still paused",
  LONG,
  async ({ lab, page }) => {
    const messages = await Messages.of(page);
    await lab.open("size=64");
    await messages.hold("advance", 1);
    await page.keyboard.press(" ");
    await expect(lab.iteration).toHaveText("1");
    // Visits two other places; the run continues.
    await page.locator("#to-learn").click();
    await page.locator("#to-tables").click();
    await expect(page.locator("#lab")).toBeHidden();
    await expect(page.locator("#play")).toHaveAttribute("aria-label", "Play");
    await messages.release();
    await page.locator("#to-lab").click();
    await lab.reaches("converged");

    await page.keyboard.press("r");
    await lab.reaches("ready");
    await page.keyboard.press("s");
    await lab.reaches("paused");
    await page.locator("#to-tables").click();
    await expect(page.locator("#lab")).toBeHidden();
    await page.locator("#to-lab").click();
    await expect(page.locator("#lab")).toBeVisible();
    await expect(page.locator("#play")).toHaveAttribute("aria-label", "Play");
    await lab.reaches("paused");
    await expect(lab.iteration).toHaveText("1");
  },
);

test("the value under the pointer is shown in every view", async ({ lab, page }) => {
  await lab.open();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await page.getByRole("img", { name: /^Normals/ }).hover();
  const readouts = page.locator("#image-views .readout");
  for (const readout of await readouts.all()) await expect(readout).toHaveText(/^\d+, \d+: /);
  // The text also gives the depth map's pixel, if there is one.
  await expect(page.locator("#probe .where")).toHaveText(/^image \d+, \d+; depth map (\d+, \d+|none)$/);
});

test("a range can be fixed and let go", async ({ lab, page }) => {
  await lab.open();
  const before = await lab.fingerprint("Given depth");
  const highest = page.getByLabel("Given depth: highest value shown");
  const value = Number(await highest.inputValue());
  await highest.fill(String(value + 100));
  await highest.press("Enter");
  await expect.poll(() => lab.fingerprint("Given depth")).not.toBe(before);
  await expect(page.getByLabel("Refined depth: highest value shown")).not.toHaveValue(String(value));
  await page.getByRole("button", { name: "Given depth: range follows the values" }).click();
  await expect.poll(() => lab.fingerprint("Given depth")).toBe(before);
});

test("settings live in the address, can be undone and go back to their defaults", async ({ lab, page }) => {
  await lab.open("surface=vase&beta=35");
  await lab.unfold();
  await expect(page.getByLabel("Surface", { exact: true })).toHaveValue("vase");
  await expect(page.locator("#pose tbody tr").nth(2).locator("td").nth(1)).toHaveText("35.00");
  await page.getByLabel("Surface", { exact: true }).selectOption("ripples");
  await expect(page).toHaveURL(/surface=ripples/);
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(page.getByLabel("Surface", { exact: true })).toHaveValue("vase");
  await page.getByRole("button", { name: "Redo" }).click();
  await expect(page.getByLabel("Surface", { exact: true })).toHaveValue("ripples");
  await expect(page.getByRole("button", { name: "Redo" })).toBeDisabled();
  await page.getByRole("button", { name: "Defaults" }).click();
  await expect(page.getByLabel("Surface", { exact: true })).toHaveValue("bust");
  await expect(page).not.toHaveURL(/surface/);
  await lab.reaches("ready");
});

test("the report can be taken away as JSON", async ({ lab, page }) => {
  await lab.open();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: "Export" }).click();
  const stream = await (await waiting).createReadStream();
  const chunks: Buffer[] = [];
  for await (const chunk of stream) chunks.push(Buffer.from(chunk as Uint8Array));
  const report: unknown = JSON.parse(Buffer.concat(chunks).toString());
  expect(report).toMatchObject({
    format: "bimodal-stereo report",
    source: "sample",
    report: { iteration: 1 },
    truth: { angles: { beta: 20 } },
  });
});

test("a stage explains itself", async ({ lab, page }) => {
  await lab.open();
  await page.getByRole("button", { name: /^registration/ }).click();
  await expect(page.locator("#explanation")).toContainText("Equations 12 to 16");
  await page.keyboard.press("Escape");
  await expect(page.locator("#explanation")).toBeHidden();
  // The signs of the lessons: a letter that every font has for the transposed normal, which has a fourth component.
  await page.getByRole("button", { name: /^light/ }).click();
  await expect(page.locator("#explanation math")).toContainText("ñTMñ");
  await expect(page.locator("#explanation")).toContainText("ñ has a fourth component 1");
  await page.keyboard.press("Escape");
});

test("after a panic a new worker takes the same input up again", async ({ lab, page }) => {
  // The second step is answered as the worker does after a panic, because the numerics cannot be made to panic.
  await page.addInitScript(() => {
    let steps = 0;
    const send = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (this: Worker, message: { id: number; kind: string }) {
      if (message.kind !== "advance" || ++steps !== 2) return send.call(this, message);
      const fault = { code: "panic", message: "the numerics broke off", fatal: true };
      this.dispatchEvent(new MessageEvent("message", { data: { id: message.id, ok: false, fault } }));
    };
  });
  await lab.open("beta=15");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await page.keyboard.press("s");
  await lab.reaches("error");
  await expect(page.getByRole("alert")).toContainText("the numerics broke off");
  await expect(lab.iteration).toHaveText("0");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
});

test("a run that misses the pose does not look like a success", async ({ lab, page }) => {
  await lab.open("size=64&lighting=estimate&iterations=2");
  await lab.unfold();
  await expect(page.getByText("Estimated along with the pose.").filter({ visible: true })).toHaveCount(1);
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("max-iterations");
  await expect(page.locator("#status")).toHaveText(/^stopped, \d+\.\d+° off$/);
  await expect(page.locator("#status")).not.toHaveAttribute("data-tone", "good");
  await expect(page.locator("#verdict")).toContainText("The limit of 2 iterations was reached.");
  await expect(page.locator("#next")).not.toBeEmpty();
});

test("a hint unfolds at a tap", async ({ lab, page }) => {
  await lab.open();
  await lab.unfold();
  const hint = page.getByText("Side length of both views, or a full camera frame.");
  await expect(hint).toBeHidden();
  await page.getByRole("button", { name: 'What is "Size"?' }).click();
  await expect(hint).toBeVisible();
});

/** The table shows this error for the initial pose. */
const AT_START = /[\d.]+° at the start/;

test(
  "nothing known: the search comes first, says how far it is, and the loop converges",
  LONG,
  async ({ lab, page }) => {
    await lab.visit("size=64&light=window&beta=50&gamma=15&overlap=0.7&noise=0.01");
    const search = page.getByRole("button", { name: /^search/ });
    // Polling could miss the search, so every text of its chip while lit is recorded.
    const said = await search.evaluateHandle((chip) => {
      const said: string[] = [];
      const record = () => chip.hasAttribute("data-lit") && said.push(chip.textContent ?? "");
      new MutationObserver(record).observe(chip, {
        attributes: true,
        childList: true,
        characterData: true,
        subtree: true,
      });
      return said;
    });
    const error = page.locator("#pose-error");
    await expect(error).toContainText(AT_START);
    const before = AT_START.exec((await error.textContent()) ?? "")?.[0] ?? "";
    await page.getByRole("button", { name: "Play" }).click();
    await expect(page.locator("#status")).toHaveAttribute("data-state", "converged");
    // The table still refers to the visitor's initial pose, not to the pose of the search.
    await expect(error).toContainText(before);
    expect((await said.jsonValue()).join(" ")).toMatch(/\d+ %/);
    expect(await lab.errorDegrees()).toBeLessThanOrEqual(1);
    await expect(page.locator("#status")).toHaveAttribute("data-tone", "good");
    await expect(search).toContainText("100 %");
  },
);

test("what a search tries is a candidate, and the pose has the words of the messages", LONG, async ({ lab, page }) => {
  await lab.visit("size=64");
  await expect(page.locator("#pose-found")).toHaveText("start");
  await page.keyboard.press("t");
  await lab.reaches("paused");
  await expect(page.locator("#pose-found")).toHaveText("candidate");
  await expect(page.locator("#light figcaption").first()).toHaveText("candidate");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.keyboard.press(" ");
  await lab.reaches("converged");
  await expect(page.locator("#pose-found")).toHaveText("found");
  await expect(page.locator("#light figcaption").first()).toHaveText("found");
  const weakest = await page.locator("#pose-extra dd").last().innerText();
  await expect(page.locator("#pose th", { hasText: weakest.split(" with ")[0] ?? "" })).toHaveCount(1);
});

test("a pose that was held is not said to have been sought", async ({ lab, page }) => {
  await lab.visit("size=64&start=identity&registration=fixed");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.keyboard.press(" ");
  await expect(page.locator("#verdict")).toContainText("stayed at its initial value");
  await expect(page.locator("#next")).toContainText("Registration, joint");
  // The pose is 20 degrees off and shown in red, since a tick would claim the contrary.
  await expect(page.locator("#status")).toHaveAttribute("data-tone", "wrong");
  await expect(page.locator("#status-icon")).toHaveText("×");
});

test("the example that is too hard is lost, says why, and what would help", async ({ lab, page }) => {
  await lab.visit("size=32");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Too hard", exact: true }).click();
  await lab.reaches("lost");
  await expect(page.locator("#verdict")).toContainText(/not observable|uncertain/);
  await expect(page.locator("#next")).toContainText("less noise");
  await expect(page.locator("#status-icon")).toHaveText("×");
});

test("other threads share the search where the machine has them", async ({ lab, page }) => {
  const workers: string[] = [];
  page.context().on("request", (request) => /\/thread-[^/]*\.js$/.test(request.url()) && workers.push(request.url()));
  await lab.visit("light=window");
  const threads = await page.evaluate(() => navigator.hardwareConcurrency);
  test.skip(threads < 2, "needs two processors");
  await expect.poll(() => workers.length).toBe(Math.min(threads, 4) - 1);
});

test(
  "the search fills a map of scores, whose best rotation is near the true one; a new run empties it",
  LONG,
  async ({ lab, page }) => {
    await lab.visit("surface=bust&light=colourful&size=64&beta=30");
    const map = page.locator("#score-map");
    await expect(map).toBeHidden();
    await page.getByLabel("Speed").selectOption({ label: "fastest" });
    await page.getByRole("button", { name: "Play" }).click();
    await expect(map).toBeVisible();
    await lab.reaches("converged");
    await expect(page.locator("#score-words")).toHaveText(
      / of \d{3} trial rotations \(white ring: best; orange: true\)/,
    );
    const canvas = page.getByRole("img", { name: /^Scores of \d+ rotations\. The best one is/ });
    const [, about] =
      /is (−?\d+) degrees about the vertical/.exec((await canvas.getAttribute("aria-label")) ?? "") ?? [];
    // Rotations are 16 degrees apart.
    expect(Math.abs(Number(about?.replace("−", "-")) - 30)).toBeLessThanOrEqual(16);
    // At the true rotation the map is yellow. At its corner no rotation was tried.
    const colours = await canvas.evaluate((element: HTMLCanvasElement) => {
      const at = (x: number, y: number) => [...(element.getContext("2d")?.getImageData(x, y, 1, 1).data ?? [])];
      return { truth: at(Math.round(((30 + 105) / 210) * element.width), element.height / 2), corner: at(1, 1) };
    });
    expect(colours.truth[0]).toBeGreaterThan(100);
    expect(colours.truth[1]).toBeGreaterThan(150);
    expect(colours.corner[3]).toBe(0);
    await page.getByRole("button", { name: "Reset" }).click();
    await expect(map).toBeHidden();
  },
);
