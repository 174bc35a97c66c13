// Folders in which names distinguish cameras and calibrations: several cameras around a LiDAR, a calibration for each frame, binned
// pictures, topics of Kalibr, and quaternions of a LiDAR.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { readRigFolder } from "../../pkg/rig.js";
import { close, read, text } from "./rig-support.mjs";
import { spinning } from "./scanners.mjs";
import { png } from "./support.mjs";

const CODES = ({ warnings }) => warnings.map(({ code }) => code);
const folder = (files) => readRigFolder(Object.entries(files).map(([name, bytes]) => ({ name, bytes })));
const colour = (width = 4, height = 2) =>
  png({ width, height, depth: 8, colourType: 2, rows: Array(height).fill(Array(3 * width).fill(90)) });
const depth = (width, height) =>
  png({ width, height, depth: 16, colourType: 0, rows: Array(height).fill(Array(width).fill([4, 176]).flat()) });

/** Points in the form of KITTI's scans: x y z and a reflectance, ring by ring. */
const { points } = spinning({ lasers: 16, step: 0.4 });
const scan = new Uint8Array(
  Float32Array.from({ length: (4 * points.length) / 3 }, (_, at) =>
    at % 4 === 3 ? 0.5 : points[3 * Math.floor(at / 4) + (at % 4)],
  ).buffer,
);

/** From a LiDAR (x forward, z up) to a camera that looks ahead, and to one that looks to the left. */
const AHEAD = [0, -1, 0, 0, 0, -1, 1, 0, 0];
const LEFT = [1, 0, 0, 0, 0, -1, 0, 1, 0];
const rows = (r, t) => [0, 1, 2].map((row) => [...r.slice(3 * row, 3 * row + 3), t[row]]).concat([[0, 0, 0, 1]]);
const k = (focal) => [
  [focal, 0, 1.5],
  [0, focal, 0.5],
  [0, 0, 1],
];
const AROUND = text(
  JSON.stringify({
    CAM_FRONT: { K: k(5), lidar2cam: rows(AHEAD, [0.1, 0.2, 0.3]), width: 4, height: 2 },
    CAM_FRONT_LEFT: { K: k(6), lidar2cam: rows(LEFT, [0.4, 0.5, 0.6]), width: 4, height: 2 },
  }),
);

/** Checks that the only frame has this camera, and that the only pose leads to it. */
function isOf({ frames, poses }, name, focal, rotation) {
  assert.deepEqual(
    frames.map(({ image }) => image.camera.fx),
    [focal],
  );
  assert.deepEqual(
    poses.map(({ from, to }) => [from, to]),
    [["lidar", name]],
  );
  close([...poses[0].pose.rotation], rotation, 1e-9);
}

describe("several cameras around a LiDAR (nuScenes)", () => {
  // A browser puts the folder's own name before all files, so it does not distinguish pictures from scans.
  for (const [path, at] of [
    [(camera) => `${camera}.png`, "LIDAR_TOP.bin"],
    [(camera) => `lidar_nuscenes/${camera}.png`, "lidar_nuscenes/LIDAR_TOP.bin"],
    [(camera) => `samples/${camera}/0.png`, "samples/LIDAR_TOP/0.bin"],
  ]) {
    test(`${path("CAM_FRONT")}: the picture's name chooses its camera and the pose that leads to it`, async () => {
      const one = (camera) => folder({ [path(camera)]: colour(), [at]: scan, "calibration.json": AROUND });
      isOf(await one("CAM_FRONT"), "CAM_FRONT", 5, AHEAD);
      isOf(await one("CAM_FRONT_LEFT"), "CAM_FRONT_LEFT", 6, LEFT);
    });

    test(`${path("CAM_FRONT")}: of two cameras the one ahead makes the frame, and the other is named`, async () => {
      const [left, ahead] = [path("CAM_FRONT_LEFT"), path("CAM_FRONT")];
      const found = await folder({ [left]: colour(), [ahead]: colour(), [at]: scan, "calibration.json": AROUND });
      isOf(found, "CAM_FRONT", 5, AHEAD);
      const [said] = found.warnings.filter(({ code }) => code === "file-left-out");
      assert.equal(said.file, left);
      assert.match(said.message, /CAM_FRONT was chosen.* without the pictures of CAM_FRONT/);
    });
  }

  test("nuScenes' own names have the log, the sensor and the time: pairs by time, of one camera", async () => {
    const name = (sensor, time, end) => `samples/${sensor}/n015-2018-07-24-11-22-45+0800__${sensor}__${time}.${end}`;
    const found = await folder({
      [name("CAM_FRONT", "1532402927612460", "png")]: colour(),
      [name("CAM_FRONT", "1532402928112460", "png")]: colour(),
      [name("CAM_FRONT", "1532402928612460", "png")]: colour(),
      [name("CAM_BACK", "1532402927637525", "png")]: colour(),
      [name("LIDAR_TOP", "1532402927647951", "pcd.bin")]: scan,
      [name("LIDAR_TOP", "1532402928147951", "pcd.bin")]: scan,
      "calibration.json": AROUND,
    });
    assert.equal(found.frames.length, 2);
    assert.deepEqual(new Set(found.frames.map(({ image }) => image.camera.fx)), new Set([5]));
    const of = (code) => found.warnings.filter((each) => each.code === code).map(({ file }) => file);
    assert.deepEqual(of("file-left-out"), [name("CAM_BACK", "1532402927637525", "png")]);
    assert.deepEqual(of("file-alone"), [name("CAM_FRONT", "1532402928612460", "png")]);
  });

  test("pictures without any partner are named, each with the reason", async () => {
    const found = await folder({
      ...{ "a.png": colour(), "b.png": colour(), "c.png": colour() },
      ...{ "velodyne/1.bin": scan, "velodyne/2.bin": scan, "calibration.json": AROUND },
    });
    assert.equal(found.frames.length, 0);
    const said = found.warnings.find(({ code }) => code === "file-alone");
    assert.equal(said.files, 5);
    assert.match(said.message, /3 colour images and 2 depth maps or scans/);
  });
});

