/** Downloads: every file can be read back, the report is self-contained, a figure can be embedded in another page. */

import { createHash } from "node:crypto";
import type { Download, Page } from "@playwright/test";
import { decode } from "fast-png";
import { decodeDepth } from "../../pkg/files.js";
import { LONG, expect, test, type Lab } from "./lab";
import { colourPng, depthPng } from "./uploads";

async function press(lab: Lab, name: string): Promise<Download> {
  const waiting = lab.page.waitForEvent("download");
  await lab.page.getByRole("group", { name: "Download" }).getByRole("button", { name, exact: true }).click();
  return waiting;
}

/** Chromium drops downloads beyond ten within a second, which no user reaches. */
const MOST_AT_ONCE = 8;

/** Waits until a second has passed on the page's clock. */
async function aSecond(page: Page): Promise<void> {
  const now = await page.evaluate(() => performance.now());
  await page.waitForFunction((since) => performance.now() > since + 1_000, now);
}

async function bytesOf(download: Download): Promise<Buffer> {
  const chunks: Buffer[] = [];
  for await (const chunk of await download.createReadStream()) chunks.push(Buffer.from(chunk as Uint8Array));
  return Buffer.concat(chunks);
}

const handed = async (lab: Lab, name: string): Promise<Buffer> => bytesOf(await press(lab, name));

/** The vertices of a binary PLY: x, y, z and the label of each. */
function vertices(file: Buffer): { head: string; points: number[][]; labels: number[] } {
  const end = file.indexOf("end_header\n") + "end_header\n".length;
  const head = file.subarray(0, end).toString();
  const count = Number(/element vertex (\d+)/.exec(head)?.[1]);
  const stride = 16;
  expect(file.length).toBe(end + count * stride);
  const at = Array.from({ length: count }, (_, i) => end + i * stride);
  return {
    head,
    points: at.map((from) => [0, 4, 8].map((k) => file.readFloatLE(from + k))),
    labels: at.map((from) => file[from + 15] ?? -1),
  };
}

test("pose, light and clouds", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const pose = JSON.parse((await handed(lab, "Pose, JSON")).toString()) as {
    unit: string;
    scale: number;
    rotation: number[];
    translation: number[];
    matrix: number[][];
  };
  // One step does not end the run.
  expect(pose).toMatchObject({ unit: "px", status: "running" });
  const rows = (await handed(lab, "Pose, 4×4"))
    .toString()
    .trim()
    .split("\n")
    .map((line) => line.split(" ").map(Number));
  expect(rows).toEqual(pose.matrix);
  expect(rows[1]).toEqual([...pose.rotation.slice(3, 6).map((value) => pose.scale * value), pose.translation[1]]);
  await expect(page.locator("#taken")).toHaveText("Saved depth_to_colour.txt: lengths in pixels.");

  const { head, points, labels } = vertices(await handed(lab, "Clouds, PLY"));
  expect(head).toContain("comment pixels; x right, y down, z forward");
  expect(points.length).toBeGreaterThan(400);
  expect(points.flat().every(Number.isFinite)).toBe(true);
  expect(new Set(labels)).toEqual(new Set([0, 1]));

  const light = (await handed(lab, "Light, CSV")).toString().trim().split("\n");
  expect(light[0]).toBe("channel,L1,L2,L3,L4,L5,L6,L7,L8,L9");
  expect(light.slice(1).map((line) => line.split(",").length)).toEqual([10, 10, 10]);
});

