/** Storage that is full or forbidden, several tabs that share it, and files that change during a run. */

import type { Page } from "@playwright/test";
import { Lab, LONG, expect, test } from "./lab";
import { colourPng, depthPng, drop } from "./uploads";

/** Sets the browser's own quota, so that it stores nothing more. */
async function fill(page: Page, baseURL: string | undefined): Promise<void> {
  const session = await page.context().newCDPSession(page);
  await session.send("Storage.overrideQuotaForOrigin", { origin: new URL(baseURL ?? "").origin, quotaSize: 1 });
}

const keeping = (page: Page) => page.locator(".keeping");
const name = (page: Page, slot: number) => page.locator(".slot").nth(slot).locator(".file-name");

test("a browser whose storage is full says so of files, and they work", async ({ lab, page, baseURL }) => {
  await lab.open("size=32");
  await fill(page, baseURL);
  await drop(page, "body", [colourPng("colour.png"), depthPng("depth.png")]);
  await lab.reaches("ready");
  await expect(keeping(page)).toContainText("its storage is full");
  await page.keyboard.press("s");
  await expect(page.locator("#message")).not.toBeEmpty();
});

test.describe("the page's own files", () => {
  test.use({ serviceWorkers: "allow" });
  test("are not said to be kept where there is no room for them", async ({ lab, page, baseURL }) => {
    await fill(page, baseURL);
    await lab.open("size=32");
    await expect(page.locator("#offline")).toContainText("could not store a copy of the page");
    await page.keyboard.press("s");
    await expect(lab.iteration).toHaveText("1");
  });
});

test("where every kind of storage is forbidden all places work", async ({ lab, page }) => {
  await page.addInitScript(() => {
    const forbid = {
      get: () => {
        throw new DOMException("no", "SecurityError");
      },
    };
    for (const kind of ["localStorage", "sessionStorage", "indexedDB", "caches"])
      Object.defineProperty(window, kind, forbid);
    Object.defineProperty(window, "BroadcastChannel", {
      value: class {
        constructor() {
          throw new DOMException("no", "SecurityError");
        }
      },
    });
    Object.defineProperty(navigator, "locks", { value: undefined });
  });
  await lab.open("size=32");
  await page.locator("#theme").click();
  await drop(page, "body", [colourPng("colour.png"), depthPng("depth.png")]);
  await lab.reaches("ready");
  await expect(keeping(page)).toContainText("it does not let this page store files");
  await page.goto("./#learn");
  await expect(page.locator(".learn-figure")).toHaveAttribute("aria-busy", "false");
  await page.goto("./#tables");
  await expect(page.getByRole("heading", { name: "Table 1" }).first()).toBeVisible();
  await page.goto("./#rig");
  await expect(page.getByText("Drop files or a folder here")).toBeVisible();
});

test("two Labs in two tabs run at once, each as if it were alone", async ({ lab, context }) => {
  const settings = ["size=48&start=truth&iterations=6", "size=32&beta=15&start=truth&iterations=6"];
  const end = async ({ page, iteration }: Lab): Promise<string[]> => [
    await iteration.innerText(),
    await page.locator("#pose").innerText(),
  ];
  const other = new Lab(await context.newPage());
  const labs = [lab, other];
  const isOver = ({ page }: Lab) =>
    expect(page.locator("#status")).toHaveAttribute("data-state", /^(converged|ambiguous|lost|max-iterations)$/);
  const play = ({ page }: Lab) => page.getByRole("button", { name: "Play" }).click();
  const alone: string[][] = [];
  for (const [index, each] of labs.entries()) {
    await each.open(settings[index]);
    await each.page.getByLabel("Speed").selectOption({ label: "one per frame" });
    await play(each);
    await isOver(each);
    alone.push(await end(each));
    await each.page.keyboard.press("r");
    await each.reaches("ready");
  }
  await Promise.all(labs.map(play));
  await Promise.all(labs.map(isOver));
  expect(await Promise.all(labs.map(end))).toEqual(alone);
  expect(other.complaints).toEqual([]);
});

test("a tab says when another one keeps its files in the place of these", async ({ lab, page, context }) => {
  await lab.open("size=32");
  await drop(page, "body", [colourPng("mine.png"), depthPng("depth.png")]);
  await expect(keeping(page)).toContainText("stay in this browser");
  const other = new Lab(await context.newPage());
  await other.open("size=32");
  await drop(other.page, "body", [colourPng("theirs.png"), depthPng("depth.png")]);
  await expect(keeping(other.page)).toContainText("stay in this browser");
  await expect(keeping(page)).toContainText("Another tab of this page has stored its own files");
  await expect(name(page, 0)).toContainText("mine.png");
  await other.unfold();
  await other.page.getByRole("button", { name: "Remove my files" }).click();
  await expect(keeping(page)).toContainText("were removed in another tab of this page");
  expect(other.complaints).toEqual([]);
});

test(
  "files dropped while a run is on: the run ends, and the new pair's is what it is alone",
  LONG,
  async ({ lab, page }) => {
    const second = [colourPng("second.png", 20), depthPng("second-depth.png")];
    const play = async () => {
      await page.getByRole("button", { name: "Play" }).click();
      await expect(page.locator("#status")).toHaveAttribute(
        "data-state",
        /^(converged|ambiguous|lost|max-iterations)$/,
      );
      return [
        await lab.iteration.innerText(),
        await page.locator("#pose").innerText(),
        await lab.fingerprint("Colour"),
        await lab.fingerprint("Refined depth"),
      ];
    };
    await lab.open("size=32&iterations=12");
    await page.getByLabel("Speed").selectOption({ label: "fastest" });
    await drop(page, "body", second);
    await lab.reaches("ready");
    const alone = await play();
    await drop(page, "body", [colourPng("first.png"), depthPng("first-depth.png")]);
    await expect(name(page, 0)).toContainText("first.png");
    await lab.reaches("ready");
    await page.getByLabel("Speed").selectOption({ label: "8 per second" });
    await page.getByRole("button", { name: "Play" }).click();
    await expect(lab.iteration).not.toHaveText("0");
    await drop(page, "body", second);
    await expect(name(page, 0)).toContainText("second.png");
    await lab.reaches("ready");
    await page.getByLabel("Speed").selectOption({ label: "fastest" });
    expect(await play()).toEqual(alone);
    await expect(page.locator("#alert")).toBeHidden();
  },
);
