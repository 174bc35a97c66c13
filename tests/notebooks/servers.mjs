// Servers of notebooks and a browser for their pages.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { chromium } from "@playwright/test";

/** The programs of the environment with JupyterLab and marimo (scripts/notebooks.mjs). */
export const program = (name) => join(process.env.NOTEBOOKS, name);

/** Options that ignore the user's own settings and send no requests to other servers. */
export function environment(folder) {
  const own = {
    HOME: folder,
    JUPYTER_CONFIG_DIR: folder,
    IPYTHONDIR: folder,
    XDG_CONFIG_HOME: folder,
    XDG_STATE_HOME: folder,
  };
  return { ...process.env, ...own, PATH: `${process.env.NOTEBOOKS}:${process.env.PATH}`, JUPYTER_PLATFORM_DIRS: "1" };
}

export function folder() {
  const path = mkdtempSync(join(tmpdir(), "bimodal-stereo-"));
  after(() => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** Starts a server and resolves with the address that it prints. */
export function serve(name, args, cwd) {
  const child = spawn(program(name), args, { cwd, env: environment(cwd), stdio: ["ignore", "pipe", "pipe"] });
  const ended = new Promise((done) => child.once("close", done));
  after(async () => {
    child.kill("SIGTERM");
    await ended;
  });
  return new Promise((found, fail) => {
    let output = "";
    const read = (chunk) => {
      output += chunk;
      const [address] = /http:\/\/(?:127\.0\.0\.1|localhost):\d+/.exec(output) ?? [];
      if (address) found(address);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.once("error", fail);
    void ended.then(() => fail(new Error(`${name} ended: ${output}`)));
  });
}

export async function opened(address) {
  const chrome = await chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--disable-background-networking", "--no-first-run"],
  });
  after(() => chrome.close());
  const page = await chrome.newPage({ viewport: { width: 1280, height: 1600 } });
  page.setDefaultTimeout(120_000);
  await page.goto(address);
  return page;
}

/** Both widgets have been drawn: the run has ended, and its canvases show more than one colour. */
export async function drawn(page) {
  await page.locator("bimodal-figure").getByRole("region").waitFor();
  await page.locator("bimodal-figure canvas").first().waitFor();
  await page
    .locator("bimodal-stereo [role=status]")
    .getByText(/^converged/)
    .waitFor();
  await page.locator("bimodal-stereo .learn-plot .curve").first().waitFor({ state: "attached" });
  return page.evaluate(() => {
    const coloursOf = (canvas) => {
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
      copy.drawImage(canvas, 0, 0);
      return new Set(new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size;
    };
    const canvases = (root) =>
      [...root.querySelectorAll("*")].flatMap((each) => [
        ...(each.localName === "canvas" ? [each] : []),
        ...(each.shadowRoot ? canvases(each.shadowRoot) : []),
      ]);
    return canvases(document.body)
      .filter((canvas) => canvas.getRootNode() !== document)
      .map(coloursOf);
  });
}
