/** Which of the two .wasm files a browser downloads. */

import type { Page } from "@playwright/test";
import { expect, test } from "./lab";

const NO_SIMD = "WebAssembly.validate = () => false;";

/** Names of all requested .wasm files, without the suffix added by the build. */
function downloads(page: Page): string[] {
  const names: string[] = [];
  page.on("request", (request) => {
    const name = /([^/]+_bg)[^/]*\.wasm$/.exec(request.url())?.[1];
    if (name) names.push(name);
  });
  return names;
}

test("with SIMD the default file is downloaded, and no other", async ({ lab, page }) => {
  const names = downloads(page);
  await lab.open();
  expect(names).toEqual(["bimodal_stereo_bg"]);
});

test("without SIMD the Lab's worker downloads the scalar file alone, and computes", async ({ lab, page }) => {
  const names = downloads(page);
  // Init scripts of the page do not run in workers, so the line is prepended to the worker's script.
  await page.route(/worker[^/]*\.js$/, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `${NO_SIMD}${await response.text()}` });
  });
  await lab.open();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  expect(names).toEqual(["bimodal_stereo_scalar_bg"]);
});

test("without SIMD init() without an argument downloads the scalar file alone", async ({ page }) => {
  const names = downloads(page);
  await page.addInitScript(NO_SIMD);
  await page.goto("./shortest.html");
  await expect(page.locator("#out")).toContainText("converged");
  expect(names).toEqual(["bimodal_stereo_scalar_bg"]);
});
