/** Formats that a rig's readers leave to browsers: JPEG and WebP, rotated and in sRGB; and LAZ, which needs a browser's permission. */

import { readFile } from "node:fs/promises";
import { expect, test } from "@playwright/test";

const ORIGIN = "http://rig.test/";
const [W, H] = [16, 12];

interface Read {
  width: number;
  height: number;
  data: number[];
  says: string;
  warnings: string[];
}

/** The policy is that of the site: WebAssembly may be compiled, and strings cannot become scripts. */
const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'";
const WORKER = `import { readRigFile } from "/pkg/rig.js";
onmessage = async ({ data }) => postMessage((await readRigFile(data)).says);`;

test.beforeEach(async ({ page }) => {
  await page.route(`${ORIGIN}**`, async (route) => {
    const path = new URL(route.request().url()).pathname;
    const headers = { "content-security-policy": POLICY };
    if (path === "/strict")
      return route.fulfill({ contentType: "text/html", headers, body: "<!doctype html><title>rig</title>" });
    if (path === "/worker.js") return route.fulfill({ contentType: "text/javascript", headers, body: WORKER });
    if (path === "/") return route.fulfill({ contentType: "text/html", body: "<!doctype html><title>rig</title>" });
    const folder = path.startsWith("/pkg/") ? "../.." : "../fixtures/rig";
    const contentType = path.endsWith(".js") ? "text/javascript" : "application/octet-stream";
    return route.fulfill({ contentType, body: await readFile(new URL(`${folder}${path}`, import.meta.url)) });
  });
  await page.goto(ORIGIN);
});

const read = (page: import("@playwright/test").Page, name: string): Promise<Read> =>
  page.evaluate(async (file) => {
    const module = "/pkg/rig.js";
    const { readRigFile } = await import(module);
    const bytes = new Uint8Array(await (await fetch(`/${file}`)).arrayBuffer());
    const { image, says, warnings } = await readRigFile({ name: file, bytes });
    return { width: image.width, height: image.height, data: [...image.data], says, warnings };
  }, name);

/** The largest difference from the fixtures' formula; `from` gives the fixture's pixel for each pixel. */
function off({ width, data }: Read, from = (x: number, y: number): [number, number] => [x, y]): number {
  return Math.max(
    ...Array.from({ length: W * H }, (_, at) => {
      const [x, y] = from(at % width, Math.floor(at / width));
      return Math.max(
        ...[16 * x, 20 * y, 8 * (x + y)].map((value, channel) => Math.abs((data[4 * at + channel] ?? 0) - value)),
      );
    }),
  );
}

test("WebP without loss, JPEG, and JPEG that EXIF turns", async ({ page }) => {
  const webp = await read(page, "colour.webp");
  expect([webp.width, webp.height, off(webp)]).toEqual([W, H, 0]);
  const jpeg = await read(page, "colour.jpg");
  expect(off(jpeg)).toBeLessThanOrEqual(12);
  const turned = await read(page, "turned-6.jpg");
  expect([turned.width, turned.height]).toEqual([H, W]);
  expect(off(turned, (x, y) => [y, H - 1 - x])).toBeLessThanOrEqual(5);
  expect(turned.says).toContain("rotated by 90 degrees as EXIF says");
  expect(turned.warnings).toHaveLength(1);
});

test("a JPEG's colour profile is applied, as ours is to PNG", async ({ page }) => {
  const jpeg = await read(page, "colour-wide.jpg");
  const truth = await read(page, "colour-wide-by-lcms.png");
  expect(Math.max(...truth.data.map((value, at) => Math.abs(value - (jpeg.data[at] ?? 0))))).toBeLessThanOrEqual(12);
});

test("a WebP or JPEG that is cut off is an error that names it", async ({ page }) => {
  const message = (name: string, length: number) =>
    page.evaluate(
      async ([file, end]) => {
        const module = "/pkg/rig.js";
        const { readRigFile } = await import(module);
        const bytes = new Uint8Array(await (await fetch(`/${file}`)).arrayBuffer()).slice(0, end as number);
        return readRigFile({ name: file, bytes }).then(
          () => "read",
          (error: Error & { code: string }) => `${error.code} ${error.message}`,
        );
      },
      [name, length] as const,
    );
  expect(await message("colour.webp", 40)).toMatch(/^file colour\.webp: this WebP is cut off/);
  expect(await message("colour.jpg", 500)).toMatch(/^file colour\.jpg: this JPEG is/);
});

test("LAZ is unpacked in a page and in a worker, under the policy of the site", async ({ page }) => {
  await page.goto(`${ORIGIN}strict`);
  const says = await page.evaluate(async () => {
    const module = "/pkg/rig.js";
    const { readRigFile } = await import(module);
    const bytes = new Uint8Array(await (await fetch("/scan-6.laz")).arrayBuffer());
    const file = { name: "scan-6.laz", bytes };
    const here = await readRigFile(file);
    const worker = new Worker("/worker.js", { type: "module" });
    const there = await new Promise<unknown>((resolve, reject) => {
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = ({ message }) => reject(new Error(message));
      worker.postMessage(file);
    });
    return [here.says, there];
  });
  expect(says[0]).toMatch(/^576 points \(LAZ\), sorted into \d+x8/);
  expect(says[1]).toBe(says[0]);
});
