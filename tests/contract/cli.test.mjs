// The command line and the package give the same answer for the same files. Codes and broken files are tested in cli/tests.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import jpeg from "jpeg-js";
import init, { Estimator, sample } from "../../pkg/index.js";
import { decodeColour, decodeDepth } from "../../pkg/files.js";
import { readRigFile } from "../../pkg/rig.js";
import { lightCsv, writeNpy, writePng } from "../../pkg/write.js";
import { inRoot } from "../../scripts/shell.mjs";
import { LONG } from "./long.mjs";

/** Native code and wasm sum in different orders: limits of the differences, in degrees and as a share. */
const DEGREES = 1e-3;
const SHARE = 1e-4;
/** Two JPEG decoders differ by one or two steps of 8 bits where chroma was subsampled; limit in degrees. */
const JPEG_DEGREES = 0.2;

const SIZE = 48;
let folder;
const at = (name) => join(folder, name);
const file = (name) => new Uint8Array(readFileSync(at(name)));

function cli(...args) {
  const { status, stdout, stderr } = spawnSync(inRoot("target/debug/bimodal-stereo"), [...args, "--json"], {
    encoding: "utf8",
    cwd: folder,
  });
  assert.equal(stderr, "");
  return { code: status, ...JSON.parse(stdout) };
}

/** Levels of 16 bits, or of 8 bits in sRGB. */
function levels({ width, height, data }, most) {
  const brightest = data.reduce((a, b) => Math.max(a, b), 0) * 1.05;
  const encoded = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  const level = (value) => Math.round(most * (most === 255 ? encoded(value / brightest) : value / brightest));
  return { width, height, channels: 3, data: (most === 255 ? Uint8Array : Uint16Array).from(data, level) };
}

async function answer(image, depth, options) {
  const estimator = new Estimator(image, depth, options);
  const report = await estimator.run();
  const light = [...estimator.light()];
  estimator.free();
  return { ...report, light };
}

function alike(told, report, degrees) {
  assert.deepEqual(
    [told.status, told.iteration, told.message, told.reason?.code],
    [report.status, report.iteration, report.message, report.reason?.code],
  );
  const trace = told.pose.rotation.reduce((sum, value, k) => sum + value * report.pose.rotation[k], 0);
  const off = (Math.acos(Math.min(1, (trace - 1) / 2)) * 180) / Math.PI;
  assert.ok(off < degrees, `${off} degrees`);
  const share = (SHARE * degrees) / DEGREES;
  assert.ok(Math.abs(told.pose.scale / report.pose.scale - 1) < share, "scale");
  const size = Math.hypot(...report.pose.translation, told.unit === "px" ? SIZE : 0);
  told.pose.translation.forEach((value, k) =>
    assert.ok(Math.abs(value - report.pose.translation[k]) < share * size, `translation ${k}`),
  );
}

describe("command line", LONG, () => {
  before(async () => {
    await init();
    // Built with all features and an example, as the Rust tests are. Cargo keeps one build of the library, and the examples of the
    // documentation would otherwise be linked with one of other features.
    const { status } = spawnSync(
      "cargo",
      ["build", "--quiet", "--all-features", "--bin", "bimodal-stereo", "--example", "pair"],
      {
        cwd: inRoot(),
        stdio: "inherit",
      },
    );
    assert.equal(status, 0);
    folder = mkdtempSync(join(tmpdir(), "bimodal-cli-"));
  });
  after(() => rmSync(folder, { recursive: true, force: true }));

  test("a 16-bit PNG and a .npy in pixels, the light known", async () => {
    const { image, depth, light } = sample({ surface: "bust", light: "colourful", size: SIZE });
    writeFileSync(at("image.png"), await writePng(levels(image, 65_535)));
    writeFileSync(at("depth.npy"), writeNpy({ width: SIZE, height: SIZE, channels: 1, data: depth.data }));
    writeFileSync(at("light.csv"), lightCsv(light));
    const told = cli("image.png", "depth.npy", "--light", "light.csv", "--start", "identity", "--scale", "1");
    const options = { light, start: "identity", scale: 1 };
    alike(told, await answer(decodeColour(file("image.png")), decodeDepth(file("depth.npy")), options), DEGREES);
    assert.equal(told.code, 0);
    assert.deepEqual(told.light, [...light]);
  });

  test("8-bit sRGB and millimetres, nothing known", async () => {
    const { image, depth } = sample({ surface: "bust", light: "window", size: SIZE });
    writeFileSync(at("photo.png"), await writePng(levels(image, 255)));
    // At two metres, a pixel of this camera measures 4 mm.
    const camera = { fx: 500, fy: 500, cx: 23.5, cy: 23.5 };
    const stored = Uint16Array.from(depth.data, (value) => (Number.isFinite(value) ? Math.round(2000 + 4 * value) : 0));
    writeFileSync(at("depth.png"), await writePng({ width: SIZE, height: SIZE, channels: 1, data: stored }));
    const told = cli("photo.png", "depth.png", "--depth-camera", Object.values(camera).join(), "--max-iterations", "8");
    const read = async (name, as) => readRigFile({ name, bytes: file(name) }, { as });
    const [colour, map] = [await read("photo.png", "colour"), await read("depth.png", "depth")];
    alike(told, await answer(colour.image, { ...map.depth, camera }, { maxIterations: 8 }), DEGREES);
    assert.match(told.notes.join(), /millimetres \(guessed/);
  });

  test("a JPEG is decoded by others, and nearly the same", async () => {
    const { image, light } = sample({ surface: "bust", light: "colourful", size: SIZE });
    const { width, height, data } = levels(image, 255);
    const rgba = Uint8Array.from({ length: 4 * width * height }, (_, i) =>
      i % 4 === 3 ? 255 : data[3 * (i >> 2) + (i % 4)],
    );
    writeFileSync(at("image.jpg"), jpeg.encode({ width, height, data: rgba }, 95).data);
    const told = cli(
      "image.jpg",
      "depth.npy",
      "--light",
      "light.csv",
      "--start",
      "identity",
      "--scale",
      "1",
      "--max-iterations",
      "4",
    );
    const colour = await readRigFile({ name: "image.jpg", bytes: file("image.jpg") }, { as: "colour" });
    const options = { light, start: "identity", scale: 1, maxIterations: 4 };
    const report = await answer(colour.image, decodeDepth(file("depth.npy")), options);
    assert.ok(
      Math.abs(told.pose.angles.beta - report.pose.angles.beta) < JPEG_DEGREES,
      `${told.pose.angles.beta} ${report.pose.angles.beta}`,
    );
  });
});
