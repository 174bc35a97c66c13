// How much a visitor downloads, and how much it may be.
import { existsSync, readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { Failure, inRoot } from "./shell.mjs";

/** Most bytes of either wasm, gzipped; a visitor downloads one of them: two and a half seconds on a slow phone's 1 Mbit/s. */
export const WASM_BUDGET = 320_000;
/** Bytes of the page's scripts, gzipped, before anything is seen, stay below this: half a second there. */
export const FIRST_PAINT_BUDGET = 60_000;

const WASM = "pkg/bimodal_stereo_bg.wasm";
const SCALAR = "pkg/bimodal_stereo_scalar_bg.wasm";
const PAGE = "www/dist";
const zipped = (path) => gzipSync(readFileSync(path)).length;

/** Scripts that the page asks for before its first paint: those it names, and what these import at once. */
function firstScripts(folder) {
  const page = readFileSync(inRoot(folder, "index.html"), "utf8");
  const named = [...page.matchAll(/<(?:script|link)[^>]+(?:src|href)="\.\/([^"]+\.js)"/g)].map((match) => match[1]);
  const found = new Set();
  const waiting = [...named];
  while (waiting.length > 0) {
    const path = waiting.pop();
    if (found.has(path)) continue;
    found.add(path);
    const text = readFileSync(inRoot(folder, path), "utf8");
    const imports = [...text.matchAll(/(?:^|[;}])(?:import|export)\b(?:[^"';()]*from)?\s*["']\.\/([^"']+\.js)["']/g)];
    waiting.push(...imports.map((match) => path.replace(/[^/]+$/, match[1])));
  }
  return [...found].sort();
}

/** Builds the page that is measured. */
export async function buildPage() {
  const { build } = await import("vite");
  await build({ root: inRoot("www"), configFile: inRoot("www/vite.config.ts"), logLevel: "warn" });
}

/** Bytes of the built package and the built page. */
export function sizes() {
  for (const path of [WASM, SCALAR, `${PAGE}/index.html`]) if (!existsSync(inRoot(path))) throw new Failure(`${path} has not been built.`);
  const scripts = firstScripts(PAGE);
  return {
    wasmBytes: readFileSync(inRoot(WASM)).length,
    wasmGzipBytes: zipped(inRoot(WASM)),
    scalarBytes: readFileSync(inRoot(SCALAR)).length,
    scalarGzipBytes: zipped(inRoot(SCALAR)),
    jsGzipBytes: scripts.reduce((total, path) => total + zipped(inRoot(PAGE, path)), 0),
    scripts,
  };
}

/** The sizes beside their budgets, one line each, and whether all are kept. */
export function judgeSizes({ wasmGzipBytes, scalarGzipBytes, jsGzipBytes }) {
  const line = (name, bytes, kept, budget) =>
    `${name}: ${(bytes / 1000).toFixed(1)} kB gzipped, ${kept ? "within" : "OVER"} the budget of ${budget / 1000} kB`;
  const kept = [wasmGzipBytes <= WASM_BUDGET, scalarGzipBytes <= WASM_BUDGET, jsGzipBytes < FIRST_PAINT_BUDGET];
  const lines = [
    line("size of the wasm", wasmGzipBytes, kept[0], WASM_BUDGET),
    line("size of the wasm without SIMD", scalarGzipBytes, kept[1], WASM_BUDGET),
    line("size of the page's first scripts", jsGzipBytes, kept[2], FIRST_PAINT_BUDGET),
  ];
  return { lines, kept: kept.every(Boolean) };
}
