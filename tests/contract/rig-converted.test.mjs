// Calibrations in KITTI's form with other names, and matrices and transforms as converters, launch files and shells write them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readRigFile } from "../../pkg/rig.js";
import { close } from "./rig-support.mjs";

const read = (name, text) => readRigFile({ name, bytes: new TextEncoder().encode(text) });
const codes = ({ warnings }) => warnings.map(({ code }) => code);

const P = "600 0 320 0 0 600 240 0 0 0 1 0";
/** From a LiDAR's axes into a camera's, and back. */
const INTO = "0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3";
const BACK = "0 0 1 -0.3 -1 0 0 0.1 0 -1 0 0.2";
const LAST = " 0 0 0 1";

test("a LiDAR's pose beside KITTI's projections, whatever its name and its number of rows", async () => {
  for (const lines of [
    `Tr_velo_to_cam: ${INTO}`,
    `Tr_velo_to_cam: ${INTO}${LAST}`,
    `lidar2cam0: ${INTO}${LAST}`,
    `Tr_lidar_to_cam: ${INTO}`,
    `velo_to_cam: ${INTO}${LAST}`,
    `Tr_cam_to_velo: ${BACK}`,
    `T_cam_lidar: ${INTO}`,
    "R_lidar2cam: 0 -1 0 0 0 -1 1 0 0\nT_lidar2cam: 0.1 0.2 0.3",
    `extrinsic: ${INTO}`,
  ]) {
    const found = await read("calib.txt", `P0: ${P}\n${lines}\n`);
    const [{ from, to, pose }] = found.poses;
    assert.deepEqual([from, to], ["velodyne", "image_0"], lines);
    close(pose.translation, [0.1, 0.2, 0.3], 1e-9, lines);
    close(pose.rotation, [0, -1, 0, 0, 0, -1, 1, 0, 0], 1e-9, lines);
    assert.equal(codes(found).includes("pose-assumed"), lines.startsWith("extrinsic"), lines);
  }
});

test("a static transform in a list over several lines, and in a string that is split", async () => {
  const flags = [
    "'--x', '0.1', '--y', '0.2',",
    "'--z', '0.3', '--frame-id', 'lidar', '--child-frame-id', 'camera_optical'",
  ];
  for (const text of [
    `ExecuteProcess(\n  cmd=['ros2', 'run', 'tf2_ros', 'static_transform_publisher', ${flags.join("\n  ")}],\n  output='screen')\n`,
    "Node(executable='static_transform_publisher',\n  arguments='0.1 0.2 0.3 0 0 0 lidar camera_optical'.split(' '))\n",
  ]) {
    const [{ from, to, pose }] = (await read("tf.launch.py", text)).poses;
    assert.deepEqual([from, to], ["camera_optical", "lidar"]);
    assert.deepEqual(pose.translation, [0.1, 0.2, 0.3]);
  }
});

test("a print of tf2_echo whose frames are in the file's name alone is a doubt", async () => {
  const text = "At time 0.0\n- Translation: [0.1, 0.2, 0.3]\n- Rotation: in Quaternion (xyzw) [0.0, 0.0, 0.0, 1.0]\n";
  assert.ok(codes(await read("velodyne_to_camera.txt", text)).includes("pose-assumed"));
  assert.equal(codes(await read("tf.txt", text)).includes("pose-assumed"), false);
});

test("intrinsics in matrices of 4x4, and above a baseline", async () => {
  const rows = [
    [600, 0, 320, 0],
    [0, 610, 240, 0],
    [0, 0, 1, 0],
    [0, 0, 0, 1],
  ];
  for (const [name, text] of [
    ["K.json", JSON.stringify({ K: rows })],
    ["camera.json", JSON.stringify({ intrinsics: rows, width: 640, height: 480 })],
    ["info.json", JSON.stringify({ cam2img: rows })],
    ["K.txt", "600 0 320 0 610 240 0 0 1\n0.063\n"],
  ]) {
    const { cameras, poses } = await read(name, text);
    const [{ camera }] = cameras;
    assert.deepEqual([camera.fx, camera.fy, camera.cx, camera.cy], [600, 610, 320, 240], name);
    assert.deepEqual(poses ?? [], [], name);
  }
});
