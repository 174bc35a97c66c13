// Matrices that are not plain motions, parts of a sensor's pictures, joints that move, and formats that are refused by name.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { K, codes, matrix, only, read, refusedFile, rows, sameCamera, samePose, translation } from "./rig-support.mjs";

const { fx, fy, cx, cy } = K;
const columns = matrix[0].map((_, at) => matrix.map((row) => row[at]));
/** K [R | t], by rows. */
const projection = [
  matrix[0].map((value, at) => fx * value + cx * matrix[2][at]),
  matrix[1].map((value, at) => fy * value + cy * matrix[2][at]),
  ...matrix.slice(2),
];
const json = (value) => read("rig.json", JSON.stringify(value));

describe("matrices", () => {
  test("with the translation in the last row are transposed, and said to be", async () => {
    for (const reading of [
      await json({ lidar_to_camera: columns }),
      await read("lidar_to_camera.txt", columns.map((row) => row.join(" ")).join("\n")),
    ]) {
      samePose(only(reading.poses));
      assert.deepEqual(codes(reading), ["rotation-order"]);
    }
  });

  test("of MATLAB's rigid3d come with a rotation for row vectors, which is not another pose", async () => {
    const turned = [0, 1, 2].map((at) => rows.map((row) => row[at]));
    samePose(only((await json({ T: columns, Rotation: turned, Translation: translation })).poses));
  });

  test("that are projections are left out by name, and the file's others kept", async () => {
    const reading = await json({ lidar2img: projection, lidar2cam: matrix });
    samePose(only(reading.poses));
    assert.deepEqual(codes(reading), ["pose-left-out"]);
    assert.match(reading.warnings[0].message, /"lidar2img" is a projection/);
    await refusedFile(json({ lidar2img: projection }), "rig.json", /"lidar2img" is a projection/);
    const lines = projection.slice(0, 3).map((row) => row.join(" "));
    await refusedFile(read("P.txt", lines.join("\n")), "P.txt", /is a projection/);
  });
});

describe("camera_info", () => {
  const info = { width: 1280, height: 960, k: [fx, 0, cx, 0, fy, cy, 0, 0, 1], d: [], distortion_model: "plumb_bob" };
  const camera = async (more) => only((await json({ ...info, ...more })).cameras);
  const size = ({ width, height }) => [width, height];
  const none = { x_offset: 0, y_offset: 0, width: 0, height: 0 };

  test("a region of interest moves the principal point", async () => {
    const found = await camera({ roi: { x_offset: 100, y_offset: 60, width: 640, height: 480 } });
    assert.deepEqual(size(found), [640, 480]);
    sameCamera(found, null, { fx, fy, cx: cx - 100, cy: cy - 60 });
    const own = await camera({
      width: 640,
      height: 480,
      roi: { x_offset: 100, y_offset: 60, width: 640, height: 480 },
    });
    sameCamera(own, null);
  });

  test("binning scales about the corner of the first pixel", async () => {
    const found = await camera({ binning_x: 2, binning_y: 4, roi: none });
    assert.deepEqual(size(found), [640, 240]);
    sameCamera(found, null, { fx: fx / 2, fy: fy / 4, cx: (cx + 0.5) / 2 - 0.5, cy: (cy + 0.5) / 4 - 0.5 });
    sameCamera(await camera({ binning_x: 0, binning_y: 0, roi: none }), null);
  });
});

describe("URDF", () => {
  const joint = (name, type, parent, child) =>
    `<joint name="${name}" type="${type}"><origin xyz="0.1 0 0.3" rpy="0 0 0"/><parent link="${parent}"/><child link="${child}"/></joint>`;
  const robot = (type, arm) =>
    read(
      "rig.urdf",
      `<robot name="r">${joint("a", "fixed", "base", "lidar")}${joint("pan", type, "base", "mast")}${joint("b", "fixed", "mast", "camera_color_optical_frame")}${joint("wheel", arm, "base", "tyre")}</robot>`,
    );
  test("a joint that moves between the sensors is a doubt, and one elsewhere is none", async () => {
    for (const type of ["revolute", "continuous", "prismatic"]) {
      const found = await robot(type, "fixed");
      assert.deepEqual(codes(found), ["pose-assumed"], type);
      assert.match(found.warnings[0].message, /"pan"/);
    }
    assert.deepEqual(codes(await robot("fixed", "continuous")), []);
  });
});

test("a scan of six floats has rings, intensities and times", async () => {
  const values = [];
  for (let ring = 0; ring < 16; ring++)
    for (let column = 0; column < 900; column++) {
      const [azimuth, elevation] = [(2 * Math.PI * column) / 900, (ring - 8) / 30];
      const range = 5 + 0.2 * Math.sin(azimuth);
      const level = range * Math.cos(elevation);
      values.push(
        level * Math.cos(azimuth),
        level * Math.sin(azimuth),
        range * Math.sin(elevation),
        0.5,
        ring,
        column / 2000,
      );
    }
  const found = await read("scan.bin", new Uint8Array(Float32Array.from(values).buffer));
  assert.deepEqual(
    [found.scan.ring?.length, found.scan.intensity?.length, found.scan.times?.length],
    [14_400, 14_400, 14_400],
  );
  assert.ok(codes(found).includes("point-times"));
});

test("rigs of COLMAP and cameras of DSO are refused by name", async () => {
  const rig =
    "# Rig calib list with one line of data per calib:\n#   RIG_ID, NUM_SENSORS\n1 2 CAMERA 1 CAMERA 2 1 1 0 0 0 0.1 0 0\n";
  await refusedFile(read("rigs.txt", rig), "rigs.txt", /COLMAP/);
  for (const first of ["EquiDistant 190.9 190.9 254.9 256.8 0.003 0.0007 -0.002 0.0002", "0.53 0.66 0.49 0.5 0.89"])
    await refusedFile(read("camera.txt", `${first}\n512 512\ncrop\n512 512\n`), "camera.txt", /DSO/);
});

test("cameras in a list have names of their own", async () => {
  const { cameras } = await json({
    cameras: [
      { fx, fy, cx, cy },
      { fx, fy, cx, cy },
    ],
  });
  assert.deepEqual(
    cameras.map(({ name }) => name),
    ["cameras 0", "cameras 1"],
  );
});