test("depth as 16 bits says its step and agrees with the .npy, and normals are of unit length", async ({
  lab,
  page,
}) => {
  await lab.open("size=32");
  const exact = decodeDepth(await handed(lab, "Refined depth, .npy"));
  const stored = decodeDepth(await handed(lab, "Refined depth, PNG"));
  await expect(page.locator("#taken")).toHaveText(
    "Saved refined-depth.png: 0.001 px per stored number, 0 is no depth.",
  );
  expect([stored.width, stored.height]).toEqual([32, 32]);
  const [a, b] = [exact.data ?? [], stored.data ?? []];
  let seen = 0;
  for (let i = 0; i < a.length; i++) {
    if (!(Number(a[i]) > 0)) expect(b[i]).toBe(0);
    else expect(Math.abs(Number(b[i]) * 0.001 - Number(a[i]))).toBeLessThanOrEqual(0.00051);
    seen += Number(a[i]) > 0 ? 1 : 0;
  }
  expect(seen).toBeGreaterThan(200);
  const button = page.getByRole("button", { name: "Normals, PNG", exact: true });
  await button.click();
  await expect(page.locator("#taken")).toContainText("there are no normals yet");
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await expect(lab.iteration).toHaveText("1");
  for (const name of ["Normals, PNG", "Refined normals, PNG"]) {
    const { width, height, channels, depth, data } = decode(await handed(lab, name));
    expect([width, height, channels, depth]).toEqual([32, 32, 3, 16]);
    let there = 0;
    for (let i = 0; i < data.length; i += 3) {
      const [x = 0, y = 0, z = 0] = [...data.subarray(i, i + 3)];
      if (x + y + z === 0) continue;
      there++;
      const n = [x, y, z].map((value) => (2 * value) / 65535 - 1);
      expect(Math.abs(Math.hypot(...n) - 1)).toBeLessThan(1e-4);
      expect(n[2]).toBeGreaterThan(0); // towards the viewer
    }
    expect(there).toBeGreaterThan(200);
  }
});

test("any picture of the page, the clouds and the curves among them", LONG, async ({ lab, page }) => {
  await lab.open("size=32");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await expect(page.locator("#clouds-note")).toBeHidden();
  await expect(page.locator("#objective-chart canvas")).toBeVisible();
  const select = page.getByLabel("Picture", { exact: true });
  await select.focus();
  const titles = await select.locator("option").allTextContents();
  for (const title of [
    "Colour",
    "Given depth",
    "Normals",
    "Refined depth",
    "Colour residual",
    "The two surfaces, overlaid",
    "Objective",
    "Rotation change",
  ])
    expect(titles).toContain(title);
  expect(new Set(titles).size).toBe(titles.length);
  for (const [count, title] of titles.entries()) {
    if (count > 0 && count % MOST_AT_ONCE === 0) await aSecond(page);
    await select.selectOption(title);
    const file = await press(lab, "Save picture");
    expect(file.suggestedFilename()).toMatch(/^[a-z0-9-]+\.png$/);
    const { width, height, channels, data } = decode(await bytesOf(file));
    expect(width * height).toBeGreaterThan(100);
    const colours = new Set<number>();
    for (let i = 0; i < data.length; i += channels)
      colours.add((data[i] ?? 0) * 65536 + (data[i + 1] ?? 0) * 256 + (data[i + 2] ?? 0));
    // A view has one colour only if it is zero everywhere, such as a difference of equal pictures.
    expect(colours.size, title).toBeGreaterThan(1);
  }
});

test("the report of a good run has no advice about the page's controls", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await lab.reaches("converged");
  await expect(page.locator("#next")).toContainText("Rotate the surfaces");
  const html = (await handed(lab, "Full report, HTML")).toString();
  expect(html).toContain("The true pose was found.");
  expect(html).not.toMatch(/Rotate the surfaces|Too hard/);
});

test("the report opens by itself, offline, with the numbers, options, pictures and hashes of the run", async ({
  lab,
  page,
  context,
}) => {
  await lab.open("size=64");
  await lab.unfold();
  await page.getByRole("button", { name: "Own files" }).click();
  const evil = "<img src=x onerror=document.title='owned'>";
  const files = [colourPng(`${evil}.png`), depthPng("deep.png")] as const;
  await page.getByLabel("Colour image", { exact: true }).setInputFiles(files[0]);
  await page.getByLabel("Depth map", { exact: true }).setInputFiles(files[1]);
  await lab.reaches("ready");
  await page.keyboard.press("Escape");
  await page.locator("body").click({ position: { x: 5, y: 5 } });
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await expect(lab.iteration).toHaveText("1");
  const beta = await page.locator("#pose tbody tr").nth(2).locator("td").first().textContent();
  const html = (await handed(lab, "Full report, HTML")).toString();

  await context.setOffline(true);
  const asked: string[] = [];
  const report = await context.newPage();
  report.on("request", (request) => {
    if (!request.url().startsWith("data:")) asked.push(request.url());
  });
  await report.route("**/report.html", (route) => route.fulfill({ contentType: "text/html", body: html }));
  await report.goto("report.html");
  expect(asked).toEqual([report.url()]);
  await expect(report).toHaveTitle("A run of bimodal stereo");
  const text = (await report.locator("main").innerText()).replaceAll("\u202f", " ").replaceAll("\u2212", "-");
  for (const file of files) {
    expect(text).toContain(file.name);
    expect(text).toContain(createHash("sha256").update(file.buffer).digest("hex"));
  }
  expect(text).toContain("Colour image: 48x48, 8-bit RGB");
  const said = Number(/^beta\s+(-?[\d.e]+)°/m.exec(text)?.[1]);
  expect(Math.abs(said - Number(beta?.replace("−", "-")))).toBeLessThan(0.0051);
  for (const words of [
    "Iterations",
    "not finished: iteration 1",
    "Colour camera: Encoding",
    "Start",
    "identity",
    "#size=64",
  ])
    expect(text).toContain(words);
  const images = report.locator("img");
  expect(await images.count()).toBeGreaterThan(8);
  for (const image of await images.all())
    expect(await image.evaluate((each: HTMLImageElement) => each.naturalWidth)).toBeGreaterThan(0);
  for (const width of [390, 1280]) {
    await report.setViewportSize({ width, height: 800 });
    expect(
      await report.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth),
    ).toBe(0);
  }
  await report.close();
  await context.setOffline(false);
});

