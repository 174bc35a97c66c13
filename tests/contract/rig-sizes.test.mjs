// Which of many cameras took a folder's pictures: by size, by statements of files or names, scaled where the view is the same.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { readRigFolder } from "../../pkg/rig.js";
import { writePng } from "../../pkg/write.js";
import { close, text } from "./rig-support.mjs";

const colour = (width, height) => ({
  ...{ width, height, channels: 3 },
  data: Uint8Array.from({ length: 3 * width * height }, (_, i) => (37 * i) % 251),
});
const depth = (width, height, from = 1500) => ({
  ...{ width, height, channels: 1 },
  data: Uint16Array.from({ length: width * height }, (_, i) => from + (i % 97)),
});
/** Reads files, given by name: pictures, texts, or objects as JSON. */
async function folder(files) {
  const named = [];
  for (const [name, content] of Object.entries(files)) {
    const bytes =
      typeof content === "string"
        ? text(content)
        : content.data
          ? await writePng(content)
          : text(JSON.stringify(content));
    named.push({ name, bytes });
  }
  return readRigFolder(named);
}
const numbers = (camera) => camera && [camera.fx, camera.fy, camera.cx, camera.cy];
const cameras = ({ frames }) => frames.map(({ image, depth: map }) => [numbers(image.camera), numbers(map.camera)]);
const codes = ({ warnings }) => warnings.map(({ code }) => code).filter((code) => code !== "unit-guessed");
const camera = (f, width, height) => ({ fx: f, fy: f, cx: width / 2, cy: height / 2, width, height });
const pair = (a = [64, 48], b = a) => ({ "color/1.png": colour(...a), "depth/1.png": depth(...b) });

describe("a camera of many sizes", () => {
  const stream = (name, w, h, f) =>
    `Intrinsic of "${name}" / ${w}x${h} / {Z16}\n  Width: ${w}\n  Height: ${h}\n  PPX: ${w / 2}\n  PPY: ${h / 2}\n  Fx: ${f}\n  Fy: ${f}\n  Distortion: None\n  Coeffs: 0 0 0 0 0\n\n`;
  const list = [
    stream("Infrared 2", 64, 48, 45),
    stream("Depth", 128, 96, 100),
    stream("Depth", 64, 48, 50),
    stream("Color", 192, 144, 180),
    stream("Color", 128, 96, 120),
    stream("Color", 64, 48, 60),
  ].join("");
  const way = (from, to, t) =>
    `Extrinsic from "${from}" To "${to}" :\n Rotation Matrix:\n 1 0 0\n 0 1 0\n 0 0 1\n\n Translation Vector: ${t} 0 0\n\n`;

  for (const [a, b, expected] of [
    [
      [64, 48],
      [64, 48],
      [60, 50],
    ],
    [
      [128, 96],
      [64, 48],
      [120, 50],
    ],
    [
      [192, 144],
      [128, 96],
      [180, 100],
    ],
  ])
    test(`colour of ${a.join("x")} and depth of ${b.join("x")}`, async () => {
      const found = await folder({ ...pair(a, b), "rs.txt": list });
      assert.deepEqual(
        cameras(found)[0].map(([fx]) => fx),
        expected,
      );
      assert.deepEqual(codes(found), []);
    });

  test("where no size is that of the picture, one of the same view is scaled, with a word", async () => {
    const found = await folder({ ...pair([32, 24], [64, 48]), "rs.txt": list });
    close(cameras(found)[0][0], [30, 30, 96.5 / 6 - 0.5, 72.5 / 6 - 0.5], 1e-9);
    assert.deepEqual(codes(found), ["camera-size"]);
    assert.match(
      found.warnings.find(({ code }) => code === "camera-size").message,
      /192x144 .* 32x24: the intrinsics were scaled/,
    );
  });

  test("depth to colour heads the poses, those from a stream to itself are none", async () => {
    const poses =
      way("Depth", "Depth", 0) +
      way("Color", "Depth", -0.1) +
      way("Color", "Infrared 1", -0.1) +
      way("Depth", "Color", 0.1);
    const found = await folder({ ...pair(), "rs.txt": list + poses });
    assert.deepEqual(
      found.poses.map(({ from, to }) => `${from} ${to}`),
      ["Depth Color", "Color Depth", "Color Infrared 1"],
    );
  });

  test("sizes as names of members, streams named by a member of theirs", async () => {
    const K = (f, w, h) => ({ fx: f, fy: f, ppx: w / 2, ppy: h / 2 });
    const members = { color: { "128x96": K(120, 128, 96), "64x48": K(60, 64, 48) }, depth: { "64x48": K(50, 64, 48) } };
    const streams = [
      { stream: "Color", ...camera(120, 128, 96) },
      { type: "depth", intrinsics: camera(50, 64, 48) },
      { stream: "Color", ...camera(60, 64, 48) },
    ];
    for (const calibration of [members, { streams }]) {
      const found = await folder({ ...pair(), "calib.json": calibration });
      assert.deepEqual(
        cameras(found)[0].map(([fx]) => fx),
        [60, 50],
      );
      assert.deepEqual(codes(found), []);
    }
  });

  test("a file's name says which way its only pose leads", async () => {
    const matrix = "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    for (const [name, ends] of [
      ["calib/cam_to_velo.txt", ["cam", "velo"]],
      ["lidar2camera.txt", ["lidar", "camera"]],
      ["rgb_to_depth.txt", ["rgb", "depth"]],
      ["rgb_from_depth.txt", [undefined, undefined]],
      ["T_cam_lidar.txt", ["lidar", "cam"]],
      ["top_center_lidar-to-center_camera-extrinsic.txt", ["top_center_lidar", "center_camera"]],
      ["how_to_mount.txt", [undefined, undefined]],
      ["extrinsics.txt", [undefined, undefined]],
    ]) {
      const [{ from, to }] = (await folder({ [name]: matrix })).poses;
      assert.deepEqual([from, to], ends, name);
    }
  });

  test("two cameras that may have taken the same pictures are named", async () => {
    const found = await folder({
      ...pair(),
      "a_rgb.json": camera(60, 64, 48),
      "b_rgb.json": camera(70, 64, 48),
      "depth.json": camera(50, 64, 48),
    });
    assert.deepEqual(codes(found), ["cameras-by-order"]);
    assert.match(
      found.warnings.at(-1).message,
      /colour images; the first of a_rgb \(fx 60\.0\) and b_rgb \(fx 70\.0\)/,
    );
  });
});

