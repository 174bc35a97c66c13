// Every example works: pages in a browser, programs in a shell.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { appendFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import { build } from "vite";
import { inRoot } from "../../scripts/shell.mjs";
import { decodeDepth } from "../../pkg/files.js";
import { sampleRig } from "../../pkg/index.js";
import { readRigFile } from "../../pkg/rig.js";
import { chrome, folder, pairFiles, run, served } from "./fresh.mjs";
import { LONG } from "./long.mjs";

/** Limit that ends a test that hangs, milliseconds; no test measures time. */
const NEVER = 300_000;

const data = folder();
before(async () => {
  const { colour, depth } = await pairFiles({ angles: { beta: 20 } });
  writeFileSync(join(data, "colour.png"), colour);
  writeFileSync(join(data, "depth.npy"), depth);
  writeFileSync(join(data, "bad.png"), "no picture");
});

/** Opens a new page, runs the body and closes the page; errors in the page fail the test. */
async function onPage(address, body) {
  const page = await (await chrome()).newPage();
  // Records every text of the output, since on a fast machine some are gone before the test reads them.
  await page.addInitScript(() => {
    window.said = [];
    new MutationObserver(() => window.said.push(document.getElementById("out")?.textContent ?? "")).observe(document, {
      subtree: true,
      childList: true,
      characterData: true,
    });
  });
  page.setDefaultTimeout(NEVER);
  const faults = [];
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("response", (response) => response.status() >= 400 && faults.push(`${response.status()} ${response.url()}`));
  await page.goto(address);
  await body(page);
  assert.deepEqual(faults, []);
  await page.close();
}

/** Waits until an element shows the expected text. */
const says = (page, selector, pattern) => page.locator(selector, { hasText: pattern }).waitFor();

describe("pages", () => {
  let address;
  before(async () => (address = await served(inRoot())));

  test("page.html finds the pose of two files", () =>
    onPage(`${address}examples/page.html`, async (page) => {
      await page.setInputFiles("#colour", join(data, "bad.png"));
      await page.setInputFiles("#depth", join(data, "depth.npy"));
      await says(page, "#out", /PNG/);
      await page.setInputFiles("#colour", join(data, "colour.png"));
      await says(page, "#out", /^converged .* beta (19|20)\.\d+/);
    }));

  test("worker.html draws in a worker, and stops", LONG, () =>
    onPage(`${address}examples/worker.html`, async (page) => {
      await says(page, "#out", /^converged .*beta (49|50)\.\d+ \(true: 50\)/);
      assert.ok(
        (await page.evaluate(() => window.said)).some((words) => /^running .*beta/.test(words)),
        "it says how far it is",
      );
      for (const id of ["normals", "depth"]) {
        const painted = await page.locator(`#${id}`).evaluate((canvas) => {
          const copy = Object.assign(document.createElement("canvas"), {
            width: canvas.width,
            height: canvas.height,
          }).getContext("2d");
          copy.drawImage(canvas, 0, 0);
          return copy
            .getImageData(0, 0, canvas.width, canvas.height)
            .data.filter((value, k) => k % 4 === 3 && value === 255).length;
        });
        assert.ok(painted > 1000, `${painted} pixels of ${id}`);
      }
      // The click comes before the worker has loaded, so that the run can be stopped on any machine.
      await page.addInitScript(() => addEventListener("load", () => document.getElementById("stop").click()));
      await page.reload();
      await says(page, "#out", "stopped");
    }),
  );
});

describe("react", () => {
  let address;
  before(async () => {
    const outDir = folder();
    const input = { example: inRoot("examples/react/index.html"), counted: inRoot("tests/contract/react/index.html") };
    const options = {
      root: inRoot(),
      configFile: false,
      logLevel: "error",
      build: { outDir, emptyOutDir: true, target: "es2022", rollupOptions: { input } },
    };
    await build({ ...options, worker: { format: "es" } });
    address = await served(outDir);
  });

  test("the example finds the pose", () =>
    onPage(`${address}examples/react/index.html`, (page) =>
      says(page, "[role=status]", /^converged .*beta (19|20)\./),
    ));

  test("a component that goes ends what is under way, in strict mode, and frees it", LONG, () =>
    onPage(`${address}tests/contract/react/index.html`, async (page) => {
      const counts = () => page.evaluate(() => window.counts);
      await says(page, "[role=status]", /^running/);
      await page.locator("button").click();
      await page.waitForFunction(() => window.counts.freed === window.counts.made);
      const { made, freed, ended } = await counts();
      assert.deepEqual([made, freed, ended], [1, 1, 0]);
      await page.locator("button").click();
      await says(page, "[role=status]", /^converged/);
      await page.waitForFunction(() => window.counts.freed === window.counts.made);
      assert.deepEqual(await counts(), { made: 2, freed: 2, ended: 1 });
    }),
  );
});

