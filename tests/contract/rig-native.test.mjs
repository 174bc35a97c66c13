// The calibration readers in Rust (files/) and in JavaScript (js/rig) return the same result and the same codes for each file.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join, relative } from "node:path";
import { before, describe, test } from "node:test";
import { readRigFile } from "../../pkg/rig.js";
import { inRoot } from "../../scripts/shell.mjs";
import { LONG } from "./long.mjs";

/** Limit of the difference between rotations that are made orthonormal with another order of sums. */
const NEAR = 1e-9;
const TEXT = /\.(?:json|ya?ml|xml|txt|conf|ini|toml|launch|camera|csv|sh|py|log|freiburg|intrinsics?|log)$|\/[^./]+$/i;

function filesBelow(folder) {
  if (!existsSync(folder)) return [];
  const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
  return files.map((entry) => join(entry.parentPath ?? entry.path, entry.name)).filter((path) => TEXT.test(path));
}

/** read.json contains what other programs read from the fixtures and is not a file of a rig. */
const FIXTURES = filesBelow(inRoot("tests/fixtures/rig")).filter((path) => !path.endsWith("read.json"));

/** The reading in the form that the Rust example prints. */
async function byJavaScript(path) {
  const bytes = new Uint8Array(readFileSync(path));
  const found = await readRigFile({ name: path, bytes }).catch((error) => ({ error }));
  if (found.error) return { error: found.error.message };
  const cameras = (found.cameras ?? []).map(({ name = null, camera, width, height }) => {
    const { fx, fy, cx, cy, model = "brown", distortion } = camera;
    const padded = distortion && (model === "fisheye" ? distortion : [...distortion, 0, 0, 0, 0].slice(0, 8));
    const lens = padded === undefined ? null : { model, distortion: padded };
    return { name, size: width === undefined ? null : [width, height], numbers: [fx, fy, cx, cy], lens };
  });
  const poses = (found.poses ?? []).map(({ name = null, from = null, to = null, pose }) => ({
    names: [name, from, to],
    ...{ rotation: pose.rotation, translation: pose.translation },
  }));
  const warnings = found.warnings.map(({ code, message }) => ({ code, message }));
  return { cameras, poses, says: found.says, warnings };
}

function same(one, other, path) {
  if (typeof one === "number" && typeof other === "number") {
    assert.ok(Math.abs(one - other) <= NEAR * Math.max(1, Math.abs(one)), `${path}: ${one} ${other}`);
  } else if (typeof one === "object" && one !== null && typeof other === "object" && other !== null) {
    assert.deepEqual(Object.keys(one).sort(), Object.keys(other).sort(), path);
    for (const key of Object.keys(one)) same(one[key], other[key], `${path}.${key}`);
  } else assert.equal(one, other, path);
}

describe("readers in Rust and in JavaScript", LONG, () => {
  before(() => {
    // With a binary and an example of the library, as in cli.test.mjs.
    const built = spawnSync(
      "cargo",
      [
        "build",
        "--quiet",
        "--all-features",
        "--bin",
        "bimodal-stereo",
        "--example",
        "pair",
        "--example",
        "calibration",
      ],
      { cwd: inRoot(), stdio: "inherit" },
    );
    assert.equal(built.status, 0);
  });

  // Rust reads only some of the products' own files that JavaScript reads (docs/check.md).
  for (const [name, paths] of Object.entries({ "the fixtures": FIXTURES })) {
    test(name, async () => {
      const program = inRoot("target/debug/examples/calibration");
      const { stdout, status } = spawnSync(program, paths, { encoding: "utf8", maxBuffer: 2 ** 28 });
      assert.equal(status, 0);
      const ours = stdout
        .trimEnd()
        .split("\n")
        .map((line) => JSON.parse(line));
      assert.equal(ours.length, paths.length);
      const wrong = [];
      for (const [index, path] of paths.entries()) {
        const theirs = await byJavaScript(path);
        try {
          // Parsers describe damage differently, but both must refuse the same files.
          if (theirs.error !== undefined || ours[index].error !== undefined)
            assert.equal(
              theirs.error === undefined,
              ours[index].error === undefined,
              `${theirs.error} | ${ours[index].error}`,
            );
          else same(theirs, ours[index], "");
        } catch (error) {
          wrong.push(`${relative(inRoot(), path)}: ${error.message}`);
        }
      }
      assert.deepEqual(wrong, []);
    });
  }
});
