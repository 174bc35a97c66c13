/** Workers that end, fail or trap during work: the page reports it, keeps its input, and continues. */

import { readFileSync } from "node:fs";
import type { Page } from "@playwright/test";
import binaryen from "binaryen";
import { breakable, endAll, endAt, ended, endSoon, made } from "./broken";
import { LONG, expect, test, type Lab } from "./lab";
import { answerChecks, giveFiles, pair } from "./rig";
import { drop } from "./uploads";

const FAST = "size=48";
const alert = (page: Page) => page.locator("#alert");

async function play(lab: Lab): Promise<void> {
  await lab.page.getByLabel("Speed").selectOption({ label: "one per frame" });
  await lab.page.getByRole("button", { name: "Play" }).click();
}

/** The result of a run. */
const end = async (lab: Lab): Promise<string[]> => [
  await lab.iteration.innerText(),
  await lab.page.locator("#pose").innerText(),
  await lab.page.locator("#verdict").innerText(),
];

test.describe("in the Lab", () => {
  test.beforeEach(({ page }) => breakable(page));

  test("a worker ended in the middle of a step: said, and the run plays again to the same numbers", async ({
    lab,
    page,
  }) => {
    await lab.open(FAST);
    await play(lab);
    await lab.reaches("converged");
    const undisturbed = await end(lab);
    await page.keyboard.press("r");
    await lab.reaches("ready");
    await endAt(page, { kind: "advance" }, 3);
    await play(lab);
    await expect(alert(page)).toContainText("The run stopped: the browser ended the computing thread");
    await expect(alert(page)).toContainText("The input is kept");
    await lab.reaches("converged");
    await expect(alert(page)).toBeVisible();
    expect(await end(lab)).toEqual(undisturbed);
    await page.keyboard.press("r");
    await lab.reaches("ready");
    await expect(alert(page)).toBeHidden();
  });

  test(
    "one that is ended each time does not go round in circles, and Play goes on once it lives",
    LONG,
    async ({ lab, page }) => {
      await lab.open(FAST);
      await endAt(page, { kind: "advance" }, 1, 2);
      await play(lab);
      await expect.poll(() => ended(page)).toBe(2);
      await expect(page.getByRole("button", { name: "Play" })).toHaveAttribute("aria-pressed", "false");
      await lab.reaches("error");
      await expect(lab.iteration).toHaveText("0");
      await play(lab);
      await lab.reaches("converged");
    },
  );

  test("one that is ended in a single step: the iterations before it are repeated, and the step", async ({
    lab,
    page,
  }) => {
    const steps = async () => {
      for (const iteration of ["1", "2", "3"]) {
        await page.keyboard.press("s");
        await expect(lab.iteration).toHaveText(iteration);
      }
      await lab.reaches("paused");
      return page.locator("#pose").innerText();
    };
    await lab.open(FAST);
    const undisturbed = await steps();
    await page.keyboard.press("r");
    await lab.reaches("ready");
    await endAt(page, { kind: "advance" }, 3);
    expect(await steps()).toBe(undisturbed);
    await expect(alert(page)).toContainText("The input is kept");
    expect(await ended(page)).toBe(1);
  });

  test("one that is ended in a single stage: the iterations before it are repeated, and the stage", async ({
    lab,
    page,
  }) => {
    await lab.open(FAST);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    await endAt(page, { kind: "advance", by: "stage" });
    await page.keyboard.press("t");
    await expect(alert(page)).toContainText("The input is kept");
    await expect(lab.iteration).toHaveText("1");
    await expect(page.locator(".stage[data-lit]")).toHaveText(/^light/);
    await lab.reaches("paused");
  });

  test("one that is ended in a step of a saved run: the step is repeated on the same run", async ({ lab, page }) => {
    await lab.open(FAST);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    const waiting = page.waitForEvent("download");
    await page.getByRole("button", { name: "Save run to resume later" }).click();
    const buffer = readFileSync(await (await waiting).path());
    await drop(page, "body", [{ name: "run.bimodal", mimeType: "application/octet-stream", buffer }]);
    await expect(page.locator(".remarks")).toContainText("a saved run");
    await lab.reaches("paused");
    await endAt(page, { kind: "advance" });
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("2");
    await expect(alert(page)).toContainText("The input is kept");
  });

  test("one that is ended while its input is opened again leaves a Play that opens it", async ({ lab, page }) => {
    await endSoon(page, /\/worker-[^/]*\.js$/, 2);
    await lab.open(FAST);
    await endAt(page, { kind: "advance" });
    await page.keyboard.press("s");
    await expect(alert(page)).toContainText(/stopped.*stopped/);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
  });

  test("one that is ended while the page rests: another one repeats the run in silence, and goes on", async ({
    lab,
    page,
  }) => {
    const step = async (iteration: string) => {
      await page.keyboard.press("s");
      await expect(lab.iteration).toHaveText(iteration);
      await lab.reaches("paused");
      return page.locator("#pose").innerText();
    };
    await lab.open(FAST);
    await step("1");
    const second = await step("2");
    const third = await step("3");
    await page.keyboard.press("r");
    await lab.reaches("ready");
    await step("1");
    await step("2");
    const states = await page.evaluateHandle(() => {
      const seen: string[] = [];
      const note = () => seen.push(document.querySelector<HTMLElement>("#status")?.dataset.state ?? "");
      const status = document.querySelector("#panel");
      if (status) new MutationObserver(note).observe(status, { attributes: true, childList: true, subtree: true });
      return seen;
    });
    const before = await made(page, "/worker-");
    await endAll(page, "/worker-");
    await expect.poll(() => made(page, "/worker-")).toBe(before + 1);
    expect(await page.locator("#pose").innerText()).toBe(second);
    await expect(alert(page)).toBeHidden();
    expect(await states.jsonValue()).toEqual([]);
    expect(await step("3")).toBe(third);
    await expect(alert(page)).toBeHidden();
  });

  test("an uncaught error in the worker", async ({ lab, page }) => {
    await page.route(/\/worker-[^/]*\.js$/, async (route) => {
      const response = await route.fetch();
      const fault = `let count = 0; addEventListener("message", ({ data }) => { if (data.kind === "advance" && ++count === 2) throw new Error("out of order"); });`;
      await route.fulfill({ response, body: `${fault}\n${await response.text()}` });
    });
    await lab.open(FAST);
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
    await page.keyboard.press("s");
    await lab.reaches("error");
    await expect(alert(page)).toContainText("out of order");
    await expect(lab.iteration).toHaveText("0");
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
  });

  test("a trap in the module", async ({ lab, page }) => {
    await page.route(/bimodal_stereo_bg[^/]*\.wasm$/, async (route) => {
      const module = binaryen.readBinary(readFileSync(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)));
      const inner = binaryen.getExportInfo(module.getExport("estimator_stepStage")).value;
      // Missing in binaryen's types.
      const { Function: functions } = binaryen as unknown as { Function: { setBody(of: number, body: number): void } };
      functions.setBody(module.getFunction(inner), module.unreachable());
      await route.fulfill({ contentType: "application/wasm", body: Buffer.from(module.emitBinary()) });
      module.dispose();
    });
    await lab.open(FAST);
    await page.keyboard.press("t");
    await lab.reaches("error");
    await expect(alert(page)).toContainText("The input is kept; the run restarts.");
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
  });

  test("the thread that makes a file: said, nothing saved, and the next press saves", async ({ lab, page }) => {
    await endSoon(page, /files-thread[^/]*\.js$/, 1);
    await lab.open(FAST);
    const clouds = page.getByRole("group", { name: "Download" }).getByRole("button", { name: "Clouds, PLY" });
    await clouds.click();
    await expect(page.locator("#taken")).toContainText("Nothing saved: the browser ended the computing thread");
    const download = page.waitForEvent("download");
    await clouds.click();
    expect((await download).suggestedFilename()).toBe("clouds.ply");
  });
});

