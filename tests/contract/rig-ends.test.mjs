// The frames that the files of a rig and their names state for a pose, and lenses in separate files.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readRigFile, readRigFolder } from "../../pkg/rig.js";
import { isBackwards } from "../../pkg/rig-words.js";

const file = (name, text) => ({ name, bytes: new TextEncoder().encode(text) });
const IDENTITY = "1 0 0 0.1\n0 1 0 0.2\n0 0 1 0.3\n0 0 0 1\n";

test("a pose that leads to a LiDAR or from colour to depth is backwards", () => {
  for (const [from, to] of [
    ["camera", "lidar"],
    ["front_6mm", "velodyne128"],
    ["color", "depth"],
  ]) {
    assert.equal(isBackwards({ from, to }), true, `${from} to ${to}`);
    assert.equal(isBackwards({ from: to, to: from }), false, `${to} to ${from}`);
  }
  assert.equal(isBackwards({}), false);
});

test("poses of targets name them, and those of objects are places in the world", async () => {
  const { poses } = await readRigFile(file("tag_to_cam.txt", IDENTITY));
  assert.deepEqual([poses[0].from, poses[0].to], ["tag", "cam"]);
  const placed = await readRigFile(file("object_pose.txt", IDENTITY));
  assert.equal(placed.poses[0].to, "world");
});

test("MVSNet's cameras are read with their intrinsics, and their extrinsics as poses of the world", async () => {
  const text = `extrinsic\n${IDENTITY}\nintrinsic\n600 0 320\n0 610 240\n0 0 1\n\n425.0 2.5 192 933.8\n`;
  const { cameras, poses } = await readRigFile(file("00000000_cam.txt", text));
  assert.deepEqual([cameras[0].camera.fx, cameras[0].camera.fy], [600, 610]);
  assert.ok([poses[0].from, poses[0].to].includes("world"));
});

test("tf2_echo names its frames while it waits for them", async () => {
  const text =
    "[INFO] [1.0] [tf2_echo]: Waiting for transform lidar ->  camera: frame does not exist\nAt time 0.0\n- Translation: [0.1, 0.2, 0.3]\n- Rotation: in Quaternion (xyzw) [0.0, 0.0, 0.0, 1.0]\n";
  const { poses } = await readRigFile(file("tf.txt", text));
  assert.deepEqual([poses[0].from, poses[0].to], ["camera", "lidar"]);
});

test("a lens in a separate file is a doubt", async () => {
  const files = [
    file("color_K.txt", "600 0 320\n0 600 240\n0 0 1\n"),
    file("color_dist.txt", "0.1 -0.2 0.001 0 0.05\n"),
  ];
  const { warnings } = await readRigFolder(files);
  assert.ok(warnings.some(({ code, file: name }) => code === "distortion-unused" && name === "color_dist.txt"));
});
