// Fresh projects with the packed package in them, as npm leaves it for others, and their pages in a browser.
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

/** Ends what hangs, milliseconds. */
const NEVER = 300_000;

/** Runs a program to its end, which has to be a good one; what it printed. Programs of our node_modules are found by name. */
export function run(program, args, cwd) {
  const env = { ...process.env, PATH: `${inRoot("node_modules/.bin")}${delimiter}${process.env.PATH}` };
  const { status, stdout, stderr } = spawnSync(program, args, { cwd, env, encoding: "utf8" });
  assert.equal(status, 0, `${program} ${args.join(" ")}\n${stdout}${stderr}`);
  return stdout;
}

/** What is to be done after all tests of a file; asked for inside a hook or a test, Node's own `after` would come too early. */
const endings = [];
after(async () => {
  for (const end of endings.reverse()) await end();
});

/** Has something done after all tests of a file. */
export const atTheEnd = (end) => void endings.push(end);

/** A folder that is gone after the tests. */
export function folder() {
  const path = mkdtempSync(join(tmpdir(), "bimodal-stereo-"));
  endings.push(() => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** A project that has the package and nothing else. */
export function freshProject() {
  const path = folder();
  writeFileSync(join(path, "package.json"), JSON.stringify({ name: "fresh", private: true, type: "module" }));
  const [{ filename }] = JSON.parse(
    run("npm", ["pack", inRoot("pkg"), "--json", "--pack-destination", path], inRoot()),
  );
  run("npm", ["install", "--offline", "--no-audit", "--no-fund", join(path, filename)], path);
  return path;
}

/** Writes files, by their paths in a folder. */
export function write(path, files) {
  for (const [name, content] of Object.entries(files)) {
    mkdirSync(dirname(join(path, name)), { recursive: true });
    writeFileSync(join(path, name), content);
  }
}

/** A pair as files: the image as PNG of 16 bits, linear, so that nothing of it is lost; the depth as float32. */
export async function pairFiles(request) {
  await init();
  const { image, depth } = sample({ surface: "bust", light: "colourful", ...request });
  const brightest = image.data.reduce((most, value) => Math.max(most, value), 0);
  const data = Uint16Array.from(image.data, (value) => (60_000 * value) / brightest);
  return { colour: await writePng({ ...image, channels: 3, data }), depth: writeNpy({ ...depth, channels: 1 }) };
}

/** The fenced examples of one language in a Markdown file. */
export const examples = (path, language) =>
  [...readFileSync(path, "utf8").matchAll(new RegExp("^```" + language + "\\n([\\s\\S]*?)^```", "gm"))].map(
    (m) => m[1],
  );

/** An HTML page with something in its head. */
export const html = (head) =>
  `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><title>test</title>${head}\n`;

/** The addresses of folders, until the tests are over. */
export async function served(path) {
  const { address, close } = await serveSite({ port: 0, below: "/", folder: path });
  endings.push(close);
  return address;
}

let started;
/** One browser for all. */
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
 * What a page says in its console until it says "end" or fails, the answers of its server that were none, and its threads:
 * whether each of them runs our code.
 */
export async function visit(address, { threads = 0 } = {}) {
  const page = await (await chrome()).newPage();
  const seen = { lines: [], missing: [], threads: [] };
  page.on("worker", (worker) => seen.threads.push(worker.evaluate(() => typeof self.onmessage).catch(String)));
  const ended = new Promise((done) => {
    page.on("response", (response) => {
      if (response.status() < 400) return;
      seen.missing.push(new URL(response.url()).pathname);
      // Without its script a page says nothing.
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
  // The browser may tell of a thread after what its page has said.
  while (seen.threads.length < threads && !late.aborted) await page.waitForTimeout(50);
  seen.threads = await Promise.all(seen.threads);
  await page.close();
  return seen;
}
