// Disparities and inverse depths, which are larger for nearer surfaces, are read as depths with the option `inverse`. 16-bit masks are
// not depths.
import assert from "node:assert/strict";
import { test } from "node:test";
import { close, codes, metres, read, refusedFile } from "./rig-support.mjs";
import { BimodalError, npy, png } from "./support.mjs";

const [WIDTH, HEIGHT] = [40, 30];
const pixels = (value) => Array.from({ length: WIDTH * HEIGHT }, (_, at) => value(at % WIDTH, Math.floor(at / WIDTH)));
/** Depths of a slope, metres, with holes in every fifth column. */
const depths = pixels((x, y) => (x % 5 === 0 ? 0 : 0.5 + 0.01 * x + 0.02 * y));
const grey16 = (values) =>
  png({
    width: WIDTH,
    height: HEIGHT,
    depth: 16,
    colourType: 0,
    rows: Array.from({ length: HEIGHT }, (_, y) =>
      values.slice(y * WIDTH, (y + 1) * WIDTH).flatMap((value) => [value >> 8, value & 255]),
    ),
  });
/** Focal length times baseline, pixels times metres. */
const NUMERATOR = 600 * 0.05;
const disparities = depths.map((z) => (z > 0 ? NUMERATOR / z : 0));
const inFile = grey16(disparities.map((value) => Math.round(256 * value)));

test("disparities become metres by focal length times baseline, and holes stay holes", async () => {
  const reading = await read("disp.png", inFile, { as: "depth", inverse: { numerator: 256 * NUMERATOR } });
  // The rounding error, half a level of disparity, corresponds to z^2 / (2 * 7680) metres.
  close(metres(reading), depths, 1.5 ** 2 / (2 * 7680));
  assert.deepEqual(reading.guessed, []);
  assert.equal(reading.depth.unit, 1);
  assert.match(reading.says, /16-bit, read as metres: 7680 \/ stored number/);
  // Without the option the name is refused, and the error names the remedy for programs.
  await refusedFile(read("disp.png", inFile), "disp.png", /the option `inverse`/);
  await assert.rejects(read("disp.png", inFile), ({ details }) => details.problem === "disparity");
  // The option makes the file a depth map, whatever its name.
  assert.equal((await read("x.png", inFile, { inverse: { numerator: 7680 } })).kind, "depth");
});

test("an offset is added to each stored number, as Middlebury's doffs", async () => {
  const offset = 12.5;
  const stored = Float32Array.from(disparities, (value) => (value > 0 ? value - offset : Infinity));
  const bytes = npy({ descr: "<f4", shape: [HEIGHT, WIDTH], data: stored });
  const reading = await read("d.npy", bytes, { inverse: { numerator: NUMERATOR, offset } });
  close(metres(reading), depths, 1e-5);
});

test("without the factor the median depth is the longer side of the map, and that is a doubt", async () => {
  const reading = await read("d.png", inFile, { inverse: {} });
  const found = metres(reading).filter((value) => value > 0);
  assert.ok(Math.abs([...found].sort((a, b) => a - b)[found.length >> 1] / WIDTH - 1) < 0.01);
  // All depths are right up to a common factor.
  const ratios = metres(reading).flatMap((value, at) => (value > 0 ? [value / depths[at]] : []));
  assert.ok(Math.max(...ratios) / Math.min(...ratios) < 1.001);
  assert.deepEqual(reading.guessed, ["unit"]);
  const doubt = reading.warnings.find(({ code }) => code === "unit-guessed");
  assert.ok(doubt.isDoubt);
  assert.match(doubt.message, /known up to a factor.*focal length \* baseline/);
  assert.ok(!codes(reading).includes("depth-range"));
});

test("65535 is a depth here: networks stretch their estimates to the largest number", async () => {
  const stored = depths.map((z) => (z > 0 ? Math.round((65535 * 0.51) / z) : 0)).map((v) => Math.min(v, 65535));
  const reading = await read("d.png", grey16(stored), { inverse: { numerator: 65535 * 0.51 } });
  assert.ok(metres(reading).filter((z) => z > 0).length === depths.filter((z) => z > 0).length);
});

test("what is no inverse depth is refused", async () => {
  await refusedFile(read("c.ply", cloudText, { inverse: {} }), "c.ply", /a depth, not an inverse depth/);
  const none = grey16(pixels(() => 0));
  await refusedFile(read("d.png", none, { inverse: {} }), "d.png", /no valid depth/);
  for (const [inverse, field] of [
    [{ numerator: 0 }, "options.inverse.numerator"],
    [{ numerator: NaN }, "options.inverse.numerator"],
    [{ numerator: "1" }, "options.inverse.numerator"],
    [{ offset: Infinity }, "options.inverse.offset"],
    [{ factor: 1 }, "options.inverse.factor"],
    [true, "options.inverse"],
  ])
    await assert.rejects(read("d.png", inFile, { inverse }), (error) => {
      assert.ok(error instanceof BimodalError, String(error));
      assert.equal(error.field, field, error.message);
      return true;
    });
});

const cloudText = [
  "ply",
  "format ascii 1.0",
  "obj_info num_cols 2",
  "obj_info num_rows 1",
  "element vertex 2",
  ...["x", "y", "z"].map((axis) => `property float ${axis}`),
  "end_header",
  "0 0 1",
  "0.1 0 1",
  "",
].join("\n");

test("masks of 16 bits are masks, with soft edges or of any level by their name; labels are refused", async () => {
  const inside = (x, y) => Math.hypot(x - 20, y - 15) < 9;
  const soft = (most) => pixels((x, y) => (inside(x, y) ? most : Math.hypot(x - 20, y - 15) < 9.6 ? most >> 1 : 0));
  for (const [name, values] of [
    ["a.png", pixels((x, y) => (inside(x, y) ? 65535 : 0))],
    ["a.png", pixels((x, y) => (inside(x, y) ? 255 : 0))],
    ["a.png", soft(65535)],
    ["mask.png", soft(65535)],
    ["mask.png", pixels((x, y) => (inside(x, y) ? 1000 : 0))],
    ["object_mask.png", soft(4095)],
  ])
    assert.equal((await read(name, grey16(values))).kind, "mask", name);
  // A wall at one distance and a sparse map remain depths.
  assert.equal((await read("a.png", grey16(pixels((x, y) => (inside(x, y) ? 1000 : 0))))).kind, "depth");
  assert.equal((await read("a.png", grey16(pixels((x) => (x % 30 ? 0 : 900 + x))))).kind, "depth");
  const labels = grey16(pixels((x, y) => Math.floor(x / 10) + 4 * Math.floor(y / 10)));
  await refusedFile(read("objects.png", labels), "objects.png", /labels of objects rather than depths/);
});
