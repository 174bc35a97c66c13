// Points as tables with names of columns, as viewers of LiDARs export them: the columns of the coordinates, and their unit.
import assert from "node:assert/strict";
import { test } from "node:test";
import { close, read, refusedFile } from "./rig-support.mjs";
import { spinning } from "./scanners.mjs";

const SCAN = spinning({ lasers: 16, step: 0.4 });
const COUNT = SCAN.ring.length;

/** A table whose columns are functions of a point's index, or one axis of the points in this unit. */
function table(columns, { unit = 1, separator = ",", quote = "", count = COUNT } = {}) {
  const cell = (of, point) => (typeof of === "number" ? (SCAN.points[3 * point + of] / unit).toFixed(4) : of(point));
  const names = Object.keys(columns).map((name) => quote + name + quote);
  const rows = Array.from({ length: count }, (_, point) =>
    Object.values(columns)
      .map((of) => cell(of, point))
      .join(separator),
  );
  return [names.join(separator), ...rows, ""].join("\n");
}
const ring = (point) => SCAN.ring[point];
const tens = (point) => 10 * point;
const always = (value) => () => value;
const intensity = (point) => point % 97;
const codes = ({ warnings }) => warnings.map(({ code }) => code);
/** All points are there, in metres, whichever column they are in. */
const holds = (found, tolerance = 1e-4) => close([...found.scan.points], [...SCAN.points], tolerance);

test("VeloView's and LidarView's columns of an array are x, y and z, wherever they stand", async () => {
  const others = {
    intensity,
    laser_id: ring,
    azimuth: (point) => point % 36000,
    timestamp: (point) => 3600000 + point,
  };
  for (const prefix of ["Points_m_XYZ:", "Points:", "Points_"]) {
    const axes = { [`${prefix}0`]: 0, [`${prefix}1`]: 1, [`${prefix}2`]: 2 };
    for (const columns of [
      { ...axes, ...others },
      { ...others, ...axes },
    ]) {
      const found = await read("frame.csv", table(columns, { quote: '"' }));
      holds(found);
      assert.deepEqual([...found.scan.ring.slice(0, 40)], [...SCAN.ring.slice(0, 40)]);
      assert.deepEqual([...found.scan.intensity.slice(0, 3)], [0, 1, 2]);
      assert.ok(codes(found).includes("point-times"));
      assert.ok(!codes(found).includes("unit-guessed"));
    }
  }
});

test("a Livox viewer's columns, with flags in hexadecimal; a unit that is not named is a doubt", async () => {
  const head = {
    Version: always(5),
    "Slot ID": always(1),
    "Error Code": always("0x00000000"),
    Timestamp: tens,
  };
  const tail = { Reflectivity: intensity, Tag: always("0x10"), Ori_x: always(0), Ori_y: always(0), Ori_z: always(0) };
  for (const [unit, words] of [
    [1, /metres;/],
    [0.001, /millimetres;/],
  ])
    for (const names of ["XYZ", "ZXY"]) {
      const axes = Object.fromEntries([...names].map((name) => [name, "XYZ".indexOf(name)]));
      const found = await read("livox.csv", table({ ...head, ...axes, ...tail }, { unit }));
      holds(found);
      const doubt = found.warnings.find(({ code }) => code === "unit-guessed");
      assert.ok(doubt?.isDoubt && words.test(doubt.message), JSON.stringify(found.warnings));
    }
});

test("the unit of a column's name counts, whatever the distances", async () => {
  for (const [name, unit] of [
    ["X [mm]", 0.001],
    ["x(cm)", 0.01],
    ["x_m", 1],
  ]) {
    const named = (axis) => name.replace(/x/i, axis);
    const columns = { intensity, [named("z")]: 2, [named("x")]: 0, [named("y")]: 1 };
    const found = await read("named.csv", table(columns, { unit, separator: ";" }));
    holds(found);
    assert.ok(!codes(found).includes("unit-guessed"), name);
  }
  // Names that contradict each other do not determine the unit.
  const mixed = await read("mixed.csv", table({ "x(m)": 0, "y(mm)": 1, "z(m)": 2 }));
  assert.ok(codes(mixed).includes("unit-guessed"));
});

test("tables have as many points as other clouds", async () => {
  const many = table({ x: 0, y: 1, z: 2, intensity });
  const [names, ...rows] = many.trim().split("\n");
  const times = Math.ceil(25_000 / rows.length);
  const found = await read("many.csv", `${[names, ...Array(times).fill(rows).flat()].join("\n")}\n`);
  assert.equal(found.scan.points.length, 3 * times * rows.length);
});

test("poses over time are no points, and neither are a few rows or rows without a coordinate", async () => {
  const poses = { timestamp: (point) => point, x: 0, y: 1, z: 2, qx: () => 0, qy: () => 0, qz: () => 0, qw: () => 1 };
  const found = await read("trajectory.csv", table(poses, { count: 30 }));
  assert.equal(found.kind, "poses");
  await refusedFile(
    read("few.csv", table({ x: 0, y: 1, z: 2, intensity }, { count: 100 })),
    "few.csv",
    /at least 200 points/,
  );
  const broken = table({ x: 0, y: 1, z: 2, intensity }).split("\n");
  broken[300] = "1.5";
  await refusedFile(read("broken.csv", broken.join("\n")), "broken.csv", /no x, y and z in line 300/);
});
