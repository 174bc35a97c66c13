// The two places where the loop is timed: a browser's worker and a native process. Both answer the same requests.
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import { Failure, inRoot } from "../shell.mjs";

/** The browser has no sandbox, as in containers, no graphics card, as on test machines, and no background traffic. */
const FLAGS = [
  "--no-sandbox",
  "--enable-unsafe-swiftshader",
  "--disable-background-networking",
  "--disable-component-update",
  "--no-first-run",
];

export async function launch(executablePath) {
  const { chromium } = await import("@playwright/test");
  return chromium.launch({ executablePath, args: FLAGS });
}

/** Opens a new page, with a renderer that has compiled nothing yet. */
export async function openPage(chromium, address) {
  const context = await chromium.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  // There is no time limit, because runs may take long.
  page.setDefaultTimeout(0);
  await page.goto(address);
  return { page, close: () => context.close() };
}

/** The package in a browser's worker; `start` creates a new worker, whose memory has not grown yet. */
export async function browserSide(chromium, address) {
  const { page, close } = await openPage(chromium, `${address}/scripts/bench/page/`);
  const ask = (request) => page.evaluate((given) => window.bench.ask(given), request);
  return {
    where: "browser",
    /** Numbers of workers with which runs are timed. */
    workerCounts: [1, 2],
    ask,
    async open({ path }) {
      await page.evaluate(() => window.bench.start());
      await ask({ kind: "init" });
      await ask({ kind: "scene", path: `/${path}` });
    },
    run: ({ start, shading = "surface", most, workers = 1 }) => ask({ kind: "run", start, shading, most, workers }),
    close,
  };
}

/** benches/rounds.rs as a process that waits for requests. */
export function nativeSide() {
  const child = spawn("cargo", ["bench", "--quiet", "--bench", "rounds", "--", "requests"], {
    cwd: inRoot(),
    stdio: ["pipe", "pipe", "inherit"],
  });
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  async function ask(...words) {
    child.stdin.write(`${words.join(" ")}\n`);
    const { value, done } = await lines.next();
    if (done) throw new Failure("The native bench ended early; see its message above.");
    return JSON.parse(value);
  }
  return {
    where: "native",
    workerCounts: [1],
    open: ({ path }) => ask("scene", path),
    run: ({ start, shading = "surface", most }) => ask("run", start, shading, most),
    close: () => child.stdin.end(),
  };
}