describe("batch.mjs", () => {
  const pairs = join(data, "pairs");
  const LARGE = ["colour/05.png", "depth/05.npy"];
  const csv = join(data, "poses.csv");
  const lines = () =>
    readFileSync(csv, "utf8")
      .trim()
      .split("\n")
      .map((line) => line.split(","));
  const named = (name) => lines().find(([first]) => first === name);

  /** Runs to the end, or interrupts the program once `stop` holds. */
  function batch(args, stop) {
    const child = spawn(process.execPath, [inRoot("examples/batch.mjs"), ...args]);
    const output = { stdout: "", stderr: "" };
    for (const stream of ["stdout", "stderr"]) {
      child[stream].on("data", (chunk) => {
        output[stream] += chunk;
        if (!stop?.(output)) return;
        stop = undefined;
        child.kill("SIGINT");
      });
    }
    return new Promise((done) => child.on("close", (code) => done({ code, ...output })));
  }

  before(async () => {
    mkdirSync(join(pairs, "colour"), { recursive: true });
    mkdirSync(join(pairs, "depth"), { recursive: true });
    const add = async ([first, second], request) => {
      const { colour, depth } = await pairFiles(request);
      writeFileSync(join(pairs, first), colour);
      writeFileSync(join(pairs, second), depth);
    };
    // Two naming schemes.
    for (const beta of [0, 10]) await add([`colour/${beta}.png`, `depth/${beta}.npy`], { angles: { beta }, size: 64 });
    for (const beta of [20, 30])
      await add([`view ${beta}-rgb.png`, `view ${beta}-depth.npy`], { angles: { beta }, size: 64 });
    // This pair comes after the first one and takes far longer than an interruption.
    await add(LARGE, { size: 512 });
    writeFileSync(join(pairs, 'bad, "cut"-colour.png'), "no picture");
    writeFileSync(join(pairs, 'bad, "cut"-depth.npy'), "no array");
    writeFileSync(join(pairs, "alone-depth.npy"), "no partner");
  });

  test("says how it is used, and what is wrong with its arguments", async () => {
    const help = await batch(["--help"]);
    assert.equal(help.code, 0);
    assert.match(help.stdout, /^Usage: .*\n[^]*Exit code: 0 /);
    const wrong = [
      [[], /one folder is needed/],
      [[pairs], /--csv OUT\.csv is needed/],
      [[pairs, "--csv", csv, "--threads", "0"], /--threads needs a whole number/],
      [[pairs, "--csv", csv, "--settings", join(pairs, "alone-depth.npy")], /alone-depth\.npy: /],
      [[pairs, "--csv", csv, "--nonsense"], /nonsense/],
      [[join(pairs, "alone-depth.npy"), "--csv", csv], /is not a folder/],
      [[inRoot("docs"), "--csv", csv], /contains no pair/],
      [[pairs, "--csv", join(pairs, "alone-depth.npy")], /not a table of this program/],
    ];
    for (const [args, message] of wrong) {
      const { code, stderr } = await batch(args);
      assert.deepEqual([code, message.test(stderr)], [3, true], stderr);
    }
    assert.ok(!existsSync(csv));
  });

  test("broken off it goes on where it was; a bad pair has its line and ends nothing", LONG, async () => {
    const first = await batch([pairs, "--csv", csv, "--threads", "1"], ({ stderr }) => /: converged/.test(stderr));
    assert.equal(first.code, 130, first.stderr);
    assert.match(first.stderr, /interrupted/);
    const before = lines();
    assert.deepEqual(
      before.map(([name]) => name),
      ["name", '"bad', "0"],
    );
    for (const file of LARGE) rmSync(join(pairs, file));
    // The file looks as if it had been cut off within a line.
    appendFileSync(csv, "10,conv");

    const second = await batch([pairs, "--csv", csv]);
    assert.equal(second.code, 1, second.stderr);
    assert.match(second.stdout, /^5 pairs in .*, 1 of them failed\n$/);
    assert.match(second.stderr, /100 %/);
    const all = lines();
    assert.deepEqual(all.slice(0, before.length), before);
    assert.equal(all.length, 6);
    assert.equal(new Set(all.map(([name]) => name)).size, 6);
    for (const beta of [0, 10, 20, 30]) {
      const row = named(beta < 15 ? String(beta) : `view ${beta}`);
      assert.equal(row[1], "converged");
      assert.ok(Math.abs(row[4] - beta) < 2, row.join());
    }
    assert.match(readFileSync(csv, "utf8"), /^"bad, ""cut""",error,.*it is neither/m);

    // All pairs have results, so nothing runs.
    const third = await batch([pairs, "--csv", csv]);
    assert.deepEqual([third.code, lines()], [1, all]);
  });

  test("a name that a spreadsheet would run is a word in its table, and known again", async () => {
    const [folder, table] = [join(data, "formulas"), join(data, "formulas.csv")];
    mkdirSync(folder);
    for (const name of ["=1+1-colour.png", "=1+1-depth.npy"]) writeFileSync(join(folder, name), "no picture");
    for (let time = 0; time < 2; time++) {
      assert.equal((await batch([folder, "--csv", table])).code, 1);
      assert.deepEqual(
        readFileSync(table, "utf8")
          .trim()
          .split("\n")
          .slice(1)
          .map((line) => line.split(",")[0]),
        ["'=1+1"],
      );
    }
  });

  // This test continues with the results of the test of an interruption.
  test("what failed can be tried again, with settings for all pairs", LONG, async () => {
    const settings = join(data, "settings.json");
    writeFileSync(settings, JSON.stringify({ options: { maxIterations: -1 } }));
    const refused = await batch([pairs, "--csv", csv, "--retry", "--settings", settings]);
    assert.equal(refused.code, 1);
    assert.equal(lines().length, 6);

    const other = join(data, "settled.csv");
    writeFileSync(settings, JSON.stringify({ options: { start: "identity", maxIterations: 1 } }));
    assert.equal((await batch([pairs, "--csv", other, "--settings", settings])).code, 1);
    assert.match(readFileSync(other, "utf8"), /^10,max-iterations,/m);
  });
});

