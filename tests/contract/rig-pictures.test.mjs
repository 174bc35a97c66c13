// The contents of a picture or a cloud, inferred from name and values: depths in colour codes, disparities, infrared, labels, units and axes.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { pcd } from "./malformed.mjs";
import { close, metres, read, refusedFile } from "./rig-support.mjs";
import { png } from "./support.mjs";

const says = async (code, pattern, name, bytes, options) => {
  const { warnings } = await read(name, bytes, options);
  const found = warnings.find((each) => each.code === code && pattern.test(each.message));
  assert.ok(found, JSON.stringify(warnings));
  assert.ok(found.isDoubt);
};
const refused = (name, bytes, reason, options) => refusedFile(read(name, bytes, options), name, reason);
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

/** A smooth depth map of 64x48 whole numbers up to a maximum. */
const [COLUMNS, ROWS] = [64, 48];
const slope = (most) =>
  Array.from({ length: COLUMNS * ROWS }, (_, at) =>
    Math.round(most * (0.3 + (0.5 * (at % COLUMNS)) / COLUMNS + (0.15 * Math.floor(at / COLUMNS)) / ROWS)),
  );
const picture = (depth, colourType, pixel) =>
  png({
    width: COLUMNS,
    height: ROWS,
    depth,
    colourType,
    rows: Array.from({ length: ROWS }, (_, y) =>
      Array.from({ length: COLUMNS }, (_, x) => pixel(y * COLUMNS + x)).flat(),
    ),
  });
const grey16 = (values) => picture(16, 0, (at) => [values[at] >> 8, values[at] & 255]);

