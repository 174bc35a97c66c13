// Calibrations in KITTI's form with other names, and matrices and transforms as converters, launch files and shells write them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readRigFile } from "../../pkg/rig.js";
import { close } from "./rig-support.mjs";
import { npy } from "./support.mjs";

const read = (name, text) => readRigFile({ name, bytes: new TextEncoder().encode(text) });
const codes = ({ warnings }) => warnings.map(({ code }) => code);

const P = "600 0 320 0 0 600 240 0 0 0 1 0";
/** The rotation from a LiDAR's axes to a camera's, and the reverse one. */
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

test("the camera parameters that Orbbec's SDK prints without a space before fy", async () => {
  const text =
    "<OBCameraParam depth_intrinsic < fx=504.61fy = 504.72 cx =332.43 cy=331.91 width=640 height=576 >\n depth_distortion < k1=0 k2=0 k3=0 k4=0 k5=0 k6=0 p1=0 p2=0 >\n rgb_intrinsic < fx=1124.38fy = 1123.93 cx =951.31 cy=543.694 width=1920 height=1080 >\n rgb_distortion < k1=0.0760687 k2=-0.104411 k3=0.0431 k4=0 k5=0 k6=0 p1=0.000157119 p2=-1.39212e-05 >\n";
  const { cameras } = await read("camera_param.txt", text);
  assert.deepEqual(
    cameras.map(({ camera: { fx, fy } }) => [fx, fy]),
    [
      [504.61, 504.72],
      [1124.38, 1123.93],
    ],
  );
  assert.deepEqual(cameras[1].camera.distortion, [0.0760687, -0.104411, 0.000157119, -1.39212e-5, 0.0431]);
});

test("of Kalibr's cameras, one of another model is left out", async () => {
  const camera = (model, intrinsics) =>
    `  camera_model: ${model}\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: radtan\n  intrinsics: [${intrinsics}]\n  resolution: [640, 480]\n`;
  const found = await read(
    "camchain.yaml",
    `cam0:\n${camera("omni", "1.5, 600, 600, 320, 240")}cam1:\n${camera("pinhole", "600, 610, 320, 240")}`,
  );
  assert.deepEqual(
    found.cameras.map(({ name }) => name),
    ["cam1"],
  );
  assert.match(found.warnings.map(({ message }) => message).join(" "), /omni/);
});

test("lists of points with CloudCompare's heading and count, and as rows of coordinates", async () => {
  const points = Array.from({ length: 4000 }, (_, at) => [
    5 + Math.sin(at),
    4 * Math.cos(3 * at),
    Math.sin(7 * at),
    at % 255,
  ]);
  const lines = points.map((point) => point.join(" ")).join("\n");
  for (const heading of ["//X Y Z Intensity\n4000\n", "//X Y Z Intensity\n"]) {
    const { says } = await read("cloud.txt", `${heading}${lines}\n`);
    assert.match(says, /^4000 points/, heading);
  }
  const rows = Float32Array.from([0, 1, 2, 3].flatMap((column) => points.map((point) => point[column])));
  const bytes = npy({ descr: "<f4", shape: [4, 4000], data: rows });
  const turned = await readRigFile({ name: "points.npy", bytes });
  assert.match(turned.says, /^4000 points/);
});

test("raw pixels whose size is in their name", async () => {
  const bytes = new Uint8Array(new Uint16Array(64 * 48).fill(900).buffer);
  const { depth } = await readRigFile({ name: "depth_64x48.raw", bytes });
  assert.deepEqual([depth.width, depth.height], [64, 48]);
  await assert.rejects(readRigFile({ name: "depth_65x48.raw", bytes }), /size/);
});
