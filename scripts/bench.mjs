// npm run bench: times the built package in a browser's worker and the same work natively, with runs alternating.
//   --quick          fewer sizes and samples, under a minute
//   --sizes a,b      only these sizes, as 64x64,640x480
//   --json FILE      the numbers as JSON
//   --docs           medians and aims into the marked region of docs/performance.md
//   --browser-only, --native-only
//   --beside         instead: the package beside the same stages in numpy, scipy and Open3D, run in turn
import { writeFileSync } from "node:fs";
import { cpus, loadavg } from "node:os";
import { resolve } from "node:path";
import { parseArgs } from "node:util";
import { FULL_BESIDE, QUICK_BESIDE, measureBeside } from "./bench/beside.mjs";
import { drawings, playing, startUps, transfers } from "./bench/page.mjs";
import { besideReport } from "./bench/print-beside.mjs";
import { report } from "./bench/print.mjs";
import { searches, sharedSteps, stages } from "./bench/rounds.mjs";
import { scenes } from "./bench/scenes.mjs";
import { serve } from "./bench/server.mjs";
import { browserSide, launch, nativeSide } from "./bench/sides.mjs";
import { aims, pixelsOf, summary } from "./bench/summary.mjs";
import { browser } from "./browser.mjs";
import { build } from "./build.mjs";
import { fill, benchLines, besideLines } from "./docs.mjs";
import { setup } from "./setup.mjs";
import { Failure, must, say, script, seconds } from "./shell.mjs";
import { buildPage, sizes as measureSizes } from "./sizes.mjs";

const SIZES = ["32x32", "64x64", "128x128", "256x256", "640x480"];
/** A median of fewer samples is unreliable on a busy machine. */
const SAMPLES = 20;
/** Views of up to this many pixels are searched three times; larger views take long and are searched once. */
const SOON = 128 * 128;
/** Number of pixels from which workers share iterations (js/estimator.ts), rounded up to a size that is timed. */
const SHARED = 128 * 128;
const RANDOM_SIZES = ["64x64", "128x128"];
const RANDOM_SCENES = 8;
/** The size for which memory and the transfer of a frame are measured. */
const LARGEST = "640x480";
const STARTED = "64x64";

const FULL = { sizes: SIZES, samples: SAMPLES, again: 3, randomSizes: RANDOM_SIZES, randomScenes: RANDOM_SCENES };
const QUICK = { sizes: ["32x32", "64x64"], samples: 5, again: 1, randomSizes: ["64x64"], randomScenes: 3 };

function parsed() {
  const flag = { type: "boolean", default: false };
  const options = {
    quick: flag,
    docs: flag,
    beside: flag,
    "browser-only": flag,
    "native-only": flag,
    json: { type: "string" },
    sizes: { type: "string" },
  };
  try {
    const { quick, docs, json, beside, sizes: named, ...only } = parseArgs({ options }).values;
    const plan = beside ? (quick ? QUICK_BESIDE : FULL_BESIDE) : quick ? QUICK : FULL;
    const sizes = named?.split(",") ?? plan.sizes;
    const unknown = sizes.find((size) => !SIZES.includes(size));
    if (unknown) throw new Error(`There is no size "${unknown}"; there are ${SIZES.join(", ")}.`);
    const randomSizes = plan.randomSizes.filter((size) => sizes.includes(size));
    return {
      ...{ json, quick, docs, beside },
      plan: { ...plan, sizes, randomSizes },
      native: !only["browser-only"],
      inBrowser: !only["native-only"],
    };
  } catch (error) {
    throw new Failure(error.message);
  }
}

