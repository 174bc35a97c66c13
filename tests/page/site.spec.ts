/** The built page on a plain file server, below a folder: its requests, violations of its policy, and what works offline. */

import { createHash } from "node:crypto";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { POLICY } from "../../scripts/site/build.mjs";
import { serveSite } from "../../scripts/site/serve.mjs";
import { LONG, expect, test } from "./lab";
import { answerChecks } from "./rig";
import { refusals, requests } from "./visit";

test.use({ serviceWorkers: "allow" });

const offline = (page: Page) => page.locator("#offline");

/** Every part of the page, with a check of a result of its worker. */
const PLACES: [string, (page: Page) => Promise<void>][] = [
  [
    "./#size=48",
    async (page) => {
      await expect(page.locator("#status")).toHaveAttribute("data-state", "ready");
      await page.keyboard.press("s");
      await expect(page.locator("#message")).not.toBeEmpty();
      await expect(page.locator("#clouds-note")).toBeHidden();
    },
  ],
  ["./#learn", async (page) => expect(page.locator(".learn-figure")).toHaveAttribute("aria-busy", "false")],
  ["./#tables", async (page) => expect(page.getByRole("heading", { name: "Table 1" }).first()).toBeVisible()],
  [
    "./#rig",
    async (page) => {
      await page.getByRole("button", { name: "Load an example" }).click();
      await expect(page.locator(".rig-frame")).toHaveCount(3);
    },
  ],
];

test(
  "its policy refuses nothing that the page does, and nothing comes from elsewhere",
  LONG,
  async ({ lab, page, context, baseURL }) => {
    const refused = await refusals(page);
    const asked = requests(context);
    await answerChecks(page, "consistent");
    for (const [address, lives] of PLACES) {
      await page.goto("about:blank");
      await page.goto(address);
      await lives(page);
    }
    await page.getByRole("button", { name: "Next: your calibration" }).click();
    await page.getByRole("button", { name: "Run the check" }).click();
    await expect(page.locator(".rig-bar").first()).toBeVisible();
    expect(refused).toEqual([]);
    expect(asked.length).toBeGreaterThan(20);
    expect(asked.filter((address) => !address.startsWith(baseURL ?? "?"))).toEqual([]);
    expect(lab.complaints).toEqual([]);
  },
);

test("the policy refuses what is not the page's own", async ({ page }) => {
  const refused = await refusals(page);
  await page.goto("./");
  await page.evaluate(async () => {
    document.body.insertAdjacentHTML(
      "beforeend",
      `<p style="color: red" onclick="0">x</p><img src="https://example.org/x.png" alt="">`,
    );
    // Some browsers check a handler only when it is about to run.
    document.querySelector<HTMLElement>("p[onclick]")?.click();
    await fetch("https://example.org/").catch(() => undefined);
  });
  await expect
    .poll(() => refused.map((each) => each.split(":")[0]))
    .toEqual(expect.arrayContaining(["style-src-attr", "script-src-attr", "img-src", "connect-src"]));
});

test("after one visit every place opens without a network", LONG, async ({ lab, page, context }) => {
  await page.goto("./");
  await expect(offline(page)).toHaveText("It works offline.");
  await context.setOffline(true);
  // The service worker does not cache its own script.
  expect(
    await page.evaluate(() =>
      fetch("./sw.js").then(
        () => "came",
        () => "did not come",
      ),
    ),
  ).toBe("did not come");
  lab.complaints.length = 0;
  for (const [address, lives] of PLACES) {
    await page.goto("about:blank");
    await page.goto(address);
    await page.reload();
    await lives(page);
  }
  await page.goto("about:blank");
  await page.goto("./shortest.html");
  await expect(page.locator("#out")).toContainText("converged");
  expect(lab.complaints).toEqual([]);
});

test(
  "a newer version is told of, taken at the next visit, and nothing of the old one is kept",
  LONG,
  async ({ context }) => {
    const folder = mkdtempSync(join(tmpdir(), "site-"));
    cpSync(new URL("../../site", import.meta.url), folder, { recursive: true });
    const { address, close } = await serveSite({ port: 0, below: "/a/", folder });
    const caches_ = (page: Page) => page.evaluate(() => caches.keys());
    try {
      const page = await context.newPage();
      await page.goto(address);
      await expect(offline(page)).toHaveText("It works offline.");
      const before = await caches_(page);
      expect(before).toHaveLength(1);

      const hash = (text: string) => createHash("sha256").update(text).digest("base64");
      const [old, worker] = ["index.html", "sw.js"].map((name) => readFileSync(join(folder, name), "utf8")) as [
        string,
        string,
      ];
      const changed = old.replace("<h1", `<h1 id="newer"`);
      writeFileSync(join(folder, "index.html"), changed);
      writeFileSync(
        join(folder, "sw.js"),
        worker.replace(hash(old), hash(changed)).replace(/version:`\w+`/, "version:`next`"),
      );
      await page.reload();
      await expect(offline(page)).toContainText("A newer version is ready");
      // The open page keeps all files of its version.
      await page.reload();
      await expect(page.locator("#newer")).toHaveCount(0);
      await page.close();
      const later = await context.newPage();
      await expect(async () => {
        await later.goto("about:blank");
        await later.goto(address);
        await expect(later.locator("#newer")).toHaveCount(1, { timeout: 1000 });
      }).toPass();
      await expect.poll(() => caches_(later)).toHaveLength(1);
      expect(await caches_(later)).not.toEqual(before);
      await expect(offline(later)).toHaveText("It works offline.");
    } finally {
      close();
      rmSync(folder, { recursive: true });
    }
  },
);

test("under the headers that docs/hosting.md suggests it runs as well, isolated", LONG, async ({ lab, page }) => {
  expect(readFileSync(new URL("../../docs/hosting.md", import.meta.url), "utf8")).toContain(
    `Content-Security-Policy "${POLICY}"`,
  );
  const headers = {
    "Content-Security-Policy": POLICY,
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "X-Content-Type-Options": "nosniff",
  };
  const { address, close } = await serveSite({ port: 0, below: "/", headers });
  try {
    const refused = await refusals(page);
    for (const [place, lives] of PLACES) {
      await page.goto("about:blank");
      await page.goto(new URL(place, address).href);
      expect(await page.evaluate(() => crossOriginIsolated)).toBe(true);
      await lives(page);
    }
    expect(refused).toEqual([]);
    expect(lab.complaints).toEqual([]);
  } finally {
    close();
  }
});

/** Presses Tab until an element that matches the selector has the focus. */
async function tabTo(page: Page, selector: string): Promise<void> {
  for (let presses = 0; presses < 120; presses++) {
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`The key Tab does not lead to ${selector}.`);
}

test("from the first key to a pose in a file, by keyboard alone", LONG, async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await lab.visit();
  await page.keyboard.press("Tab");
  await expect(page.getByRole("link", { name: "Skip to Play" })).toBeFocused();
  await page.keyboard.press("Enter");
  await expect(page.getByRole("button", { name: "Play" })).toBeFocused();
  await page.keyboard.press("Space");
  await expect(page.locator("#status")).toHaveAttribute("data-state", /converged|ambiguous/);
  // Tab goes from Play to the end of the page and on from its beginning.
  await tabTo(page, "#takeaway button[value=pose]");
  const download = page.waitForEvent("download");
  await page.keyboard.press("Enter");
  const file = await (await download).path();
  const { rotation } = JSON.parse(readFileSync(file, "utf8")) as { rotation: number[] };
  expect(rotation).toHaveLength(9);
});