test("a report of a sample has the true pose beside the found one", async ({ lab, page }) => {
  await lab.open("size=32&beta=12");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const html = (await handed(lab, "Full report, HTML")).toString();
  expect(html).toMatch(
    /<th scope="row">beta<\/th><td data-column="Found">[^<]+<\/td><td data-column="True">12\.00°<\/td>/,
  );
  expect(html).toContain("Sample: Surface");
});

test("a link brings back how the surfaces are drawn as well, and nothing of own files", async ({
  lab,
  page,
  context,
}) => {
  await lab.open("size=32");
  await page.locator("#clouds-style").selectOption("points");
  await page.locator("#clouds-texture").selectOption("normals");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await expect(page).toHaveURL(/clouds-style=points&clouds-texture=normals&pace=3/);
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(other.locator("#status")).toHaveAttribute("data-state", "ready");
  await expect(other.locator("#clouds-style")).toHaveValue("points");
  await expect(other.locator("#clouds-texture")).toHaveValue("normals");
  await expect(other.getByLabel("Speed")).toHaveValue("3");
  await other.close();
});

test("a line puts one figure, as it is set, into another page", async ({ page, context, baseURL }) => {
  await page.goto("./#learn&at=pixel&beta=40");
  await expect(page.locator(".learn-figure")).toHaveAttribute("aria-busy", "false");
  await page.getByRole("button", { name: "Embed" }).click();
  const line = await page.getByLabel("HTML that shows the figure").inputValue();
  expect(line).toMatch(
    /^<iframe src="[^"<>]+" title="6\. What a pixel shows" width="\d+" height="\d+" loading="lazy"><\/iframe>$/,
  );
  await page.locator('.learn-controls input[name="beta"]').fill("55");
  await expect(page.getByLabel("HTML that shows the figure")).toHaveValue(/beta=55/);

  const elsewhere = await context.newPage();
  await elsewhere.route("**/elsewhere.html", (route) =>
    route.fulfill({ contentType: "text/html", body: `<!doctype html><title>x</title><h1>Lecture</h1>${line}` }),
  );
  await elsewhere.goto(`${baseURL}elsewhere.html`);
  const frame = elsewhere.frameLocator("iframe");
  await expect(frame.locator(".learn-figure")).toHaveAttribute("aria-busy", "false");
  await expect(frame.locator('.learn-controls input[name="beta"]')).toHaveValue("40");
  for (const hidden of [".top", ".learn-text", ".learn-contents", "#bar", "h1"])
    await expect(frame.locator(hidden).first()).toBeHidden();
  await expect(frame.locator(".learn-panel canvas").first()).toBeVisible();
  // The embedded figure is interactive and stays within its frame.
  await frame.locator('.learn-controls input[name="beta"]').fill("10");
  await expect(frame.locator(".learn-figure")).toHaveAttribute("aria-busy", "false");
  const inside = elsewhere.frames()[1];
  expect(inside?.url()).toContain("embed");
  expect(
    await inside?.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth),
  ).toBe(0);
  await expect(frame.getByRole("link", { name: "text and exercises" })).toHaveAttribute(
    "href",
    /^#learn&at=pixel&beta=10$/,
  );
  await elsewhere.close();
});
