import { fileURLToPath } from "node:url";
import { defineConfig } from "@playwright/test";
import page from "./playwright.config";

/** A second engine: Debian's Firefox, which Playwright drives by WebDriver BiDi. It does not take Chromium's flags. */
export default defineConfig(page, {
  testDir: "tests/firefox",
  outputDir: "target/playwright-firefox",
  workers: 1,
  use: {
    browserName: "firefox",
    channel: "moz-firefox",
    // Firefox cannot block service workers by this protocol, so they stay allowed.
    serviceWorkers: "allow",
    launchOptions: { executablePath: fileURLToPath(new URL("tests/firefox/launcher.mjs", import.meta.url)), args: [] },
  },
});