describe("one camera for both pictures", () => {
  test("a smaller registered depth map has the colour camera, scaled about the corner of the picture", async () => {
    for (const [name, K] of [
      ["camera_matrix.csv", "60.0, 0.0, 32.5\n0.0, 60.0, 24.5\n0.0, 0.0, 1.0\n"],
      ["intrinsics.json", { ...camera(60, 64, 48), cx: 32.5, cy: 24.5 }],
    ]) {
      const found = await folder({ ...pair([64, 48], [16, 12]), [name]: K });
      assert.deepEqual(cameras(found)[0], [
        [60, 60, 32.5, 24.5],
        [15, 15, 33 / 4 - 0.5, 25 / 4 - 0.5],
      ]);
      assert.deepEqual(codes(found), ["camera-shared"]);
    }
  });

  test("of another aspect it is the camera of one", async () => {
    const found = await folder({ ...pair([64, 48], [16, 16]), "K.txt": "60 0 32\n0 60 24\n0 0 1\n" });
    assert.deepEqual(cameras(found)[0], [[60, 60, 32, 24], undefined]);
    assert.deepEqual(codes(found), ["depth-camera-missing"]);
  });

  test("cameras that are called as the frames are each frame's own", async () => {
    const found = await folder({
      ...{
        "images/11.png": colour(64, 48),
        "images/12.png": colour(64, 48),
        "depth/11.png": depth(16, 12),
        "depth/12.png": depth(16, 12),
      },
      ...{ "cameras/11.json": camera(60, 64, 48), "cameras/12.json": camera(64, 64, 48) },
    });
    assert.deepEqual(
      cameras(found).map((each) => each.map(([fx]) => fx)),
      [
        [60, 15],
        [64, 16],
      ],
    );
    assert.deepEqual(codes(found), ["camera-shared"]);
  });

  test("depth maps whose names say that they are aligned have the colour camera and no pose", async () => {
    const rig = {
      color: camera(60, 64, 48),
      depth: camera(50, 64, 48),
      depth_to_color: [
        [1, 0, 0, 0.1],
        [0, 1, 0, 0],
        [0, 0, 1, 0],
      ],
    };
    const found = await folder({
      "color_1.png": colour(64, 48),
      "aligned_depth_1.png": depth(64, 48),
      "rig.json": rig,
    });
    assert.deepEqual(
      cameras(found)[0].map(([fx]) => fx),
      [60, 60],
    );
    assert.deepEqual(
      found.poses.map(({ pose }) => pose.translation[0]),
      [0, 0.1],
    );
    assert.deepEqual(codes(found), ["camera-shared"]);
    const plain = await folder({ "color_1.png": colour(64, 48), "depth_1.png": depth(64, 48), "rig.json": rig });
    assert.deepEqual(
      cameras(plain)[0].map(([fx]) => fx),
      [60, 50],
    );
    assert.deepEqual([plain.poses.length, ...codes(plain)], [1]);
  });
});

