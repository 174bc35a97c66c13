// npm test: sets up, builds, and runs what shows most mistakes within minutes. `npm test -- contract page` runs only these parts.
// `npm test -- --long` adds the other parts, and in each part the tests that take over three seconds.
import { readFileSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { availableParallelism } from "node:os";
import { browser, firefox, headless } from "./browser.mjs";
import { build } from "./build.mjs";
import { notebooks } from "./notebooks.mjs";
import { python } from "./python.mjs";
import { WASM, setup } from "./setup.mjs";
import { Failure, ask, inOnePiece, inRoot, matching, print, say, script, seconds, watch } from "./shell.mjs";
import { buildPage, judgeSizes, sizes } from "./sizes.mjs";
import { hasData } from "./tables/library.mjs";
import { missingKeys } from "./tables/keys.mjs";

/** Whether long tests run as well: those of Rust's modules called `long`, those marked LONG, and whole parts. */
const LONG = process.argv.includes("--long");
/** Arguments that make cargo's test programs skip long tests. */
const SHORT = LONG ? [] : ["--skip", "::long::"];
const DENY = ["--", "-D", "warnings"];
const modules = (path) => inRoot("node_modules", path);
const cargo =
  (...args) =>
  () =>
    watch("cargo", args);
/**
 * The library is built for browsers, the command line in cli/ is not, so builds for browsers must name the package. A choice of packages
 * also chooses their crates' features, and cargo keeps only one build of the library: a build with another choice discards it.
 */
const LIBRARY = ["-p", "bimodal-stereo"];
/** A test in a browser may also run to its end; the runner's own limit is twenty seconds. */
const PATIENCE = { WASM_BINDGEN_TEST_TIMEOUT: "1800" };
/** Modules of `tests/library` with searches and sweeps: they always run natively, and as wasm only with `--long`. */
const SEARCHES = [
  "initialisation",
  "opening",
  "painted",
  "pose_search",
  "refinement_workers",
  "resolutions",
  "rig_laws",
  "scene_laws",
  "initial_pose",
];
const WITHOUT_SEARCHES = [...SEARCHES.flatMap((name) => ["--skip", `${name}::`]), "--skip", "::long::"];
/** The library's tests that read no files, compiled for wasm. */
const wasmTests = (where, chosen = WITHOUT_SEARCHES, targets = ["--lib", "--test", "library"]) =>
  watch("cargo", ["test", ...LIBRARY, "--target", WASM, ...targets, "--", ...chosen], {
    env: { ...PATIENCE, ...where },
  });
/**
 * In Node, `--long` runs all of them, the longest as a separate part. A page and a worker have the same engine, so long tests would
 * only repeat the computation.
 */
const wasmInNode = () => wasmTests({}, LONG ? ["--skip", "::long::"] : WITHOUT_SEARCHES);
const longWasmInNode = () => wasmTests({}, ["::long::"], ["--test", "library"]);
/** Largest number of runs in a browser. A run is repeated if a loaded machine loses the driver, but not if a test fails. */
const MOST_RUNS = 3;
const wasmIn = (variable) => async () => {
  const run = async () => wasmTests({ [variable]: "1", CHROMEDRIVER: (await browser()).chromedriver });
  const isDriverLost = ({ code, output }) => code !== 0 && /^driver status: /m.test(output) && !/ FAILED/.test(output);
  let result = await run();
  for (let runs = 1; runs < MOST_RUNS && isDriverLost(result); runs++) {
    say("the driver was lost before the tests ended: once more");
    result = await run();
  }
  return result;
};
/** Native builds check all optional features; builds for browsers have none. */
const FEATURES = ["--all-features"];

/** Every TypeScript project: the facade, the page, its worker, the tests, the example in React. */
async function types() {
  let output = "";
  let code = 0;
  for (const project of matching(["js", "www", "tests", "examples"], /^tsconfig(\..+)?\.json$/)) {
    say(`tsc -p ${project}`);
    const result = await watch(process.execPath, [
      modules("typescript/bin/tsc"),
      "-p",
      project,
      "--noEmit",
      "--emitDeclarationOnly",
      "false",
    ]);
    code ||= result.code;
    output += `tsc ${project}: ${result.code === 0 ? "no errors" : "errors"}\n`;
  }
  return { code, output };
}

const biome = () => watch(process.execPath, [modules("@biomejs/biome/bin/biome"), "ci"]);

/** A free port. */
function freePort() {
  return new Promise((found) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => found(port));
    });
  });
}