test("in Learn: said, the values stay, and the figure is computed again", async ({ lab, page }) => {
  await breakable(page);
  await page.goto("./#learn&at=pixel");
  const figure = page.locator(".learn-figure");
  await expect(figure).toHaveAttribute("aria-busy", "false");
  await endAt(page, { lesson: "pixel" });
  const beta = page.locator('.learn-controls input[name="beta"]');
  await beta.fill("55");
  await expect(figure.getByRole("alert")).toContainText("This figure stopped: the browser ended the computing thread");
  await expect(beta).toHaveValue("55");
  await page.getByRole("button", { name: "Recompute" }).click();
  await expect(figure).toHaveAttribute("aria-busy", "false");
  await expect(figure.getByRole("alert")).toBeHidden();
  expect(lab.complaints).toEqual([]);
});

test(
  "in the Tables: the cell says so, those after it are measured, and it can be pressed again",
  LONG,
  async ({ lab, page }) => {
    await breakable(page);
    // Ends the worker of the second cell that runs.
    await page.addInitScript(() => {
      const send = Worker.prototype.postMessage;
      let cells = 0;
      Worker.prototype.postMessage = function (this: Worker, message: { cell?: object }, ...rest: []) {
        send.call(this, message, ...rest);
        if (message.cell && ++cells === 2) this.terminate();
      };
    });
    await page.goto("./#tables");
    const cells = page.locator("#tables .heat-cell");
    await expect(cells.nth(2)).toBeVisible();
    // All clicks come at once, because otherwise the first cell could be done before the third is clicked. The cell clicked last runs next.
    await cells.evaluateAll((buttons) =>
      buttons.slice(0, 3).forEach((button) => (button as HTMLButtonElement).click()),
    );
    await expect(cells.nth(0)).toHaveAttribute("data-value");
    await expect(cells.nth(2)).toHaveAttribute("title", /failed: the browser ended the computing thread/);
    await expect(cells.nth(1)).toHaveAttribute("data-value");
    await cells.nth(2).click();
    await expect(cells.nth(2)).toHaveAttribute("data-value");
    expect(lab.complaints).toEqual([]);
  },
);

