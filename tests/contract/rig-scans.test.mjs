// Files of LiDARs and mapping tools, whose points are unorganised: the readings of each format, and the messages about them.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { checkCalibration } from "../../pkg/index.js";
import { rangeImage, readRigFile, readRigFolder } from "../../pkg/rig.js";
import { read, refusedFile, text } from "./rig-support.mjs";
import { OPTICAL, VIEW, shuffled, spinning, turned } from "./scanners.mjs";
import { LONG } from "./long.mjs";

const SCAN = spinning({ lasers: 16, step: 0.4 });
const COUNT = SCAN.ring.length;
const CODES = ({ warnings }) => warnings.map(({ code }) => code);
const joined = (...parts) =>
  new Uint8Array(
    Buffer.concat(parts.map((part) => Buffer.from(part.buffer ?? part, part.byteOffset, part.byteLength))),
  );

/** Floats of each point: x y z and the values of the functions. */
const interleaved = ({ points }, ...others) =>
  Float32Array.from({ length: (points.length / 3) * (3 + others.length) }, (_, at) => {
    const [point, column] = [Math.floor(at / (3 + others.length)), at % (3 + others.length)];
    return column < 3 ? points[3 * point + column] : others[column - 3](point);
  });

/** Points as lines of x y z. */
const interleavedText = ({ points }) =>
  Array.from({ length: points.length / 3 }, (_, at) => `${points.subarray(3 * at, 3 * at + 3).join(" ")}\n`).join("");

/** Checks that a reading holds these points, with one row for each laser. */
async function holds(found, how, rows = 16, count = COUNT) {
  assert.equal(found.kind, "depth");
  assert.ok(CODES(found).includes("points-sorted"), found.says);
  assert.match(found.says, how);
  assert.equal(found.depth.height, rows);
  const { points } = found.depth;
  const there = points.filter((value, at) => at % 3 === 0 && !Number.isNaN(value)).length;
  assert.ok(there >= 0.99 * count && there <= count, `${there} of ${count}`);
  assert.equal(found.scan.points.length, 3 * count);
}

const pcdHead = (fields, count, data) =>
  text(
    `# .PCD v0.7\nVERSION 0.7\nFIELDS ${fields.map(([name]) => name).join(" ")}\nSIZE ${fields.map(([, size]) => size).join(" ")}\nTYPE ${fields.map(([, , type]) => type).join(" ")}\nWIDTH ${count}\nHEIGHT 1\nPOINTS ${count}\nDATA ${data}\n`,
  );
const XYZ = ["x", "y", "z"].map((name) => [name, 4, "F"]);