describe("a calibration for each frame (KITTI)", () => {
  const calib = (focal, x) =>
    text(
      `P2: ${focal} 0 1.5 0 0 ${focal} 0.5 0 0 0 1 0\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 ${x} 0 0 -1 0.2 1 0 0 0.3\n`,
    );
  const two = (first, second) =>
    folder({
      ...{ "image_2/000000.png": colour(), "velodyne/000000.bin": scan, "calib/000000.txt": first },
      ...{ "image_2/000001.png": colour(), "velodyne/000001.bin": scan, "calib/000001.txt": second },
    });

  test("each frame has its own camera; poses that differ cap the verdict, and each is named after its frame", async () => {
    const found = await two(calib(5, 0.1), calib(6, 0.4));
    assert.deepEqual(
      found.frames.map(({ image }) => image.camera.fx),
      [5, 6],
    );
    assert.deepEqual(
      found.poses.map(({ name }) => name),
      ["image_2 from velodyne", "image_2 from velodyne (000001)"],
    );
    const said = found.warnings.find(({ code }) => code === "calibrations-differ");
    assert.equal(said.isDoubt, true);
    close([said.degrees, said.metres], [0, 0.3], 1e-9);
  });

  test("equal calibrations are one, and nothing is said", async () => {
    const found = await two(calib(5, 0.1), calib(5, 0.1));
    assert.equal(found.poses.length, 1);
    assert.ok(!CODES(found).includes("calibrations-differ"));
    const lenses = await two(calib(5, 0.1), calib(6, 0.1));
    assert.deepEqual(
      lenses.frames.map(({ image }) => image.camera.fx),
      [5, 6],
    );
    assert.ok(!CODES(lenses).includes("calibrations-differ"), "poses are the same");
  });
});

describe("names and sizes of cameras", () => {
  const own = { "color/1.png": colour(8, 4), "depth/1.png": depth(8, 4) };
  const camera = (width, height, focal) =>
    text(JSON.stringify({ width, height, fx: focal, fy: focal, cx: (width - 1) / 2, cy: (height - 1) / 2 }));

  test("pictures of half a camera's size are that camera's, scaled with a doubt, not the depth camera's", async () => {
    const found = await folder({ ...own, "color.json": camera(16, 8, 20), "depth.json": camera(8, 4, 7) });
    const [{ image, depth: map }] = found.frames;
    assert.deepEqual([image.camera.fx, image.camera.cx, map.camera.fx], [10, 3.5, 7]);
    assert.deepEqual(found.poses, []);
    assert.equal(found.warnings.find(({ code }) => code === "camera-size").isDoubt, true);
  });

  test("Kalibr's topics name the cameras and the ends of the pose", async () => {
    const chain = (first, second) =>
      text(
        `cam0:\n  camera_model: pinhole\n  intrinsics: [5, 5, 3.5, 1.5]\n  resolution: [8, 4]\n  rostopic: ${first}\ncam1:\n  T_cn_cnm1:\n  - [1, 0, 0, 0.05]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n  camera_model: pinhole\n  intrinsics: [6, 6, 3.5, 1.5]\n  resolution: [8, 4]\n  rostopic: ${second}\n`,
      );
    const [ir, rgb] = ["/camera/infra1/image_rect_raw", "/camera/color/image_raw"];
    for (const [topics, focals, named] of [
      [
        [ir, rgb],
        [6, 5],
        ["camera/infra1", "camera/color"],
      ],
      [
        [rgb, ir],
        [5, 6],
        ["camera/color", "camera/infra1"],
      ],
    ]) {
      const found = await folder({ ...own, "camchain.yaml": chain(...topics) });
      const [{ image, depth: map }] = found.frames;
      assert.deepEqual([image.camera.fx, map.camera.fx], focals);
      assert.deepEqual([found.poses[0].from, found.poses[0].to], named);
      assert.ok(!CODES(found).includes("cameras-by-order"));
    }
  });

  test("a quaternion from a LiDAR to a camera: of both orders the one in which the camera looks forward", async () => {
    // AHEAD, turned by 8 degrees about the vertical and 5 about the camera's x, as Rz then R, by the product of quaternions w x y z.
    const product = ([a, b, c, d], [e, f, g, h]) => [
      a * e - b * f - c * g - d * h,
      a * f + b * e + c * h - d * g,
      a * g - b * h + c * e + d * f,
      a * h + b * g - c * f + d * e,
    ];
    const about = (axis, degrees) => {
      const half = (degrees * Math.PI) / 360;
      return [Math.cos(half), ...[0, 1, 2].map((each) => (each === axis ? Math.sin(half) : 0))];
    };
    const [w, x, y, z] = product(product(about(0, 5), [0.5, 0.5, -0.5, 0.5]), about(2, 8));
    const forward = [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)];
    for (const values of [
      [w, x, y, z],
      [x, y, z, w],
    ]) {
      const content = `translation: [0.05, -0.12, -0.27]\nrotation: [${values.join(", ")}]\n`;
      const found = await read("lidar_to_camera.yaml", content);
      close(found.poses[0].pose.rotation.slice(6), forward, 1e-6);
      assert.deepEqual(CODES(found), ["quaternion-order"]);
    }
  });
});
