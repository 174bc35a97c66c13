// The Lab after a first visitor's run: the bust under colourful light, the run played to its end, on site/ as built from pkg/.
import { chromium } from "@playwright/test";
import { headless } from "../browser.mjs";
import { buildSite } from "../site/build.mjs";
import { serveSite } from "../site/serve.mjs";

const VIEWPORT = { width: 1600, height: 850 };
/** Limit of the run, and how long the drawing must be unchanged to count as finished, milliseconds. */
const LONGEST_RUN = 120_000;
const REST = 500;

/** The picture once it has stopped changing. */
async function still(page) {
  for (let last; ; ) {
    const next = await page.screenshot();
    if (last?.equals(next)) return next;
    last = next;
    await page.waitForTimeout(REST);
  }
}

/** The bytes of a PNG. */
export async function labPicture() {
  await buildSite();
  const { address, close } = await serveSite({ port: 0, below: "/any/folder/" });
  const browser = await chromium.launch({
    executablePath: await headless(),
    args: ["--no-sandbox", "--enable-unsafe-swiftshader"],
  });
  try {
    const page = await browser.newPage({ viewport: VIEWPORT, colorScheme: "light" });
    await page.goto(address);
    await page.locator('#status[data-state="converged"]').waitFor({ timeout: LONGEST_RUN });
    await page.locator("#clouds-note").waitFor({ state: "hidden" });
    return await still(page);
  } finally {
    await browser.close();
    close();
  }
}