/** The documentation as docs.rs builds it: a broken link fails. Its examples run with the tests. */
const docs = () =>
  watch("cargo", ["doc", ...LIBRARY, "--no-deps", ...FEATURES], { env: { RUSTDOCFLAGS: "-D warnings" } });

/** The files of tests/page that visit each place of the page; the others test details, with `--long`. */
const PLACES = ["run", "files", "saved", "learn", "rig", "rig-frames", "report", "tables", "security", "site"];

async function page() {
  const env = { CHROMIUM: await headless(), PAGE_PORT: String(await freePort()) };
  const short = ["--grep-invert", "@long", ...PLACES.map((name) => `/${name}\\.spec\\.ts$`)];
  return watch(process.execPath, [modules("@playwright/test/cli.js"), "test", ...(LONG ? [] : short)], { env });
}

/** Adds what needs a missing optional tool to the tests that did not run. */
function without(what, reason) {
  const output = `skipped: ${what} # ${reason}\n`;
  print(output);
  return { code: 0, output };
}

/** The first Firefox with the command network.addDataCollector, which Playwright needs. */
const OLDEST_FIREFOX = 143;

/** The page in Firefox, if Playwright can drive the installed one. */
async function firefoxPage(program) {
  const what = "the page in Firefox";
  if (!program) return without(what, "needs firefox-esr (apt-get install firefox-esr)");
  const version = /(\d+)\.\S+/.exec(ask(program, ["--version"]) ?? "");
  if (version && Number(version[1]) < OLDEST_FIREFOX)
    return without(what, `needs Firefox ${OLDEST_FIREFOX}, this is ${version[0]}`);
  const env = { FIREFOX: program, PAGE_PORT: String(await freePort()) };
  return watch(process.execPath, [modules("@playwright/test/cli.js"), "test", "-c", "playwright.firefox.config.ts"], {
    env,
  });
}

/** Tests of the second engine, if installed: a smoke test of every part of the page by Playwright, and the wasm tests by geckodriver. */
async function secondEngine() {
  const found = firefox();
  const page = await firefoxPage(found.firefox);
  const wasm =
    found.firefox && found.geckodriver
      ? await wasmTests({ WASM_BINDGEN_USE_BROWSER: "1", GECKODRIVER: found.geckodriver })
      : without("the wasm tests in Firefox", "needs geckodriver (cargo install geckodriver)");
  return { code: page.code || wasm.code, output: `${page.output}\n${wasm.output}` };
}

/** Licences, duplicates and sources of all crates; needs no network. */
function deny() {
  if (!ask("cargo", ["deny", "--version"]))
    return without("licenses and sources of the crates", "needs cargo-deny (cargo install cargo-deny)");
  return watch("cargo", ["deny", "--offline", "check", "licenses", "bans", "sources"]);
}

/** No test measures time; this limit, in milliseconds, ends a test that hangs. */
const HANGS = 1_800_000;
const contract = () => {
  const files = matching(["tests/contract"], /\.test\.mjs$/);
  // At least two files run at once; Node's own default is one on two processors.
  return watch(
    process.execPath,
    [
      // Node 20 can wait forever at its exit, for a compiler thread that waits for the garbage collection of the thread that exits.
      "--no-concurrent-recompilation",
      "--test",
      "--test-reporter=spec",
      `--test-concurrency=${Math.max(2, availableParallelism() - 1)}`,
      `--test-timeout=${HANGS}`,
      ...files,
    ],
    {
      env: LONG ? { LONG_TESTS: "1" } : {},
    },
  );
};

/**
 * Without `--long` only the library is tested, because compiling the readers and the command line takes longer than their tests. Tests that
 * need the data beside the project are marked as ignored, with that reason, and included if the data are there.
 */
const rust = () =>
  watch("cargo", [
    ...["test", ...(LONG ? [] : LIBRARY), ...FEATURES, "--"],
    ...(hasData() ? ["--include-ignored"] : []),
    ...SHORT,
  ]);

/** This part shows missed aims but does not fail because of them. It fails if a cell throws or the JSON lacks a key. */
async function tables() {
  const file = inRoot("target/tables/quick.json");
  rmSync(file, { force: true });
  const result = await watch(process.execPath, [inRoot("scripts/tables.mjs"), "--quick", "--json", file]);
  if (result.code !== 0) return result;
  const missing = missingKeys(JSON.parse(readFileSync(file, "utf8")), { realPairs: hasData() });
  const lines = [missing.length === 0 ? "tables: every key is there" : `tables: the JSON lacks ${missing.join(", ")}`];
  if (!hasData()) lines.push("skipped: real pairs and photographs # needs ../shared/data");
  print(`${lines.join("\n")}\n`);
  return { code: missing.length === 0 ? 0 : 1, output: `${result.output}\n${lines.join("\n")}\n` };
}

