import { existsSync } from "node:fs";
import { defineConfig } from "@playwright/test";

/** `npm test` names a free port, so that two checkouts can be tested at once. */
const PORT = Number(process.env.PAGE_PORT ?? 4199);

/** The built page is served below a folder, as some hosts do. */
const FOLDER = "/some/folder/";

/** Learn has catalogues of other languages; its tests also run in these. */
const LEARN = /\/(?:learn|learn-layout|lecture|questions|slide-figures|slides)\.spec\.ts$/;

/** The system's browser is used, because Playwright would download its own. */
const chromium =
  process.env.CHROMIUM ??
  ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium", "/usr/bin/google-chrome"].find((path) => existsSync(path));

export default defineConfig({
  testDir: "tests/page",
  outputDir: "target/playwright",
  reporter: [["list"], ["./tests/page/skipped.ts"]],
  fullyParallel: true,
  workers: 2,
  // No test measures time. These limits end tests that hang, and leave room for slow or busy machines.
  timeout: 300_000,
  expect: { timeout: 100_000, toPass: { timeout: 200_000 } },
  use: {
    baseURL: `http://127.0.0.1:${PORT}${FOLDER}`,
    // Service workers are blocked, because their answers would bypass the routes of the tests. tests/page/site.spec.ts permits them.
    serviceWorkers: "block",
    viewport: { width: 1280, height: 800 },
    launchOptions: {
      ...(chromium ? { executablePath: chromium } : {}),
      // Containers have no sandbox, test machines have no graphics card, and the browser's background traffic is switched off.
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
