// The report of a check in a browser: its own policy permits its style, and it requests nothing.
import { type Page, expect, test } from "@playwright/test";
import { reportHtml } from "../../pkg/rig-write.js";
import { report } from "../contract/rig-sample.mjs";

const PIXEL =
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";

/** Opens a report as a file from a server; the list records further requests and violations of its policy. */
async function open(page: Page, html: string): Promise<string[]> {
  const wrong: string[] = [];
  page.on("console", (message) => wrong.push(message.text()));
  page.on("request", (request) => {
    if (!request.url().startsWith("data:") && !request.url().endsWith("/report.html")) wrong.push(request.url());
  });
  await page.route("**/report.html", (route) => route.fulfill({ contentType: "text/html", body: html }));
  await page.goto("report.html");
  return wrong;
}

/** Width of the page beyond the window, pixels. */
const overflow = (page: Page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

for (const colorScheme of ["light", "dark"] as const) {
  test(`a report in ${colorScheme} colours, on a phone and a desk`, async ({ page }) => {
    await page.emulateMedia({ colorScheme });
    const wrong = await open(page, reportHtml(report(), [{ title: "Overlay", dataUrl: PIXEL }]));
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    expect(await background()).toBe(colorScheme === "light" ? "rgb(245, 246, 247)" : "rgb(20, 23, 26)");
    await expect(page.getByRole("img", { name: "Overlay" })).toHaveJSProperty("naturalWidth", 1);
    await expect(page.getByRole("img", { name: /^Rotation about x/ })).toBeVisible();
    for (const width of [390, 1280]) {
      await page.setViewportSize({ width, height: 800 });
      expect(await overflow(page)).toBe(0);
    }
    await page.emulateMedia({ media: "print", colorScheme });
    expect(await background()).toBe("rgb(255, 255, 255)");
    expect(wrong).toEqual([]);
  });
}

test("names without end, and none at all, keep a report in its place", async ({ page }) => {
  const long = "x".repeat(300);
  const given = report();
  const [candidate] = Object.values(given.candidates);
  if (candidate === undefined) throw new Error("the report has a candidate");
  const names = {
    ...given,
    reason: long,
    warnings: [{ code: "many-holes", message: long }],
    candidates: { [long]: candidate },
    frames: [{ name: long, share: 1, note: long }],
  };
  const wrong = await open(
    page,
    reportHtml(names, [], { title: long, inputs: [{ name: long, says: long, sha256: long }] }),
  );
  for (const width of [390, 1280]) {
    await page.setViewportSize({ width, height: 800 });
    expect(await overflow(page)).toBe(0);
  }
  expect(wrong).toEqual([]);
});
