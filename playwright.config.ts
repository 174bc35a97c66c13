import { existsSync } from "node:fs";
import { defineConfig } from "@playwright/test";

/** `npm test` names a free port, so that two checkouts can be tested at once. */
const PORT = Number(process.env.PAGE_PORT ?? 4199);

/** The built page, as a host may have it: below some folder of its own. */
const FOLDER = "/some/folder/";

/** Learn has catalogues of other languages, and the page in these passes the same tests. */
const LEARN = /\/(?:learn|learn-layout|lecture|slides)\.spec\.ts$/;

/** Playwright's own browsers come from elsewhere; the system's serves as well. */
const chromium =
  process.env.CHROMIUM ??
  ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium", "/usr/bin/google-chrome"].find((path) => existsSync(path));

export default defineConfig({
  testDir: "tests/page",
  outputDir: "target/playwright",
  reporter: [["list"], ["./tests/page/skipped.ts"]],
  fullyParallel: true,
  workers: 2,
  // No test is about time: these end what hangs, and leave room for machines that are slow or busy.
  timeout: 300_000,
  expect: { timeout: 100_000, toPass: { timeout: 200_000 } },
  use: {
    baseURL: `http://127.0.0.1:${PORT}${FOLDER}`,
    // What a service worker answers, tests that stand in for a server could not; tests/page/site.spec.ts lets it in.
    serviceWorkers: "block",
    viewport: { width: 1280, height: 800 },
    launchOptions: {
      ...(chromium ? { executablePath: chromium } : {}),
      // Containers have no sandbox, machines for tests no graphics card, and the browser's own errands no business here.
      args: [
        "--no-sandbox",
        "--enable-unsafe-swiftshader",
        "--disable-background-networking",
        "--disable-component-update",
        "--no-first-run",
      ],
    },
  },
  projects: [{ name: "en" }, { name: "de", testMatch: LEARN, use: { locale: "de-DE" } }],
  webServer: {
    command: `node scripts/site/serve.mjs ${PORT} ${FOLDER}`,
    url: `http://127.0.0.1:${PORT}${FOLDER}`,
    reuseExistingServer: false,
    timeout: 300_000,
  },
});
