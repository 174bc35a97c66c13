// The report of a check in a browser: its own policy permits its style, and it requests nothing.
import { type Page, expect, test } from "@playwright/test";
import { reportHtml } from "../../pkg/rig-write.js";
import { report } from "../contract/rig-sample.mjs";
import { colourPng } from "./rig";

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
    await expect(page.getByAltText("Overlay")).toHaveJSProperty("naturalWidth", 1);
    await expect(page.getByRole("img", { name: /^Rotation about x/ })).toBeHidden();
    await page.getByText("Details: ").click();
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

/** Pages of a PDF of Chromium's. */
const pagesOf = (pdf: Buffer) => pdf.toString("latin1").match(/\/Type\s*\/Page\b/g)?.length;

const long = (words: string, times = 100) => `${words} `.repeat(times);

/** A report with all parts at their largest length, and a portrait picture, which is the highest. */
function fullest(files: number, lines = 12): string {
  const given = report();
  const [candidate] = Object.values(given.candidates);
  if (candidate === undefined) throw new Error("the report has a candidate");
  const names = Array.from({ length: 12 }, (_, k) => `calibration ${k} ${long("with a name", 20)}`);
  const many = {
    ...given,
    reason: long("It is off for a long reason."),
    warnings: Array.from({ length: 40 }, (_, k) => ({ code: "many-holes", message: long(`Warning ${k} says much.`) })),
    candidates: Object.fromEntries(names.map((name) => [name, candidate])),
    frames: Array.from({ length: 30 }, (_, k) => ({ name: `frame ${k}`, share: 1 / 30 })),
  };
  const edges = Array.from({ length: 2000 }, (_, k) => (k * 37) % 400);
  const picture = `data:image/png;base64,${colourPng(300, 400).toString("base64")}`;
  const frame = { frame: long("frame"), width: 300, height: 400, picture, before: edges, after: edges };
  return reportHtml(many, [], {
    title: `Check of ${long("a long name", 30)}`,
    made: new Date(0),
    inputs: Array.from({ length: files }, (_, k) => ({
      name: `${"folder/".repeat(20)}depth_${k}.png`,
      says: long("640x480, 16-bit, read as millimetres,", 10),
      bytes: 123456,
      notes: ["unit-guessed", "many-holes"],
      sha256: "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
    })),
    calibrations: { [names[0] ?? ""]: given.estimate },
    overlays: [frame, frame, frame],
    shell: {
      command: `cat > calibration.txt <<'END'\n${long("0.12345678901234567", 5)}\n`.repeat(lines),
      note: long("It differs.", 20),
    },
    settings: [
      ["cues", "all"],
      ["frames", "20"],
      ["unit", "as the files state it or as guessed"],
      ["masks drawn", "yes"],
    ],
    versions: [
      ["bimodal-stereo", "0.1.0"],
      ["wasm", "SHA-256 0123456789abcdef"],
      ["browser", "Chrome 140.0.0.0, X11"],
    ],
  });
}

test("prints on one page, and many files on a second one", async ({ page, browserName }) => {
  test.skip(browserName !== "chromium", "only Chromium prints to a file");
  for (const [files, pages, lines] of [
    [0, 1, 12],
    [5, 1, 12],
    [10, 1, 12],
    // The longest lists beside large pictures.
    [5, 1, 0],
    [11, 2, 12],
    [300, 2, 12],
  ] as const) {
    await open(page, fullest(files, lines));
    for (const format of ["A4", "Letter"])
      expect(pagesOf(await page.pdf({ format })), `${files} files, ${format}`).toBe(pages);
    for (const width of [390, 1280]) {
      await page.setViewportSize({ width, height: 800 });
      expect(await overflow(page)).toBe(0);
    }
    await page.unroute("**/report.html");
  }
  // Details that are open are also printed.
  await open(page, reportHtml(report()));
  expect(pagesOf(await page.pdf({ format: "A4" }))).toBe(1);
  await page.getByText("Details: ").click();
  expect(pagesOf(await page.pdf({ format: "A4" }))).toBeGreaterThan(1);
});

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
