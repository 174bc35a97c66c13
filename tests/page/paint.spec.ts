/** Albedo and shading are shown separately. */

import { readFile } from "node:fs/promises";
import { encode } from "fast-png";
import init, { sample } from "../../pkg/index.js";
import { expect, test } from "./lab";

const size = 80;
/** Linear factors of a second albedo, and the side of its squares in pixels. */
const PAINT = [0.45, 0.75, 1.2];
const SQUARE = 10;

test("a painted object is shown as its paint and its shading", async ({ lab, page }) => {
  await init(await readFile(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)));
  const { image, depth } = sample({ surface: "bust", light: "window", size, angles: { beta: 0 } });
  const linear = image.data as Float32Array;
  const brightest = linear.reduce((most, value) => (Number.isFinite(value) ? Math.max(most, value) : most), 0);
  const isPainted = (index: number) =>
    (Math.floor((index % size) / SQUARE) + Math.floor(index / size / SQUARE)) % 2 === 1;
  const data = Uint16Array.from(linear, (value, i) =>
    Number.isFinite(value)
      ? Math.round((45_000 * value * (isPainted(Math.floor(i / 3)) ? (PAINT[i % 3] ?? 1) : 1)) / brightest)
      : 0,
  );
  const png = (data: Uint16Array, channels: 1 | 3) => ({
    mimeType: "image/png",
    buffer: Buffer.from(encode({ width: size, height: size, data, depth: 16, channels })),
  });
  const depths = Uint16Array.from(depth.data ?? [], (value) => (value > 0 ? Math.round(100 * value) : 0));

  await lab.visit("lighting=estimate&start=identity&registration=fixed");
  await lab.unfold();
  await page.getByRole("button", { name: "Own files" }).click();
  await lab.reaches("waiting");
  await page.getByText("Depth camera", { exact: true }).click();
  await page.getByLabel("Unit", { exact: true }).fill("0.01");
  await page.getByLabel("Colour image", { exact: true }).setInputFiles({ name: "colour.png", ...png(data, 3) });
  await page.getByLabel("Depth map", { exact: true }).setInputFiles({ name: "depth.png", ...png(depths, 1) });
  await lab.reaches("ready");
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");

  // Ratios of red to blue over both albedos: they differ in the albedo and hardly in the shading.
  const hues = (label: string) =>
    page.locator(`canvas[aria-label^="${label}:"]`).evaluate((canvas: HTMLCanvasElement) => {
      const { data, width } =
        canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height) ?? new ImageData(1, 1);
      const ratios: number[] = [];
      for (let i = 0; i < data.length; i += 4 * (width > 40 ? 7 : 1))
        if (data[i + 3] && data[i + 2]) ratios.push((data[i] ?? 0) / (data[i + 2] ?? 1));
      return ratios.sort((a, b) => a - b);
    });
  const spread = (ratios: number[]) =>
    (ratios[Math.floor(0.9 * ratios.length)] ?? 0) / (ratios[Math.floor(0.1 * ratios.length)] ?? 1);
  const [albedo, shading, colour] = [
    spread(await hues("Albedo")),
    spread(await hues("Shading")),
    spread(await hues("Colour")),
  ];
  expect(albedo).toBeGreaterThan(1.3);
  expect(shading).toBeLessThan(1 + 0.6 * (colour - 1));
});

test("an object of one paint is grey", async ({ lab, page }) => {
  await lab.open();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  const levels = await page.locator('canvas[aria-label^="Albedo:"]').evaluate((canvas: HTMLCanvasElement) => {
    const { data } = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height) ?? new ImageData(1, 1);
    const found = new Set<string>();
    for (let i = 0; i < data.length; i += 4) if (data[i + 3]) found.add(data.slice(i, i + 3).join(" "));
    return [...found];
  });
  expect(levels).toHaveLength(1);
  expect(new Set(levels[0]?.split(" ")).size).toBe(1);
});