describe("depths that are coded in colours", () => {
  const [low, high] = [(value) => value & 255, (value) => (value >> 8) & 255];
  const code16 = slope(4000);
  const code24 = slope(2 ** 20);
  const codes = {
    "high byte in red": [(v) => [high(v), low(v), 0], code16, 0.001],
    "low byte in red": [(v) => [low(v), high(v), 0], code16, 0.001],
    "CARLA's 24 bits": [(v) => [low(v), high(v), v >> 16], code24, 1000 / (2 ** 24 - 1)],
    "24 bits the other way round": [(v) => [v >> 16, high(v), low(v)], code24, 1000 / (2 ** 24 - 1)],
  };
  for (const [name, [code, values, unit]] of Object.entries(codes))
    test(name, async () => {
      const bytes = picture(8, 2, (at) => code(values[at]));
      for (const options of [{}, { as: "depth" }]) {
        const reading = await read("depth_1.png", bytes, options);
        close(
          metres(reading),
          values.map((value) => value * unit),
          1e-3,
        );
      }
      await says("unit-guessed", /coded in the picture's colours/, "depth_1.png", bytes);
      // Without "depth" in its name, it is a picture.
      assert.equal((await read("1.png", bytes)).kind, "colour");
    });

  test("a rendering of depths is no depth map, and a photograph is none", async () => {
    const rendering = picture(8, 2, (at) => [slope(255)[at], 80, 255 - slope(255)[at]]);
    await says("files-swapped", /name says depth.*rendering/, "depth_1.png", rendering);
    await refused("depth_1.png", rendering, /rendering of the depth/, { as: "depth" });
    const photo = picture(8, 2, (at) => [(at * 7919) % 251, (at * 104729) % 241, (at * 1299709) % 239]);
    await refused("depth_1.png", photo, /colour picture/, { as: "depth" });
  });
});

describe("what a picture holds is told by its name and its values", () => {
  const depth16 = grey16(slope(4000));
  test("disparities are refused unless somebody says that they are depths", async () => {
    for (const name of ["disp0.png", "disparity/1.png", "left_disp.png", "disp_occ_0/000000_10.png"]) {
      await refused(name, depth16, /disparities.*focal length \* baseline/);
      await refused(name, depth16, /disparities/, { as: "depth" });
    }
    const reading = await read("disp0.png", depth16, { unit: 0.001, as: "depth" });
    assert.equal(reading.kind, "depth");
    assert.equal((await read("display.png", depth16)).kind, "depth");
    assert.equal((await read("depth_from_disparity.png", depth16)).kind, "depth");
    await refused("inverse_depth.png", depth16, /disparities or inverse depths/);
    assert.equal((await read("undistorted.png", depth16)).kind, "depth");
  });

  test("infrared and confidences are no depth maps", async () => {
    for (const name of ["ir_1.png", "infrared/1.png", "1_Infrared.png", "amplitude.png"])
      assert.equal((await read(name, depth16)).kind, "colour", name);
    await refused("confidence/1.png", depth16, /confidences: that is neither/);
    await refused("depth_conf_1.png", depth16, /confidences/);
    await says("files-swapped", /name says that it holds infrared/, "ir_1.png", depth16, { as: "depth" });
    await refused("semantic/1.png", depth16, /labels of objects/);
  });

  test("distances along the rays are no depths", async () => {
    for (const name of ["distance_to_camera_0000.png", "depth_euclidean.png"])
      await says("files-swapped", /distances along the rays/, name, depth16);
    const { warnings } = await read("distance_to_image_plane_0000.png", depth16);
    assert.ok(!warnings.some(({ code }) => code === "files-swapped"));
  });

  test("the innermost word counts, and pictures of folders called depth are depths", async () => {
    const dark = picture(8, 0, (at) => [at % 200]);
    for (const name of ["depth/image_1.png", "images/depth/1.png", "a/rgb/depth_1.png"])
      assert.equal((await read(name, dark)).kind, "depth", name);
    for (const name of ["depth/rgb_1.png", "depth_set/images/1.png", "color_to_depth_1.png"])
      assert.equal((await read(name, dark)).kind, "colour", name);
  });

  test("values that change from pixel to pixel are those of an image", async () => {
    const noisy = grey16(Array.from({ length: COLUMNS * ROWS }, (_, at) => 300 + ((at * 7919) % 211)));
    await says("files-swapped", /like those of an image/, "1.png", noisy, { as: "depth" });
    const steep = grey16(Array.from({ length: COLUMNS * ROWS }, (_, at) => 100 + 10 * (at % COLUMNS)));
    for (const smooth of [depth16, steep]) {
      const { warnings } = await read("1.png", smooth, { as: "depth" });
      assert.ok(!warnings.some(({ code }) => code === "files-swapped"));
    }
  });

  test("16-bit masks and labels", async () => {
    assert.equal((await read("x.png", grey16(slope(4000).map((_, at) => (at % 3 ? 65_535 : 0))))).kind, "mask");
    await refused("x.png", grey16(slope(4000).map((_, at) => at % 7)), /labels of objects rather than depths/);
  });

  test("three floats are points where they lie to both sides, else colours", async () => {
    const pfm = (value) => {
      const floats = new Float32Array(3 * COLUMNS * ROWS).map((_, at) => value(at % 3, Math.floor(at / 3)));
      return new Uint8Array([...Buffer.from(`PF\n${COLUMNS} ${ROWS}\n-1\n`), ...bytesOf(floats)]);
    };
    // Rows run from the bottom up.
    const cloud = pfm((axis, at) => [(at % COLUMNS) / 32 - 1, 0.7 - Math.floor(at / COLUMNS) / 32, 2][axis]);
    assert.equal((await read("a.pfm", cloud)).kind, "depth");
    assert.equal(
      (
        await read(
          "a.pfm",
          pfm((axis, at) => (axis + at) % 5),
        )
      ).kind,
      "colour",
    );
  });
});

describe("units", () => {
  test("of KITTI's depth maps by their names, else guessed and said to be", async () => {
    const scattered = grey16(slope(4000).map((value, at) => (at % 17 === 0 ? value : 0)));
    const reading = await read("2011_09_26/proj_depth/groundtruth/image_02/0000000005.png", scattered);
    assert.equal(reading.depth.unit, 1 / 256);
    assert.ok(!reading.warnings.some(({ code }) => code === "unit-guessed"));
    await says("unit-guessed", /guessed to be.*in 256 to the metre, as in KITTI/, "depth.png", scattered);
  });

  test("other units are offered where the values would do for several", async () => {
    const tenths = grey16(slope(60_000).map((value) => value - (value % 5) + 3));
    await says("unit-guessed", /1\.\d+ to \d\.\d+ m in tenths of a millimetre/, "depth.png", tenths);
  });
});

describe("axes of organised clouds", () => {
  const [columns, rows] = [40, 20];
  const cloud = (point) =>
    pcd(
      { WIDTH: String(columns), HEIGHT: String(rows), POINTS: String(columns * rows) },
      Array.from({ length: columns * rows }, (_, at) => point(at % columns, Math.floor(at / columns)).join(" ")).join(
        "\n",
      ),
    );
  const angles = (x, y) => [((x - 20) * Math.PI) / 90, ((y - 10) * Math.PI) / 120];

  test("a camera's, and a LiDAR's that was turned into optical axes", async () => {
    assert.equal(
      (
        await read(
          "a.pcd",
          cloud((x, y) => [(x - 20) / 10, (y - 10) / 10, 2 + x / 40]),
        )
      ).kind,
      "depth",
    );
    const optical = cloud((x, y) => {
      const [azimuth, elevation] = angles(x, y);
      return [
        5 * Math.sin(azimuth) * Math.cos(elevation),
        5 * Math.sin(elevation),
        5 * Math.cos(azimuth) * Math.cos(elevation),
      ];
    });
    assert.equal((await read("a.pcd", optical)).kind, "depth");
  });

  test("z that looks up, rows upside down, columns mirrored", async () => {
    const lidar = cloud((x, y) => {
      const [azimuth, elevation] = [angles(x, y)[0], ((rows - y) * Math.PI) / 120];
      return [
        5 * Math.cos(azimuth) * Math.cos(elevation),
        -5 * Math.sin(azimuth) * Math.cos(elevation),
        5 * Math.sin(elevation),
      ];
    });
    const { depth, warnings } = await read("a.pcd", lidar);
    assert.ok(warnings.some(({ code }) => code === "lidar-axes"));
    assert.ok(Math.abs(depth.points[3 * 20] - 5 * Math.cos(Math.PI / 6)) < 1e-3);
    await refused(
      "a.pcd",
      cloud((x, y) => [(x - 20) / 10, (10 - y) / 10, 2]),
      /do not follow a camera's axes/,
    );
    await refused(
      "a.pcd",
      cloud((x, y) => [(20 - x) / 10, (y - 10) / 10, 2]),
      /do not follow a camera's axes/,
    );
  });
});