test.describe("in Check a rig", () => {
  const put = (page: Page, files: ReturnType<typeof pair>) =>
    page.locator("#rig input[type=file]:not([webkitdirectory])").first().setInputFiles(files);

  test("a worker ended in the middle of a check: said, the files stay, and the check runs again", async ({
    lab,
    page,
  }) => {
    await answerChecks(page, "off");
    await breakable(page);
    await page.goto("./#rig");
    await giveFiles(page, pair());
    await page.getByRole("button", { name: "Next: your calibration" }).click();
    await endAt(page, { kind: "check" });
    const run = page.getByRole("button", { name: /^(Run the check|Estimate a calibration)$/ });
    await run.first().click();
    await expect(page.locator("#rig").getByRole("alert")).toContainText(
      "The check failed: the browser ended the computing thread",
    );
    await page.getByRole("button", { name: "Run the check" }).click();
    await expect(page.locator(".rig-bar").first()).toBeVisible();
    expect(lab.complaints).toEqual([]);
  });

  test("a file whose reading ends the worker is named, and those that come later are read", async ({ lab, page }) => {
    await breakable(page);
    await page.goto("./#rig");
    await put(page, pair("first"));
    await expect(page.locator(".rig-frame")).toHaveCount(1);
    const [deadly] = pair("deadly");
    if (!deadly) throw new Error("a pair has files");
    await endAt(page, { name: deadly.name }, 1, 9);
    await put(page, [deadly]);
    await expect(page.locator("#rig")).toContainText("the browser ended the computing thread");
    await put(page, pair("second"));
    await expect(page.locator(".rig-frame")).toHaveCount(2);
    expect(lab.complaints).toEqual([]);
  });
});