test("sample.mjs writes a pair and a rig that the commands read", async () => {
  const samples = join(data, "samples");
  run(process.execPath, [inRoot("examples/sample.mjs"), samples], inRoot());
  const { poses, cameras } = await readRigFile({
    name: "calibration.yaml",
    bytes: readFileSync(join(samples, "rig/calibration.yaml")),
  });
  const { pose } = await sampleRig({ kind: "boxes", seed: 2 });
  assert.deepEqual([poses.length, cameras.length], [1, 2]);
  const [read, written] = [poses[0].pose, pose].map(({ matrix }) => matrix.flat());
  assert.ok(read.every((value, k) => Math.abs(value - written[k]) < 1e-12));
  assert.equal(readdirSync(join(samples, "rig/frames")).length, 6);
  const { data: depths } = decodeDepth(readFileSync(join(samples, "pair/depth.npy")));
  assert.ok(depths.some(Number.isFinite));
  assert.throws(() => run(process.execPath, [inRoot("examples/sample.mjs")], inRoot()), /Usage/);
});

describe("Rust", () => {
  test("pair.rs", () =>
    assert.match(
      run("cargo", ["run", "--quiet", "--all-features", "--example", "pair"], inRoot()),
      /^converged after/,
    ));

  test("files.rs reads files, and writes the refined depth", () => {
    const files = (...args) =>
      run("cargo", ["run", "--quiet", "--all-features", "--example", "files", "--", ...args], inRoot());
    const refined = join(data, "refined.npy");
    assert.match(
      files(join(data, "colour.png"), join(data, "depth.npy"), refined),
      /^converged after \d+ iterations\ns .*beta (19|20)\.\d+/,
    );
    const [before, { width, height, data: after }] = [
      decodeDepth(readFileSync(join(data, "depth.npy"))),
      decodeDepth(readFileSync(refined)),
    ];
    assert.deepEqual([width, height], [before.width, before.height]);
    const apart = before.data
      .map((value, k) => Math.abs(value - after[k]))
      .filter(Number.isFinite)
      .sort();
    assert.ok(
      apart.length > 1000 && apart[apart.length >> 1] < 0.5,
      `${apart.length} pixels, ${apart[apart.length >> 1]}`,
    );
    assert.throws(() => files(join(data, "depth.npy"), join(data, "depth.npy")), /depth\.npy: /);
  });
});
