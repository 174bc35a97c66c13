// `check` on three command lines: npm's, Rust's and Python's. They share one manual, verdict, JSON and text.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, before, describe, test } from "node:test";
import init, { sampleRig } from "../../pkg/index.js";
import { writePose } from "../../pkg/rig-write.js";
import { writePng } from "../../pkg/write.js";
import { ask, inRoot } from "../../scripts/shell.mjs";
import { freshProject } from "./fresh.mjs";
import { LONG } from "./long.mjs";

/**
 * Native code and wasm sum in different orders and compute other sines. Limits of the differences between their reports. That of the
 * estimate is in units of its sigma. Those of other numbers and of the likelihood's curves are relative to the largest number in the same
 * list.
 */
const ROUNDING = { sigmas: 1e-4, relative: 1e-4, curves: 0.01 };
/** On some rendered rigs, rounding decides whether a point counts, and the estimate moves by up to a hundredth of a sigma. */
const DECISIONS = { sigmas: 0.05, relative: 0.02, curves: 0.2 };
/** Rounding error of numbers that should be zero. */
const ZERO = 1e-9;

const STILL = [
  [1, 0, 0, 0],
  [0, 1, 0, 0],
  [0, 0, 1, 0],
  [0, 0, 0, 1],
];
const NYU = inRoot("../shared/data/nyu_raw_pair");
const PYTHON = inRoot("target/python/venv/bin/python");
const hasPython = existsSync(PYTHON) && ask(PYTHON, ["-c", "import bimodal_stereo._native"]) !== undefined;
const folder = mkdtempSync(join(tmpdir(), "check-commands-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const COMMANDS = {
  npm: { skip: false },
  rust: { skip: false },
  python: { skip: hasPython ? false : "needs the Python package in target/python (npm test -- python)" },
};

function run(name, args) {
  const { program, before: first = [], cwd = folder } = COMMANDS[name];
  const { status, stdout, stderr } = spawnSync(program, [...first, ...args], { cwd, encoding: "utf8" });
  return { status, stdout, stderr };
}

/** A rendered rig as files of this project: two frames, the cameras of both, and its extrinsics. */
async function rendered() {
  await init();
  const at = join(folder, "rig");
  mkdirSync(at);
  let truth;
  for (const frame of [0, 1]) {
    const { image, depth, pose } = await sampleRig({ kind: "objects", seed: 3, frame });
    const { width, height, data } = image;
    writeFileSync(join(at, `color_${frame}.png`), await writePng({ width, height, channels: 4, data }));
    const stored = { width: depth.width, height: depth.height, channels: 1, data: depth.data };
    writeFileSync(join(at, `depth_${frame}.png`), await writePng(stored));
    truth = { image, depth, pose };
  }
  const camera = ({ fx, fy, cx, cy, distortion }, { width, height }) => ({
    ...{ fx, fy, cx, cy, distortion, width, height },
  });
  const { image, depth, pose } = truth;
  writeFileSync(
    join(at, "cameras.json"),
    JSON.stringify({ color: camera(image.camera, image), depth: camera(depth.camera, depth) }),
  );
  writeFileSync(join(folder, "extrinsics.txt"), writePose(pose, "matrix").text);
  return { frames: at, calibration: join(folder, "extrinsics.txt") };
}

const isNumber = (value) => typeof value === "number";
const size = (values) => Math.max(...values.map(Math.abs));

/** The tolerance for members of the estimate: for its rotation in rad or degrees, for its translation in metres. */
function toleranceOf(path, covariance, sigmas) {
  const sigma = (k) => sigmas * Math.sqrt(covariance[7 * k]);
  const [turn, shift] = [Math.max(sigma(0), sigma(1), sigma(2)), Math.max(sigma(3), sigma(4), sigma(5))];
  const [, member] = /\.estimate\.(\w+)/.exec(path) ?? [];
  return { rotation: turn, matrix: turn + shift, angles: (180 / Math.PI) * turn, translation: shift }[member] ?? 0;
}

/** A sentence without its numbers, and a table without its column widths. */
const withoutNumbers = (text) => text.replace(/\d+(?:\.\d+)?(?:e[-+]?\d+)?/g, "#").replace(/ {2,}/g, "  ");
/** The output without progress lines, which are printed at different moments. */
const remarks = (text) => text.split("\n").filter((line) => !/^ *\d+ % /.test(line));

/** Checks that two reports have equal structure and words, and nearly equal numbers. */
function alike(one, other, path, covariance, near) {
  const [ours, theirs] = isNumber(one) ? [[one], [other]] : [one, other];
  if (Array.isArray(ours) && ours.length > 0 && ours.every(isNumber)) {
    assert.equal(theirs.length, ours.length, path);
    const off = size(ours.map((value, index) => value - theirs[index]));
    const share = path.includes(".sensitivity.") ? near.curves : path.includes(".estimate.") ? 0 : near.relative;
    const tolerance = Math.max(share * size(ours), toleranceOf(path, covariance, near.sigmas));
    assert.ok(off <= tolerance + ZERO, `${path}: ${ours} and ${theirs}`);
  } else if (typeof one === "object" && one !== null && typeof other === "object" && other !== null) {
    assert.deepEqual(Object.keys(other).sort(), Object.keys(one).sort(), path);
    for (const key of Object.keys(one)) alike(one[key], other[key], `${path}.${key}`, covariance, near);
  } else if (path.endsWith(".reason")) assert.equal(withoutNumbers(other), withoutNumbers(one), path);
  else assert.equal(other, one, path);
}

/** Runs all commands on the same files, one after the other, and compares the others' output with npm's. */
function checkAll(frames, calibration, near, more = []) {
  const [first, ...others] = Object.keys(COMMANDS).filter((name) => !COMMANDS[name].skip);
  const outcome = (name) => {
    const [json, page] = [join(folder, `${name}.json`), join(folder, `${name}.html`)];
    const found = run(name, ["check", frames, "--calibration", calibration, "--json", json, "--report", page, ...more]);
    assert.ok(found.status < 3, `${name}: ${found.stderr}`);
    const report = JSON.parse(readFileSync(json, "utf8"));
    const html = readFileSync(page, "utf8");
    for (const words of [`Check of ${basename(calibration)}`, "Content-Security-Policy", report.inputs[0].sha256])
      assert.ok(html.includes(words), `${name}: ${words}`);
    // The numbers are compared in the JSON.
    return { ...found, words: withoutNumbers(found.stdout), report };
  };
  const theirs = outcome(first);
  for (const name of others) {
    const ours = outcome(name);
    assert.equal(ours.status, theirs.status, name);
    alike(theirs.report, ours.report, name, theirs.report.covariance, near);
    assert.equal(ours.words, theirs.words, name);
    assert.deepEqual(remarks(ours.stderr), remarks(theirs.stderr), name);
  }
  return theirs;
}

describe("check by npm, Rust and Python", LONG, () => {
  before(() => {
    const project = freshProject();
    COMMANDS.npm = { ...COMMANDS.npm, program: "npx", before: ["--no-install", "bimodal-stereo"], cwd: project };
    // With all features and an example, as in cli.test.mjs.
    const { status } = spawnSync(
      "cargo",
      ["build", "--quiet", "--all-features", "--bin", "bimodal-stereo", "--example", "pair"],
      {
        cwd: inRoot(),
        stdio: "inherit",
      },
    );
    assert.equal(status, 0);
    COMMANDS.rust = { ...COMMANDS.rust, program: inRoot("target/debug/bimodal-stereo") };
    COMMANDS.python = { ...COMMANDS.python, program: PYTHON, before: ["-m", "bimodal_stereo"] };
  });

  for (const [name, { skip }] of Object.entries(COMMANDS)) {
    test(`${name}: the manual and the version`, { skip }, () => {
      const manual = readFileSync(inRoot("files/src/command/help.txt"), "utf8");
      const { version } = JSON.parse(readFileSync(inRoot("pkg/package.json"), "utf8"));
      assert.deepEqual(run(name, ["check", "--help"]), { status: 0, stdout: manual, stderr: "" });
      assert.ok(run(name, ["check", "--version"]).stdout.trim().endsWith(version));
      assert.match(run(name, ["--help"]).stdout, /check/);
    });

    test(`${name}: what is wrong is 3, with a reason`, { skip }, () => {
      writeFileSync(join(folder, "empty.json"), "{}");
      const good = join(folder, "good.txt");
      writeFileSync(good, "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
      const carried = join(folder, "carried.json");
      writeFileSync(carried, JSON.stringify({ from: "camera", to: "base_link", matrix: STILL }));
      const wrong = {
        "relates camera to base_link": [folder, "--calibration", carried],
        calibration: [folder],
        "holds neither a camera": [folder, "--calibration", join(folder, "empty.json")],
        "nowhere.json": [folder, "--calibration", "nowhere.json"],
        nowhere: ["nowhere", "--calibration", good],
        jsn: [folder, "--calibration", good, "--jsn"],
        unit: [folder, "--calibration", good, "--unit", "0"],
        workers: [folder, "--calibration", good, "--workers", "many"],
      };
      for (const [words, args] of Object.entries(wrong)) {
        const { status, stdout, stderr } = run(name, ["check", ...args]);
        assert.deepEqual([status, stdout], [3, ""], `${words}: ${stderr}`);
        assert.ok(stderr.includes(words), `${words}: ${stderr}`);
      }
    });
  }

  test("a rendered rig has one verdict and one JSON", async () => {
    const { frames, calibration } = await rendered();
    const { status, report } = checkAll(frames, calibration, DECISIONS, ["--unit", "0.001"]);
    assert.deepEqual([status, report.verdict, report.warnings], [0, "consistent", []]);
    assert.deepEqual(
      report.inputs.map(({ name }) => basename(name)),
      [...["extrinsics.txt", "color_0.png", "depth_0.png", "color_1.png", "depth_1.png", "cameras.json"]],
    );
  });

  test("of frames in a chain, the pose between the sensors is checked", async () => {
    const truth = readFileSync(join(folder, "extrinsics.txt"), "utf8").trim().split("\n");
    const rows = truth.map((line) => line.trim().split(/\s+/).map(Number));
    const links = [
      { from: "depth_optical", to: "mount", matrix: rows },
      { from: "rgb_optical", to: "mount", matrix: STILL },
      { from: "mount", to: "base", matrix: STILL },
    ];
    const chain = join(folder, "chain.json");
    writeFileSync(chain, JSON.stringify(links));
    const json = join(folder, "chained.json");
    run("npm", ["check", join(folder, "rig"), "--calibration", chain, "--json", json, "--unit", "0.001"]);
    const { verdict, candidates } = JSON.parse(readFileSync(json, "utf8"));
    assert.deepEqual([verdict, Object.keys(candidates)], ["consistent", ["chain.json"]]);
  });

  test("a raw Kinect has one verdict and one JSON", { skip: existsSync(NYU) ? false : "needs ../shared/data" }, () => {
    const { status, report } = checkAll(NYU, join(NYU, "calib.json"), ROUNDING);
    // No file states the unit of its depths.
    assert.deepEqual([status, report.verdict], [2, "undecided"]);
    assert.deepEqual(
      report.warnings.map(({ code }) => code),
      ["unit-guessed"],
    );
    assert.equal(report.candidates["calib.json"].verdict, "consistent");
  });
});