/** The sizes of a visitor's downloads against their budgets. */
async function downloads() {
  await buildPage();
  const { lines, kept } = judgeSizes(sizes());
  print(`${lines.join("\n")}\n`);
  return { code: kept ? 0 : 1, output: `${lines.join("\n")}\n` };
}

/** The last lines of a runner's output, which are repeated at the end. */
const CARGO = /^(test result: .*|error: test failed.*|error: could not compile.*)$/gm;
const NODE = /^(?:# |ℹ )((?:tests|pass|fail|skipped) .*)$/gm;
const PYTHON = /^(\d+ (?:passed|failed).* in .*|Found \d+ errors? .*)$/gm;

/** How cargo, Node, pytest and the page's reporter (or `tables`) report a test that did not run: its name and the reason. */
const NOT_RUN = [
  /^test (?<name>.+) \.\.\. ignored(?:, (?<reason>.+))?$/gm,
  /^ *﹣ (?<name>.+) \([\d.]+ms\) # (?<reason>.+)$/gm,
  /^skipped: (?<name>.+) # (?<reason>.+)$/gm,
];

/** One line for each reason why tests did not run, with the number and names of the tests. */
function notRun(output) {
  const names = new Map();
  const found = NOT_RUN.flatMap((pattern) => [...output.matchAll(pattern)]);
  for (const {
    groups: { name, reason = "no reason given" },
  } of found)
    names.set(reason, [...(names.get(reason) ?? []), name]);
  const lines = [...names].map(([reason, all]) => `NOT RUN: ${all.length}, ${reason} (${all.join(", ")})`);
  return { count: found.length, lines };
}

/** The lane of a part that may run in either. */
const EITHER = -1;

/**
 * The parts in the order of running. Two lanes run in parallel: cargo's, and that of parts that need the package, which also builds the
 * page. The lane that ends first takes the parts that may run in either. Parts that are `long` run with `--long` or by name.
 */
const PARTS = [
  { name: "format", run: cargo("fmt", "--check") },
  // Layout and lint of all TypeScript and JavaScript.
  { name: "biome", run: biome, closing: /^(?:Checked \d+ files.*|Found .*)$/gm },
  { name: "rust", run: rust, lane: 0, closing: CARGO },
  { name: "clippy", run: cargo("clippy", "--all-targets", ...FEATURES, ...DENY), long: true, lane: 0, closing: CARGO },
  {
    name: "clippy-wasm",
    run: cargo("clippy", ...LIBRARY, "--target", WASM, "--all-targets", "--features", "bindings", ...DENY),
    long: true,
    lane: 0,
    closing: CARGO,
  },
  // The bindings of the calibration check and of its rendered rigs, which are separate files.
  {
    name: "clippy-check",
    run: cargo("clippy", ...LIBRARY, "--target", WASM, "--lib", "--features", "bindings-check", ...DENY),
    long: true,
    lane: 0,
    closing: CARGO,
  },
  {
    name: "clippy-rigs",
    run: cargo("clippy", ...LIBRARY, "--target", WASM, "--lib", "--features", "bindings-rigs", ...DENY),
    long: true,
    lane: 0,
    closing: CARGO,
  },
  { name: "docs", run: docs, long: true, lane: 0, closing: CARGO },
  { name: "deny", run: deny, long: true, lane: 0, closing: /^.*bans \w+, .*$/gm },
  { name: "wasm-node", run: wasmInNode, long: true, lane: 0, closing: CARGO },
  { name: "wasm-browser", run: wasmIn("WASM_BINDGEN_USE_BROWSER"), long: true, lane: 0, closing: CARGO },
  { name: "wasm-worker", run: wasmIn("WASM_BINDGEN_USE_DEDICATED_WORKER"), long: true, lane: 0, closing: CARGO },
  { name: "wasm-long", run: longWasmInNode, long: true, lane: EITHER, closing: CARGO },
  { name: "sizes", run: downloads, needsBuild: true, lane: 1, closing: /^size of .*$/gm },
  {
    name: "firefox",
    run: secondEngine,
    needsBuild: true,
    long: true,
    lane: 1,
    closing: /^(?: +\d+ (?:passed|failed|skipped|flaky)|test result: ).*$/gm,
  },
  { name: "types", run: types, needsBuild: true, lane: 1, closing: /^tsc .*$/gm },
  { name: "python", run: python, needsBuild: true, long: true, lane: 1, closing: PYTHON },
  { name: "notebooks", run: notebooks, needsBuild: true, long: true, lane: 1, closing: NODE },
  { name: "contract", run: contract, needsBuild: true, lane: 1, closing: NODE },
  {
    name: "tables",
    run: tables,
    needsBuild: true,
    long: true,
    lane: EITHER,
    closing: /^(?:.* (?:ok|MISSED)$|.* cells failed:|tables: .*)$/gm,
  },
  {
    name: "page",
    run: page,
    needsBuild: true,
    // Counts, the names of failed tests, and for each of them the failed line of code with the expected and the received value.
    closing:
      /^ +(?:\d+ (?:passed|failed|skipped|flaky|did not run)| {3}\[\w+\] › |(?:Error|Expected|Received)\b.*: |> +\d+ \| ).*$/gm,
  },
];

function chosen(names) {
  const unknown = names.filter((name) => !PARTS.some((part) => part.name === name));
  if (unknown.length > 0) {
    throw new Failure(`There is no part "${unknown[0]}"; there are ${PARTS.map((part) => part.name).join(", ")}.`);
  }
  return PARTS.filter((part) => (names.length === 0 ? LONG || !part.long : names.includes(part.name)));
}

/** The package is built once for all parts that need it. */
let building;
const built = () => (building ??= build());

/** Runs one part. Any error makes the part fail, so that the others still run. */
async function attempt({ name, run, needsBuild, closing }) {
  print(`\n=== ${name} ${"=".repeat(Math.max(0, 70 - name.length))}\n`);
  const start = performance.now();
  let result;
  try {
    if (needsBuild) await built();
    result = await run();
  } catch (error) {
    if (!(error instanceof Failure)) throw error;
    print(`${error.message}\n`);
    result = { code: 1, output: "" };
  }
  const closed = closing ? [...result.output.matchAll(closing)].map((match) => (match[1] ?? match[0]).trim()) : [];
  const { count, lines } = notRun(result.output);
  return { name, passed: result.code === 0, lines: [...closed, ...lines], notRun: count, time: seconds(start) };
}

async function inTurn(parts, run) {
  const results = [];
  for (const part of parts) results.push(await run(part));
  return results;
}

/** Runs consecutive parts that have lanes in parallel, and the others one by one. */
async function attemptAll(parts) {
  const first = parts.findIndex(isInLane);
  const ofLane = (lane) => parts.filter((part) => part.lane === lane);
  const lanes = [0, 1].map(ofLane).filter((lane) => lane.length > 0);
  if (lanes.length < 2) return inTurn(parts, attempt);
  const before = await inTurn(parts.slice(0, first), attempt);
  const either = ofLane(EITHER);
  const inOne = (part) => inOnePiece(() => attempt(part));
  const beside = await Promise.all(
    lanes.map(async (lane) => {
      const results = await inTurn(lane, inOne);
      while (either.length > 0) results.push(await inOne(either.shift()));
      return results;
    }),
  );
  return [
    ...before,
    ...beside.flat(),
    ...(await inTurn(
      parts.slice(first).filter((part) => !isInLane(part)),
      attempt,
    )),
  ];
}
const isInLane = ({ lane }) => lane !== undefined;

await script(async () => {
  const parts = chosen(process.argv.slice(2).filter((argument) => argument !== "--long"));
  const start = performance.now();
  await setup();
  const results = await attemptAll(parts);

  console.log(`\n=== summary ${"=".repeat(63)}`);
  for (const { name, passed, lines, time } of results) {
    console.log(`${passed ? "ok    " : "FAILED"}  ${name.padEnd(13)} ${time.padStart(8)}`);
    for (const line of lines) console.log(`          ${line}`);
  }
  const failed = results.filter((result) => !result.passed).map((result) => result.name);
  const left = results.reduce((sum, result) => sum + result.notRun, 0);
  if (left > 0) console.log(`\n${left} tests were NOT RUN; the lines above say which and why.`);
  const out = PARTS.filter((part) => !parts.includes(part)).map((part) => part.name);
  const names = out.length > 0 ? ` Parts left out: ${out.join(", ")}.` : "";
  if (!LONG) console.log(`\nLong tests were left out: \`npm test -- --long\` runs everything.${names}`);
  console.log(
    failed.length === 0
      ? `\nAll parts passed in ${seconds(start)}.`
      : `\nFailed: ${failed.join(", ")} (${seconds(start)}).`,
  );
  if (failed.length > 0) process.exitCode = 1;
});
