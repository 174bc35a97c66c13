// The frames that the files of a rig and their names state for a pose, and lenses in separate files.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { readRigFile, readRigFolder } from "../../pkg/rig.js";
import { isBackwards } from "../../pkg/rig-words.js";
import { npy, png } from "./support.mjs";

const file = (name, text) => ({ name, bytes: new TextEncoder().encode(text) });
const codes = (warnings) => warnings.map(({ code }) => code);
const SHIFT = "1 0 0 0.1\n0 1 0 0.2\n0 0 1 0.3\n0 0 0 1\n";

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
  const { poses } = await readRigFile(file("tag_to_cam.txt", SHIFT));
  assert.deepEqual([poses[0].from, poses[0].to], ["tag", "cam"]);
  const placed = await readRigFile(file("object_pose.txt", SHIFT));
  assert.equal(placed.poses[0].to, "world");
});

test("MVSNet's cameras are read with their intrinsics, and their extrinsics as poses of the world", async () => {
  const text = `extrinsic\n${SHIFT}\nintrinsic\n600 0 320\n0 610 240\n0 0 1\n\n425.0 2.5 192 933.8\n`;
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

test("frames by ViSP's, OKVIS's and others' names, and robots' results", async () => {
  for (const [name, from, to] of [
    ["cMo.txt", "object", "camera"],
    ["T_SC.txt", "camera", "imu"],
    ["X_WC.txt", "camera", "world"],
    ["cam0_wrt_table.txt", "cam0", "table"],
    ["hand_eye.txt", "camera", "gripper"],
    ["eye_to_hand.txt", "camera", "base"],
    ["calib_cam_to_velo.txt", "cam00", "velodyne"],
  ]) {
    const { poses } = await readRigFile(file(name, SHIFT));
    assert.deepEqual([poses[0].from, poses[0].to], [from, to], name);
  }
});

test("extrinsics named after one camera are a doubt, unless they move nothing", async () => {
  const isDoubted = async (text) =>
    (await readRigFile(file("extrinsic_color.txt", text))).warnings.some(({ code }) => code === "pose-assumed");
  assert.equal(await isDoubted(SHIFT), true);
  assert.equal(await isDoubted(SHIFT.replace(/0\.\d/g, "0")), false);
});

test("multical's names contradict its exporter, which is a doubt", async () => {
  const camera = {
    model: "standard",
    image_size: [640, 480],
    K: [
      [600, 0, 320],
      [0, 600, 240],
      [0, 0, 1],
    ],
    dist: [[0]],
  };
  const R = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  const found = await readRigFile(
    file(
      "calibration.json",
      JSON.stringify({
        cameras: { color: camera, depth: camera },
        camera_poses: { depth: { R, T: [0, 0, 0] }, color_to_depth: { R, T: [0.1, 0, 0] } },
      }),
    ),
  );
  assert.ok(found.warnings.some(({ code, isDoubt }) => code === "pose-assumed" && isDoubt));
});

test("lists of a damaged YAML that are read line by line are a doubt", async () => {
  const transform = (x) =>
    `  - header:\n        seq: 0\n      stamp: 1\n    transform:\n      translation:\n        x: ${x}\n        y: 0\n        z: 0\n      rotation:\n        x: 0\n        y: 0\n        z: 0\n        w: 1\n`;
  const found = await readRigFile(file("tf.txt", `transforms:\n${transform(0.1)}${transform(0.2)}`)).catch(
    () => undefined,
  );
  assert.ok(found === undefined || found.warnings.some(({ code }) => code === "read-by-lines"));
});

describe("a lens in a separate file", () => {
  const matrix = (f) => `${f} 0 320\n0 ${f} 240\n0 0 1\n`;
  const lensOf = ({ cameras }, at = 0) => cameras[at].camera.distortion;

  test("belongs to the camera whose file is called like it", async () => {
    for (const [one, other] of [
      ["color_K.txt", "color_dist.txt"],
      ["K_color.txt", "D_color.txt"],
      ["rgb/intrinsics.txt", "rgb/distortion.txt"],
      ["cameraMatrix.txt", "cameraDistortion.txt"],
    ]) {
      const depth = [file("depth_K.txt", matrix(400)), file("depth_dist.txt", "0 0 0 0 0")];
      const files = [file(one, matrix(600)), file(other, "0.1, -0.2, 0.001, 0, 0.05\n"), ...depth];
      const { cameras, warnings } = await readRigFolder(files);
      const own = cameras.find(({ camera }) => camera.fx === 600);
      assert.deepEqual(own.camera.distortion, [0.1, -0.2, 0.001, 0, 0.05], one);
      assert.equal(cameras.find(({ camera }) => camera.fx === 400).camera.distortion, undefined);
      assert.equal(codes(warnings).includes("distortion-unused"), false, one);
    }
  });

  test("is read from a column, a list, YAML and NumPy's arrays", async () => {
    const numpy = npy({ descr: "<f8", shape: [5, 1], data: new Float64Array([0.1, -0.2, 0.001, 0, 0.05]) });
    for (const bytes of [
      "0.1\n-0.2\n0.001\n0\n0.05\n",
      "[[0.1, -0.2, 0.001, 0, 0.05]]",
      "distortion_coefficients: [0.1, -0.2, 0.001, 0, 0.05]\n",
      "%YAML:1.0\nD: !!opencv-matrix\n  rows: 1\n  cols: 5\n  dt: d\n  data: [ 0.1, -0.2, 0.001, 0, 0.05 ]\n",
      numpy,
    ]) {
      const lens = typeof bytes === "string" ? file("D.yaml", bytes) : { name: "D.npy", bytes };
      assert.deepEqual(lensOf(await readRigFolder([file("K.txt", matrix(600)), lens])), [0.1, -0.2, 0.001, 0, 0.05]);
    }
  });

  test("caps the verdict where it is of no camera, of several, or of four numbers", async () => {
    const [K, D] = [file("color_K.txt", matrix(600)), "0.1 -0.2 0.001 0 0.05\n"];
    for (const files of [
      [K, file("depth_dist.txt", D)],
      [K, file("color_dist.txt", "no numbers")],
      [K, file("color_camera_matrix.txt", matrix(610)), file("color_dist.txt", D)],
      [K, file("color_dist.txt", "0.1 0 0 0 0 0 0 0 0.2 0 0 0\n")],
    ]) {
      const { warnings } = await readRigFolder(files);
      assert.ok(codes(warnings).includes("distortion-unused"), files.map(({ name }) => name).join(" "));
    }
    const { warnings } = await readRigFolder([K, file("color_dist.txt", "0.1 -0.2 0.001 0\n")]);
    assert.ok(codes(warnings).includes("distortion-guessed"));
  });
});

test("as many images as depth maps, numbered from different starts, are a doubt", async () => {
  const picture = (depth, value) =>
    png({
      width: 2,
      height: 1,
      depth: depth ? 16 : 8,
      colourType: depth ? 0 : 2,
      rows: [depth ? [3, value, 3, value] : Array(6).fill(value)],
    });
  const files = (first) =>
    [0, 1, 2].flatMap((at) => [
      { name: `color/${at + first}.png`, bytes: picture(false, at) },
      { name: `depth/${at}.png`, bytes: picture(true, at) },
    ]);
  assert.ok(codes((await readRigFolder(files(1))).warnings).includes("pairs-shifted"));
  assert.equal(codes((await readRigFolder(files(0))).warnings).includes("pairs-shifted"), false);
});

test("a camera for each frame may be called frame_00000.json", async () => {
  const picture = (depth) =>
    png({
      width: depth ? 4 : 8,
      height: depth ? 3 : 6,
      depth: depth ? 16 : 8,
      colourType: depth ? 0 : 2,
      rows: Array(depth ? 3 : 6).fill(Array(depth ? 8 : 24).fill(9)),
    });
  const files = ["00000", "00001"].flatMap((at) => [
    { name: `frame_${at}.png`, bytes: picture(false) },
    { name: `depth_${at}.png`, bytes: picture(true) },
    file(`frame_${at}.json`, JSON.stringify({ intrinsics: [8, 0, 4, 0, 8, 3, 0, 0, 1] })),
  ]);
  const { frames } = await readRigFolder(files);
  for (const { image, depth } of frames) assert.deepEqual([image.camera.fx, depth.camera.fx], [8, 4]);
});

test("colours and depths in one array are refused, and so are a radar's points", async () => {
  const data = new Float32Array(4 * 64 * 48).map((_, at) => (at % 4 < 3 ? 0.5 : 1.7));
  const bytes = npy({ descr: "<f4", shape: [48, 64, 4], data });
  await assert.rejects(readRigFile({ name: "rgbd.npy", bytes }), /two files/);
  const opaque = npy({ descr: "<f4", shape: [48, 64, 4], data: data.map((value, at) => (at % 4 < 3 ? value : 1)) });
  assert.equal((await readRigFile({ name: "rgba.npy", bytes: opaque })).kind, "colour");
  const points = Float32Array.from(
    Array.from({ length: 300 }, (_, at) => [
      5 + Math.sin(at),
      4 * Math.cos(3 * at),
      Math.sin(7 * at),
      9,
      0.5,
      0.2,
      0,
    ]).flat(),
  );
  const scan = { name: "radar/00549.bin", bytes: new Uint8Array(points.buffer) };
  await assert.rejects(readRigFile(scan), /radar/);
  assert.equal((await readRigFile({ ...scan, name: "velodyne/00549.bin" })).kind, "depth");
});
