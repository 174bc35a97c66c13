// Units of translations: stated in comments, or not at all, where a length that is long for a rig has a warning.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { readRigFile } from "../../pkg/rig.js";
import { close, codes, only, read, rotation } from "./rig-support.mjs";
import { npy } from "./support.mjs";

const yaml = (comment, t) => `${comment}\nR: [${rotation}]\nt: [${t}]\n`;
const shift = (reading) => only(reading.poses).pose.translation;

describe("units in comments", () => {
  const units = {
    "# translation in centimeters": 0.01,
    "# units: cm": 0.01,
    "# t in dm": 0.1,
    "# translation in mm": 0.001,
    "# all lengths are in metres": 1,
  };
  for (const [comment, unit] of Object.entries(units))
    test(comment, async () => {
      const reading = await read("rig.yaml", yaml(comment, [1.5, 0.04, -0.2]));
      close(shift(reading), [1.5 * unit, 0.04 * unit, -0.2 * unit], 1e-12);
      assert.deepEqual(codes(reading), []);
    });

  test("of other lengths, and of two units, are not used", async () => {
    for (const comment of [
      "# board: squares in cm",
      "# focal length in mm",
      "# depth unit is mm",
      "# t in cm\n# units: mm",
    ])
      close(shift(await read("rig.yaml", yaml(comment, [0.015, 0, 0]))), [0.015, 0, 0], 1e-12);
  });

  test("beside a matrix of numbers alone", async () => {
    const lines = [0, 3, 6].map((at) => [...rotation.slice(at, at + 3), at === 0 ? 1.5 : 0].join(" "));
    close(shift(await read("m.txt", `# translation in cm\n${lines.join("\n")}\n0 0 0 1\n`)), [0.015, 0, 0], 1e-12);
  });
});

describe("a long translation without a unit", () => {
  const said = async (name, t) => {
    const { poses, warnings } = await read("rig.json", JSON.stringify({ [`R_${name}`]: rotation, [`t_${name}`]: t }));
    return warnings.filter(({ code }) => code === "translation-unit-guessed").map((each) => [each, only(poses)]);
  };

  test("is a doubt between cameras from a metre, with the length in mm and cm", async () => {
    const [[doubt, pose]] = await said("left_to_right", [-5.2, 0.04, -0.21]);
    assert.ok(doubt.isDoubt);
    assert.match(doubt.message, /5\.2 mm.*52 mm/);
    close(pose.pose.translation, [-5.2, 0.04, -0.21], 0);
    assert.deepEqual(await said("left_to_right", [-0.9, 0, 0]), []);
  });

  test("is a doubt between a LiDAR and a camera from three metres, and none in a vehicle", async () => {
    assert.deepEqual(await said("lidar_to_camera", [0.5, 0.4, 2]), []);
    assert.equal((await said("lidar_to_camera", [0.5, 0.4, 3])).length, 1);
    assert.deepEqual(await said("camera_to_base", [2, 0, 1.5]), []);
  });

  test("is none where the file states metres", async () => {
    const reading = await read("rig.json", JSON.stringify({ unit: "m", R: rotation, t: [2, 0, 0] }));
    assert.deepEqual(codes(reading), []);
  });
});

test("depths of a thousand metres and more are written in full", async () => {
  const data = Float32Array.from({ length: 64 }, (_, i) => 1389.6 + (5300 * i) / 63);
  const { says } = await readRigFile(
    { name: "far.npy", bytes: npy({ descr: "<f4", shape: [8, 8], data }) },
    { as: "depth", unit: 1 },
  );
  assert.match(says, /, 1390 to 6690 m/);
  assert.doesNotMatch(says, /e\+/);
});