describe("points in no rows and columns", () => {
  test("PCD with ring, as drivers of Velodyne and Hesai write it", async () => {
    const scan = shuffled(SCAN);
    const fields = [...XYZ, ["intensity", 4, "F"], ["ring", 2, "U"], ["timestamp", 8, "F"]];
    const body = new DataView(new ArrayBuffer(26 * COUNT));
    for (let point = 0; point < COUNT; point++) {
      for (let axis = 0; axis < 3; axis++) body.setFloat32(26 * point + 4 * axis, scan.points[3 * point + axis], true);
      body.setFloat32(26 * point + 12, point % 200, true);
      body.setUint16(26 * point + 16, scan.ring[point], true);
      body.setFloat64(26 * point + 18, 1.6e9 + 0.1 * (point / COUNT), true);
    }
    const found = await read("a.pcd", joined(pcdHead(fields, COUNT, "binary"), body));
    await holds(found, /by the file's rings/);
    assert.deepEqual([...found.scan.ring.slice(0, 5)], [...scan.ring.slice(0, 5)]);
    assert.equal(found.scan.intensity[7], 7);
    // Each point has a time; treating the scan as one moment caps the verdict.
    const timed = found.warnings.find(({ code }) => code === "point-times");
    assert.equal(timed.isDoubt, true);
    assert.ok(Math.abs(timed.span - 0.1) < 1e-3);
    assert.deepEqual(
      CODES(found).filter((code) => code === "unit-guessed"),
      [],
    );
  });

  test("PCD as text without ring, in any order", async () => {
    const scan = shuffled(SCAN);
    const lines = Array.from(
      { length: COUNT },
      (_, at) => `${[...scan.points.subarray(3 * at, 3 * at + 3)].join(" ")} 3`,
    );
    const bytes = joined(pcdHead([...XYZ, ["intensity", 4, "F"]], COUNT, "ascii"), text(`${lines.join("\n")}\n`));
    await holds(await read("a.pcd", bytes), /by clusters of elevations/);
  });

  test("PLY of CloudCompare, with its own names", async () => {
    const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${COUNT}\n${["x", "y", "z", "scalar_Ring", "scalar_Intensity"].map((name) => `property float ${name}\n`).join("")}end_header\n`;
    const body = interleaved(
      SCAN,
      (point) => SCAN.ring[point],
      () => 0.5,
    );
    const found = await read("a.ply", joined(text(head), body));
    await holds(found, /by the file's rings/);
    assert.equal(found.scan.intensity[3], 0.5);
  });

  test("KITTI's four floats, without a header", async () => {
    const kitti = interleaved(SCAN, (point) => (point % 100) / 100);
    await holds(await read("velodyne/000000.bin", joined(kitti)), /4 floats to a point.*KITTI/);
  });

  test("nuScenes' five floats, the last of them the ring", async () => {
    const scan = shuffled(SCAN);
    const bytes = joined(
      interleaved(
        scan,
        (point) => point % 256,
        (point) => scan.ring[point],
      ),
    );
    const found = await read("LIDAR_TOP__1532402927647951.pcd.bin", bytes);
    await holds(found, /by the file's rings.*5 floats to a point.*nuScenes/);
  });

  test("a point's intensity ends in its pixel, sorted or organised, and an empty pixel has none", async () => {
    const scan = shuffled(SCAN);
    const of = (points, point) => Math.fround(128 + 9 * points[3 * point] + 4 * points[3 * point + 1]);
    const strengths = Float32Array.from({ length: COUNT }, (_, point) => of(scan.points, point));
    const sorted = interleaved(
      scan,
      (point) => strengths[point],
      (point) => scan.ring[point],
    );
    // An organised cloud of 20 columns and 12 rows in front of a camera, whose first cell has no point.
    const [width, height] = [20, 12];
    const points = Float32Array.from({ length: 3 * width * height }, (_, at) =>
      at < 3 ? NaN : [((at / 3) % width) / 9, at / 999, 2][at % 3],
    );
    const body = interleaved({ points }, (point) => of(points, point));
    const grid = pcdHead([...XYZ, ["intensity", 4, "F"]], width * height, "binary");
    const sized = new TextDecoder().decode(grid).replace(/WIDTH .*\nHEIGHT 1/, `WIDTH ${width}\nHEIGHT ${height}`);
    const head = `ply\nformat binary_little_endian 1.0\ncomment width ${width}\ncomment height ${height}\nelement vertex ${width * height}\n${["x", "y", "z", "intensity"].map((name) => `property float ${name}\n`).join("")}end_header\n`;
    for (const [name, bytes] of [
      ["LIDAR_TOP__1.pcd.bin", joined(sorted)],
      ["a.pcd", joined(text(sized), body)],
      ["a.ply", joined(text(head), body)],
    ]) {
      const { depth } = await read(name, bytes);
      assert.equal(depth.intensity?.length, depth.width * depth.height, name);
      let count = 0;
      for (const [pixel, strength] of depth.intensity.entries()) {
        if (Number.isNaN(depth.points[3 * pixel])) {
          assert.ok(Number.isNaN(strength), name);
          continue;
        }
        count++;
        assert.ok(Math.abs(strength - of(depth.points, pixel)) < 1e-3, `${name}: pixel ${pixel}`);
      }
      assert.ok(count > 200, name);
    }
    assert.equal((await read("a.xyz", interleavedText(SCAN))).depth.intensity, undefined);
  });

  test("LAS, with the time of each pulse; a damaged LAZ is named, and how to unpack it", async () => {
    const las = new DataView(new ArrayBuffer(227 + 28 * COUNT));
    [..."LASF"].forEach((letter, at) => las.setUint8(at, letter.charCodeAt(0)));
    las.setUint8(24, 1);
    las.setUint8(25, 2);
    las.setUint16(94, 227, true);
    las.setUint32(96, 227, true);
    las.setUint8(104, 1);
    las.setUint16(105, 28, true);
    las.setUint32(107, COUNT, true);
    for (let axis = 0; axis < 3; axis++) las.setFloat64(131 + 8 * axis, 0.0001, true);
    for (let axis = 0; axis < 3; axis++) las.setFloat64(155 + 8 * axis, axis, true);
    for (let point = 0; point < COUNT; point++) {
      const at = 227 + 28 * point;
      for (let axis = 0; axis < 3; axis++)
        las.setInt32(at + 4 * axis, Math.round((SCAN.points[3 * point + axis] - axis) / 0.0001), true);
      las.setUint16(at + 12, 77, true);
      las.setFloat64(at + 20, point / 1e5, true);
    }
    const bytes = joined(las);
    const found = await read("a.las", bytes);
    await holds(found, /by the turns in the order/);
    assert.equal(found.scan.intensity[0], 77);
    assert.ok(CODES(found).includes("point-times"));
    las.setUint8(104, 0x81);
    await refusedFile(read("a.laz", joined(las)), "a.laz", /LAZ.*unpack it.*las/);
    await refusedFile(read("a.las", bytes.slice(0, 5000)), "a.las", /cut off/);
  });

  test("lists as text and as .npy", async () => {
    const lines = Array.from({ length: COUNT }, (_, at) => [...SCAN.points.subarray(3 * at, 3 * at + 3), 9].join(" "));
    await holds(await read("a.xyz", lines.join("\n")), /by the turns in the order/);
    const named = await read("a.csv", `X,Y,Z,Intensity\n${lines.join("\n").replaceAll(" ", ",")}`);
    await holds(named, /by the turns in the order/);
    assert.equal(named.scan.intensity[1], 9);
    const head = `{'descr': '<f4', 'fortran_order': False, 'shape': (${COUNT}, 4), }`.padEnd(117);
    const npy = joined(
      new Uint8Array([0x93, 78, 85, 77, 80, 89, 1, 0, 118, 0]),
      text(`${head}\n`),
      interleaved(SCAN, () => 0.5),
    );
    await holds(await read("a.npy", npy), /by the turns in the order/);
  });

  test("a map's coordinates are no sensor's", async () => {
    const lines = Array.from({ length: 400 }, (_, at) =>
      [500_000 + (at % 20), 4_600_000 + at / 20, 120 + at / 100].join(" "),
    );
    await refusedFile(read("a.xyz", lines.join("\n")), "a.xyz", /map.*sensor/);
  });

  test("millimetres are told by distances that no LiDAR has", async () => {
    const scan = turned(SCAN, OPTICAL);
    const lines = Array.from({ length: COUNT }, (_, at) =>
      [...scan.points.subarray(3 * at, 3 * at + 3)].map((value) => 1000 * value).join(" "),
    );
    const found = await read("a.xyz", lines.join("\n"));
    assert.ok(found.measured.range[1] < 20);
    assert.ok(CODES(found).includes("unit-guessed"));
  });
});

describe("scans in a folder and a check", () => {
  /** A picture of the room whose brightness follows the distances, so that it has the same steps. */
  async function picture() {
    const { cast } = await import("./scanners.mjs");
    const { rotation, translation, camera, width, height } = VIEW;
    const centre = [0, 1, 2].map(
      (axis) => -[0, 1, 2].reduce((sum, row) => sum + rotation[3 * row + axis] * translation[row], 0),
    );
    const lines = Buffer.alloc(3 * width * height);
    for (let pixel = 0; pixel < width * height; pixel++) {
      const ray = [((pixel % width) - camera.cx) / camera.fx, (Math.floor(pixel / width) - camera.cy) / camera.fy, 1];
      const along = [0, 1, 2].map((axis) => ray.reduce((sum, value, row) => sum + rotation[3 * row + axis] * value, 0));
      lines.fill(Math.round(255 / (0.6 + 0.25 * cast(centre, along))), 3 * pixel, 3 * pixel + 3);
    }
    return joined(text(`P6\n${width} ${height}\n255\n`), lines);
  }
  const kitti = () => joined(interleaved(spinning({ lasers: 64 }), () => 0.5));

  test("a scan and a picture of like names are a frame, in the scan's own axes", async () => {
    const folder = await readRigFolder([
      { name: "image_2/000000.ppm", bytes: await picture() },
      { name: "velodyne/000000.bin", bytes: kitti() },
    ]);
    assert.equal(folder.frames.length, 1);
    const [{ depth, image }] = folder.frames;
    assert.deepEqual([image.width, depth.height], [VIEW.width, 64]);
    assert.ok(CODES(folder).includes("points-sorted"));
  });

  test("a pose for a cloud in a camera's axes is turned to those of the scan, and one for the scan's is kept", async () => {
    const { rotation: r, translation: t } = VIEW;
    const matrix = (rows) =>
      [0, 1, 2].map((row) => [...rows.slice(3 * row, 3 * row + 3), t[row]]).concat([[0, 0, 0, 1]]);
    const scan = [
      { name: "image_2/000000.ppm", bytes: await picture() },
      { name: "velodyne/000000.bin", bytes: kitti() },
    ];
    for (const [rows, isTurned] of [
      [[1, 0, 0, 0, 1, 0, 0, 0, 1], true],
      [r, false],
    ]) {
      const pose = { name: "rig.json", bytes: text(JSON.stringify({ depth_to_color: matrix(rows) })) };
      const { poses, warnings } = await readRigFolder([...scan, pose]);
      assert.deepEqual([...poses[0].pose.rotation.map((value) => value + 0)], r);
      assert.deepEqual([...poses[0].pose.translation], t);
      const said = warnings.filter(({ code }) => code === "pose-turned");
      assert.deepEqual(
        said.map(({ isDoubt }) => isDoubt),
        isTurned ? [true] : [],
      );
    }
  });

  test("what several calibrations have in common is said once, and an inertial sensor's pose is left out", async () => {
    const rows = [
      [1, 0, 0, 0.1],
      [0, 1, 0, 0],
      [0, 0, 1, 0],
      [0, 0, 0, 1],
    ];
    const pose = (name) => ({ name, bytes: text(JSON.stringify({ depth_to_color: rows })) });
    const line = (name, rows) => `${name}: ${rows}\n`;
    const kittiText = [
      line("P2", "500 0 160 0 0 500 120 0 0 0 1 0"),
      line("R0_rect", "1 0 0 0 1 0 0 0 1"),
      line("Tr_velo_to_cam", "0 -1 0 0.1 0 0 -1 0 1 0 0 0"),
      line("Tr_imu_to_velo", "1 0 0 0.1 0 1 0 0 0 0 1 0"),
    ].join("");
    const { poses, warnings } = await readRigFolder([
      { name: "image_2/000000.ppm", bytes: await picture() },
      { name: "velodyne/000000.bin", bytes: kitti() },
      { name: "calib/000000.txt", bytes: text(kittiText) },
      ...["a.json", "b.json"].map(pose),
    ]);
    assert.equal(warnings.filter(({ code }) => code === "pose-turned").length, 1);
    assert.equal(poses.length, 3);
    assert.ok(poses.every(({ from = "", to = "" }) => ![from, to].includes("imu")));
    const [left] = warnings.filter(({ code }) => code === "pose-left-out");
    assert.match(left.message, /imu to velodyne/);
    assert.equal(left.isDoubt, false);
  });

  test(
    "the true pose of a scan is not off, in its own axes, turned to a camera's and cut to the view alike",
    LONG,
    async () => {
      const { image } = await readRigFile({ name: "a.ppm", bytes: await picture() }, { as: "colour" });
      image.camera = VIEW.camera;
      const { depth, scan } = await readRigFile({ name: "a.bin", bytes: kitti() });
      const { rotation, translation } = VIEW;
      const optical = { rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation };
      const cut = await rangeImage(scan, VIEW);
      const size = ({ width, height }) => ({ width, height });
      const reports = [];
      for (const [given, pose] of [
        [depth, { rotation, translation }],
        [
          { ...size(cut), points: cut.points },
          { rotation, translation },
        ],
        [{ ...size(cut), points: turned(cut, OPTICAL).points }, optical],
      ]) {
        const { candidates, warnings, estimate } = await checkCalibration([{ image, depth: given }], { pose });
        assert.ok(!warnings.some(({ code }) => code === "unusual-depths"));
        assert.notEqual(candidates.pose.verdict, "off", candidates.pose.reason);
        reports.push({ off: candidates.pose, estimate });
      }
      const [whole, own, turnedOnes] = reports;
      // Swapping axes only changes the order of sums, which moves the estimate by a small share of its uncertainty.
      assert.ok(Math.abs(own.off.offDegrees - turnedOnes.off.offDegrees) < 1e-3);
      assert.ok(Math.abs(own.off.pixels - turnedOnes.off.pixels) < 0.003 * own.off.pixels);
      for (const at of [0, 1, 2])
        assert.ok(Math.abs(own.estimate.translation[at] - turnedOnes.estimate.translation[at]) < 1e-4);
      assert.ok(whole.off.offDegrees < 2, whole.off.reason);
    },
  );
});