/** Measures the loop itself: stages, complete runs, random scenes, and the memory after the largest run. */
async function loops(sides, made, plan) {
  const found = { samples: [], ends: [], converged: [], searches: [], memory: undefined };
  for (const size of plan.sizes) {
    const scene = made.plain(size);
    found.covered = scene.covered;
    const { rows, ends } = await stages(sides, scene, { size, least: plan.samples });
    found.samples.push(...rows);
    if (pixelsOf(size) >= SHARED)
      found.samples.push(...(await sharedSteps(sides, scene, { size, least: plan.samples })));
    found.ends.push(...ends);
    found.converged.push(...(await searches(sides, scene, { size, times: pixelsOf(size) <= SOON ? plan.again : 1 })));
    const reader = sides.find(({ where }) => where === "browser");
    if (size === LARGEST && reader) {
      const bytes = await reader.ask({ kind: "memory" });
      found.memory = { size, bytes, bytesPerPixel: bytes / scene.pixels };
    }
  }
  for (const size of plan.randomSizes) {
    for (let seed = 1; seed <= plan.randomScenes; seed++) {
      found.searches.push(
        ...(await searches(sides, made.random(size, seed), { size, times: 1, name: `${size}, scene ${seed}` })),
      );
    }
  }
  return found;
}

/** Measures the work around the loop in a browser. */
async function around(chromium, address, side, made, plan) {
  const startScene = made.plain(STARTED);
  const startUp = { size: STARTED, times: await startUps(chromium, address, startScene, plan.samples) };
  say(`init to first report: ${plan.samples} times`);
  const size = plan.sizes.at(-1);
  await side.open(made.plain(size));
  const transfer = { size, ...(await transfers(side, plan.samples)) };
  say(`transfer of a frame: ${plan.samples} times`);
  const drawing = await drawings(chromium, address, plan.samples);
  say(`drawing of a frame: ${plan.samples} times`);
  const played = await playing(chromium, address);
  say(`the page played for ${played.seconds.toFixed(1)} s`);
  return { startUp, transfer, drawing, playing: played };
}

/** The machine as the reports name it. */
function machine() {
  const [one] = loadavg();
  return { load: one, machine: `${cpus()[0].model}, ${cpus().length} processors, load ${one.toFixed(1)}` };
}

function keep(file, result) {
  if (!file) return;
  writeFileSync(resolve(file), `${JSON.stringify(result, null, 1)}\n`);
  say(`wrote ${file}`);
}

/** The comparison with what a person would write instead. */
async function compared(api, made, { plan, quick, json: file, docs }) {
  const result = { ...(await measureBeside(api, made, plan)), ...machine(), quick };
  console.log(`\n${besideReport(result).join("\n")}\n`);
  keep(file, result);
  if (docs) fill("docs/performance.md", "beside", besideLines(result));
}

await script(async () => {
  const given = parsed();
  const { json: file, quick, docs, plan, native, inBrowser } = given;
  const start = performance.now();
  await setup();
  await build();
  if (given.beside) {
    const api = await import("../pkg/index.js");
    await api.default();
    await compared(api, scenes(api, await import("../pkg/files.js")), given);
    return say(`the comparison in ${seconds(start)}`);
  }
  await buildPage();
  if (native) await must("cargo", ["bench", "--bench", "rounds", "--no-run"]);

  const api = await import("../pkg/index.js");
  await api.default();
  const made = scenes(api, await import("../pkg/files.js"));
  const server = await serve();
  const chromium = inBrowser ? await launch((await browser()).chromium) : undefined;
  const sides = [];
  try {
    if (inBrowser) sides.push(await browserSide(chromium, server.address));
    if (native) sides.push(nativeSide());
    if (sides.length === 0) throw new Failure("--browser-only and --native-only leave nothing to time.");
    const found = await loops(sides, made, plan);
    const rest = inBrowser ? await around(chromium, server.address, sides[0], made, plan) : {};
    const { surface, lightName } = made;
    const about = { surface, lightName, covered: found.covered, quick, ...machine() };
    const result = summary({ ...found, ...rest, sizes: measureSizes(), about });
    const list = aims(result);
    console.log(`\n${report(result, list).join("\n")}\n`);
    keep(file, { ...result, aims: list });
    if (docs) fill("docs/performance.md", "bench", benchLines({ ...result, aims: list }));
  } finally {
    for (const side of sides) await side.close();
    await chromium?.close();
    server.close();
  }
  say(`benches in ${seconds(start)}`);
});