test("pictures of a size that their own camera does not have were carried into the other's view", async () => {
  const rig = {
    color: camera(60, 64, 48),
    depth: camera(50, 80, 50),
    depth_to_color: [
      [1, 0, 0, 0.1],
      [0, 1, 0, 0],
      [0, 0, 1, 0],
    ],
  };
  for (const [size, f] of [
    [[64, 48], 60],
    [[80, 50], 50],
  ]) {
    const found = await folder({ ...pair(size), "rig.json": rig });
    assert.deepEqual(
      cameras(found)[0].map(([fx]) => fx),
      [f, f],
    );
    assert.deepEqual(
      found.poses.map(({ pose }) => pose.translation[0]),
      [0, 0.1],
    );
    assert.deepEqual(codes(found), ["camera-shared"]);
  }
});

describe("what files say of the pictures beside them", () => {
  test("the unit of depths: BOP's millimetres, each image with its own camera", async () => {
    const scene = (f) => ({ cam_K: [f, 0, 32, 0, f, 24, 0, 0, 1], depth_scale: 0.1 });
    const found = await folder({
      ...{ "rgb/000001.png": colour(64, 48), "rgb/000002.png": colour(64, 48) },
      ...{ "depth/000001.png": depth(64, 48, 15000), "depth/000002.png": depth(64, 48, 15000) },
      "scene_camera.json": { 1: scene(60), 2: scene(66) },
    });
    assert.deepEqual(
      found.frames.map(({ depth: { unit } }) => unit),
      [1e-4, 1e-4],
    );
    assert.deepEqual(
      cameras(found).map((each) => each.map(([fx]) => fx)),
      [
        [60, 60],
        [66, 66],
      ],
    );
    assert.deepEqual(found.warnings, []);
  });

  test("KITTI: the camera that is called as the pictures' folder", async () => {
    const P = (i, f) => `P${i}: ${f} 0 32 ${-0.1 * i * f} 0 ${f} 24 0 0 0 1 0\n`;
    const calib = `${P(0, 60)}${P(2, 62)}${P(3, 63)}Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n`;
    for (const [number, f, shift] of [
      [2, 62, -0.2],
      [3, 63, -0.3],
    ]) {
      const found = await folder({
        [`image_${number}/000001.png`]: colour(64, 48),
        "depth/000001.png": depth(64, 48),
        "calib.txt": calib,
      });
      assert.deepEqual(
        cameras(found)[0].map(([fx]) => fx),
        [f, f],
      );
      assert.deepEqual(
        found.poses.map(({ to }) => to),
        [`image_${number}`, `image_${number}`],
      );
      close(found.poses[1].pose.translation, [shift, 0, 0], 1e-9);
      assert.deepEqual(codes(found), ["camera-shared"]);
    }
  });

  test("frames that several files share relate the cameras", async () => {
    const model = (f, t) =>
      `{\n  'lensmodel': 'LENSMODEL_PINHOLE',\n  'intrinsics': [ ${f},${f},32,24,],\n  'extrinsics': [ 0,0,0,${t},0,0,],\n  'imagersize': [ 64,48,],\n}\n`;
    const found = await folder({ ...pair(), "depth.cameramodel": model(50, 0.1), "rgb.cameramodel": model(60, 0.4) });
    assert.deepEqual(
      cameras(found)[0].map(([fx]) => fx),
      [60, 50],
    );
    const [{ from, to, pose }] = found.poses;
    assert.deepEqual([from, to], ["depth.cameramodel", "rgb.cameramodel"]);
    close(pose.translation, [0.3, 0, 0], 1e-9);
  });
});
