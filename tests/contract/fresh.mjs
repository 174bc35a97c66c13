// Fresh projects with the packed package, as npm installs it, and their pages in a browser.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { after } from "node:test";
import { chromium } from "@playwright/test";
import { headless } from "../../scripts/browser.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { serveSite } from "../../scripts/site/serve.mjs";
import { writeNpy, writePng } from "../../pkg/write.js";
import { init, sample } from "./support.mjs";

/** Limit that ends a test that hangs, milliseconds. */
const NEVER = 300_000;

/** Runs a program, which must succeed, and returns its output. Programs of this project's node_modules are found by name. */
export function run(program, args, cwd) {
  const env = { ...process.env, PATH: `${inRoot("node_modules/.bin")}${delimiter}${process.env.PATH}` };
  const { status, stdout, stderr } = spawnSync(program, args, { cwd, env, encoding: "utf8" });
  assert.equal(status, 0, `${program} ${args.join(" ")}\n${stdout}${stderr}`);
  return stdout;
}

/** Work for the end of a test file; Node's own `after`, called inside a hook or a test, would run too early. */
const endings = [];
after(async () => {
  for (const end of endings.reverse()) await end();
});

/** Registers work for the end of a test file. */
export const atTheEnd = (end) => void endings.push(end);

/** A temporary folder, removed at the end. */
export function folder() {
  const path = mkdtempSync(join(tmpdir(), "bimodal-stereo-"));
  endings.push(() => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** A project that contains only the package. */
export function freshProject() {
  const path = folder();
  writeFileSync(join(path, "package.json"), JSON.stringify({ name: "fresh", private: true, type: "module" }));
  const [{ filename }] = JSON.parse(
    run("npm", ["pack", inRoot("pkg"), "--json", "--pack-destination", path], inRoot()),
  );
  run("npm", ["install", "--offline", "--no-audit", "--no-fund", join(path, filename)], path);
  return path;
}

/** Writes files, given by their paths in a folder. */
export function write(path, files) {
  for (const [name, content] of Object.entries(files)) {
    mkdirSync(dirname(join(path, name)), { recursive: true });
    writeFileSync(join(path, name), content);
  }
}

/** A pair as files: the image as a linear 16-bit PNG, which is precise enough for the tests; the depth as float32. */
export async function pairFiles(request) {
  await init();
  const { image, depth } = sample({ surface: "bust", light: "colourful", ...request });
  const brightest = image.data.reduce((most, value) => Math.max(most, value), 0);
  const data = Uint16Array.from(image.data, (value) => (60_000 * value) / brightest);
  return { colour: await writePng({ ...image, channels: 3, data }), depth: writeNpy({ ...depth, channels: 1 }) };
}

/** The fenced examples in one language of a Markdown file. */
export const examples = (path, language) =>
  [...readFileSync(path, "utf8").matchAll(new RegExp("^```" + language + "\\n([\\s\\S]*?)^```", "gm"))].map(
    (m) => m[1],
  );

/** An HTML page with the given head. */
export const html = (head) =>
  `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><title>test</title>${head}\n`;

/** The address of a folder, served until the end of the tests. */
export async function served(path) {
  const { address, close } = await serveSite({ port: 0, below: "/", folder: path });
  endings.push(close);
  return address;
}

let started;
/** One browser, shared by all tests. */
export function chrome() {
  started ??= (async () => {
    const chrome = await chromium.launch({
      executablePath: await headless(),
      args: ["--no-sandbox", "--disable-background-networking", "--no-first-run"],
    });
    endings.push(() => chrome.close());
    return chrome;
  })();
  return started;
}

/**
 * Visits a page until its console shows "end" or it fails. Returns the console's lines, the paths of failed requests, and for each thread
 * whether it runs the package's code.
 */
export async function visit(address, { threads = 0 } = {}) {
  const page = await (await chrome()).newPage();
  const seen = { lines: [], missing: [], threads: [] };
  page.on("worker", (worker) => seen.threads.push(worker.evaluate(() => typeof self.onmessage).catch(String)));
  const ended = new Promise((done) => {
    page.on("response", (response) => {
      if (response.status() < 400) return;
      seen.missing.push(new URL(response.url()).pathname);
      // Without its script, a page logs nothing.
      if (["document", "script"].includes(response.request().resourceType())) done();
    });
    page.on("console", (message) => {
      seen.lines.push(message.text());
      if (message.text() === "end") done();
    });
    page.on("pageerror", (error) => {
      seen.lines.push(`uncaught ${error.message}`);
      done();
    });
  });
  const late = AbortSignal.timeout(NEVER);
  await page.goto(address);
  await Promise.race([
    ended,
    new Promise((_, fail) =>
      late.addEventListener("abort", () => fail(new Error(`${address}: ${seen.lines.join("\n")}`))),
    ),
  ]);
  // The browser may report a thread after the page's last line.
  while (seen.threads.length < threads && !late.aborted) await page.waitForTimeout(50);
  seen.threads = await Promise.all(seen.threads);
  await page.close();
  return seen;
}
