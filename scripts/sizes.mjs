// The sizes of a visitor's downloads, and their budgets.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { Failure, inRoot } from "./shell.mjs";
import { SITE, buildSite } from "./site/build.mjs";

/** Largest gzipped size of either wasm, of which a visitor downloads one, bytes: 3.6 seconds at 1 Mbit/s. */
export const WASM_BUDGET = 450_000;
/** Limit of the gzipped size of the scripts before the first paint, in bytes: half a second at 1 Mbit/s. */
export const FIRST_PAINT_BUDGET = 60_000;
/** Largest gzipped size of everything that a check of a rig loads beyond the Lab, with its readers, bytes. */
export const CHECK_BUDGET = 200_000;

const WASM = "pkg/bimodal_stereo_bg.wasm";
const SCALAR = "pkg/bimodal_stereo_scalar_bg.wasm";
const PAGE = SITE;
const zipped = (path) => gzipSync(readFileSync(path)).length;

/** Imports that load at once, and dynamic imports and .wasm files, which load on demand. */
const AT_ONCE = /(?:^|[;}])(?:import|export)\b(?:[^"';()]*from)?\s*["']\.\/([^"']+\.js)["']/g;
const ON_DEMAND = /import\(\s*["'`]\.\/([^"'`]+\.js)["'`]|new URL\(\s*["'`]([^"'`]+\.wasm)["'`]/g;

/** All files reachable from these by the kinds of imports that the patterns match. */
function reached(first, patterns, isLeftOut = () => false) {
  const found = new Set();
  const waiting = [...first];
  while (waiting.length > 0) {
    const path = waiting.pop();
    if (found.has(path) || isLeftOut(path)) continue;
    found.add(path);
    if (!path.endsWith(".js")) continue;
    const text = readFileSync(inRoot(PAGE, path), "utf8");
    for (const pattern of patterns)
      for (const [, script, file] of text.matchAll(pattern)) waiting.push(path.replace(/[^/]+$/, script ?? file));
  }
  return [...found].sort();
}

/** Scripts that load before the first paint: those named in the page and their immediate imports. */
function firstScripts() {
  const page = readFileSync(inRoot(PAGE, "index.html"), "utf8");
  return reached(
    [...page.matchAll(/<(?:script|link)[^>]+(?:src|href)="\.\/([^"]+\.js)"/g)].map((match) => match[1]),
    [AT_ONCE],
  );
}

const CHECK_WASM = /bimodal_stereo_check_bg/;
/** The rendered example, which loads on demand. */
const EXAMPLE = /\/(?:example-|rigs-|bimodal_stereo_rigs_bg)/;
/** The writers of calibrations and clouds and that of the report, which load when somebody saves one. */
const WRITERS = /\/write-/;
const REPORT = /^assets\/reportfile-/;
/**
 * Readers that load only for files of their kind: JPEG without a browser, PNM and PFM, NumPy's arrays, tables as text, raw pixels, colour profiles, texts, YAML, TOML, JSON with comments, calibrations of products,
 * lenses in separate files, point clouds and their poses, EXR, TIFF, recordings, messages about unsupported files. The code that makes the Lab's pair from
 * the files of a run belongs here as well.
 */
const OTHERS =
  /\/(?:decoder|dist\d*|pointclouds|exr|exr-others|products|text|tiff|tiff-codecs|js-yaml|recorded|containers|lens-files|turned|pairs|pnm|npy\d*(?!-matrix)|table-cells|raw-pixels|icc)-/;

/** The files that run a check and read its input, all loaded on demand, and those that only the example or a saved result needs. */
function checkFiles() {
  const scripts = readdirSync(inRoot(PAGE, "assets"))
    .filter((name) => name.endsWith(".js"))
    .map((name) => `assets/${name}`);
  const textOf = (path) => readFileSync(inRoot(PAGE, path), "utf8");
  const runners = scripts.filter((path) => CHECK_WASM.test(textOf(path)));
  // The worker that reads the files loads the check on demand.
  const loads = (path) => [...textOf(path).matchAll(ON_DEMAND)].some(([, name]) => runners.includes(`assets/${name}`));
  const workers = scripts.filter(loads);
  if (workers.length === 0) throw new Failure(`No script of the page loads one that names ${CHECK_WASM.source}.`);
  const first = [...runners, ...workers];
  const all = reached(first, [AT_ONCE, ON_DEMAND], (path) => OTHERS.test(path));
  const example = all.filter((path) => EXAMPLE.test(path));
  const saved = all.filter((path) => WRITERS.test(path));
  const reports = scripts.filter((path) => REPORT.test(path));
  for (const [some, pattern] of [
    [saved, WRITERS],
    [reports, REPORT],
  ])
    if (some.length === 0) throw new Failure(`No script of the page matches ${pattern.source}.`);
  const loaded = new Set([...all, ...firstScripts()]);
  const report = reached(reports, [AT_ONCE]).filter((path) => !loaded.has(path));
  const onDemand = new Set([...example, ...saved]);
  return { check: all.filter((path) => !onDemand.has(path)), example, saved, report };
}

/** Builds the page that is measured. */
export const buildPage = buildSite;

/** Sizes of the built package and the built page, bytes. */
export function sizes() {
  for (const path of [WASM, SCALAR, `${PAGE}/index.html`])
    if (!existsSync(inRoot(path))) throw new Failure(`${path} has not been built.`);
  const scripts = firstScripts();
  const { check, example, saved, report } = checkFiles();
  const total = (paths) => paths.reduce((sum, path) => sum + zipped(inRoot(PAGE, path)), 0);
  return {
    wasmBytes: readFileSync(inRoot(WASM)).length,
    wasmGzipBytes: zipped(inRoot(WASM)),
    scalarBytes: readFileSync(inRoot(SCALAR)).length,
    scalarGzipBytes: zipped(inRoot(SCALAR)),
    jsGzipBytes: total(scripts),
    scripts,
    checkGzipBytes: total(check),
    exampleGzipBytes: total(example),
    writersGzipBytes: total(saved),
    reportGzipBytes: total(report),
    check,
  };
}

/** The sizes beside their budgets, one line each, and whether all stay within them. */
export function judgeSizes({
  wasmGzipBytes,
  scalarGzipBytes,
  jsGzipBytes,
  checkGzipBytes,
  exampleGzipBytes,
  writersGzipBytes,
  reportGzipBytes,
}) {
  const line = (name, bytes, kept, budget) =>
    `${name}: ${(bytes / 1000).toFixed(1)} kB gzipped, ${kept ? "within" : "OVER"} the budget of ${budget / 1000} kB`;
  const kept = [
    wasmGzipBytes <= WASM_BUDGET,
    scalarGzipBytes <= WASM_BUDGET,
    jsGzipBytes < FIRST_PAINT_BUDGET,
    checkGzipBytes <= CHECK_BUDGET,
  ];
  const lines = [
    line("size of the wasm", wasmGzipBytes, kept[0], WASM_BUDGET),
    line("size of the wasm without SIMD", scalarGzipBytes, kept[1], WASM_BUDGET),
    line("size of the page's first scripts", jsGzipBytes, kept[2], FIRST_PAINT_BUDGET),
    line("size of the check with its readers", checkGzipBytes, kept[3], CHECK_BUDGET),
    `size of the rendered example, on demand: ${(exampleGzipBytes / 1000).toFixed(1)} kB gzipped`,
    `size of the writers, when a calibration or a cloud is saved: ${(writersGzipBytes / 1000).toFixed(1)} kB gzipped`,
    `size of a check's report, when it is saved: ${(reportGzipBytes / 1000).toFixed(1)} kB gzipped`,
  ];
  return { lines, kept: kept.every(Boolean) };
}
