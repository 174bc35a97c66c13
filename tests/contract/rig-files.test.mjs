// Pictures, depth maps and clouds of a rig as other programs write them, and the descriptions of what was read.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { readRigFile, readRigFolder } from "../../pkg/rig.js";
import { npy, png } from "./support.mjs";
import {
  H,
  W,
  close,
  colours,
  fixture,
  metres,
  millimetres,
  read,
  readFixture,
  refusedFile,
  rgb,
  text,
} from "./rig-support.mjs";

const GREY = 0,
  RGB = 2;
const words = (...values) => values.flatMap((value) => [value >> 8, value & 255]);
/** A 16-bit PNG with one row for each list. */
const depthPng = (rows) =>
  png({
    width: rows[0].length,
    height: rows.length,
    depth: 16,
    colourType: GREY,
    rows: rows.map((row) => words(...row)),
  });
const expected = millimetres.map((value) => value / 1000);
/** Columns of the EXR files named "large". */
const LARGE = 64;
const large = (value) => Array.from({ length: 48 * LARGE }, (_, at) => value(at % LARGE, Math.floor(at / LARGE)));

describe("depth maps", () => {
  const files = [
    ...["depth-cv.png", "depth-cv.pfm", "depth-cv.pgm", "depth-cv.tiff", "depth-columns.npy"],
    ...["16-None", "16-lzw", "16-zlib", "16-packbits", "float-None", "float-lzw", "float-zlib", "float-packbits"].map(
      (name) => `depth-${name}.tif`,
    ),
    ...["16-predicted", "float-predicted", "64-predicted", "big-endian", "big-endian-float", "tiled", "strips"].map(
      (name) => `depth-${name}.tif`,
    ),
    ...["zstd", "zstd-predicted", "lerc", "lerc-deflate", "lerc-zstd", "bigtiff", "bigtiff-lzw"].map(
      (name) => `depth-${name}.tif`,
    ),
    ...["none", "rle", "zips", "zip", "piz"].map((name) => `depth-${name}.exr`),
    ...["ascii", "binary", "compressed"].map((name) => `cloud-${name}.pcd`),
    ...["cloud-ascii.ply", "cloud-binary.ply", "cloud-columns.npy"],
  ];
  for (const name of files) {
    test(name, async () => {
      const reading = await readFixture(name);
      assert.equal(reading.kind, "depth");
      assert.deepEqual([reading.depth.width, reading.depth.height], [W, H]);
      close(metres(reading), expected, 1e-6, name);
      assert.match(reading.says, /^16x12, .*, 85\.9 % valid, 0\.81 to 1\.48 m$/);
      assert.deepEqual(reading.guessed, ["unit"]);
    });
  }

  test("a TIFF of 16-bit floats", async () => {
    const reading = await readFixture("depth-half.tif");
    assert.match(reading.says, /^16x12, 16-bit float, read as metres/);
    close(metres(reading), expected, 0.0005);
  });

  // The picture is so large that compression shortens some blocks. Half floats hold these depths exactly.
  for (const name of ["piz-half", "piz-float", "piz-colours", "pxr24-float", "pxr24-mixed", "dwaa-depth"]) {
    test(`large-${name}.exr`, async () => {
      const reading = await readFixture(`large-${name}.exr`, { as: "depth" });
      assert.deepEqual([reading.depth.width, reading.depth.height], [LARGE, 48]);
      close(
        metres(reading),
        large((x, y) => ((x + y) % 7 === 0 ? 0 : 0.75 + x / 64 + y / 128)),
        0,
        name,
      );
    });
  }

  test("large-b44.exr, by which the blocks with holes are coarse: a warning", async () => {
    const reading = await readFixture("large-b44.exr");
    assert.ok(reading.warnings.some(({ code, message }) => code === "eight-bits" && /lossy compression/.test(message)));
    const wanted = large((x, y) => ((x + y) % 7 === 0 ? 0 : 0.75 + x / 64 + y / 128));
    close(metres(reading), wanted, 0.12);
    assert.match(reading.says, /85\.\d % valid/);
  });

  test("a cloud keeps x and y, too", async () => {
    for (const name of ["cloud-compressed.pcd", "cloud-binary.ply", "cloud-columns.npy"]) {
      const { points } = (await readFixture(name)).depth;
      const at = 3 * (5 * W + 3);
      close([...points.slice(at, at + 3)], [((3 - 7.5) / 20) * 0.966, ((5 - 5.5) / 20) * 0.966, 0.966], 1e-6, name);
      assert.ok(Number.isNaN(points[0]) && Number.isNaN(points[1]) && Number.isNaN(points[2]));
    }
  });

  test("LZW whose table fills up and is cleared", async () => {
    const { depth } = await readFixture("noise.tif", { as: "depth", unit: 1 });
    const { sum, last, middle } = JSON.parse(new TextDecoder().decode(fixture("noise.json")));
    assert.deepEqual(
      [depth.data.reduce((a, b) => a + b, 0), depth.data.at(-1), depth.data[40 * 80 + 40]],
      [sum, last, middle],
    );
  });

  test("a Stanford range grid in PLY", async () => {
    const body =
      "ply\nformat ascii 1.0\nobj_info num_cols 2\nobj_info num_rows 2\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement range_grid 4\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n4 5 6\n7 8 9\n1 0\n0\n1 1\n1 2\n";
    assert.deepEqual(metres(await read("grid.ply", body)), [3, 0, 6, 9]);
  });

  test("PFM of either order of bytes, PGM as text and of low byte first", async () => {
    const floats = (little) => {
      const view = new DataView(new ArrayBuffer(8));
      [1.5, 2.5].forEach((value, at) => view.setFloat32(4 * at, value, little));
      return new Uint8Array([...text(`Pf\n1 2\n${little ? -1 : 1}\n`), ...new Uint8Array(view.buffer)]);
    };
    for (const little of [true, false]) assert.deepEqual(metres(await read("a.pfm", floats(little))), [2.5, 1.5]);
    assert.deepEqual(
      [...(await read("a.pgm", "P2 # grey\n2 2 # size\n65535\n1000 2000\n0 3000\n")).depth.data],
      [1000, 2000, 0, 3000],
    );
    const levels = Array.from({ length: 64 }, (_, at) => 1000 + 3 * at);
    const swapped = new Uint8Array([
      ...text("P5\n8 8\n65535\n"),
      ...levels.flatMap((level) => [level & 255, level >> 8]),
    ]);
    const reading = await read("a.pgm", swapped);
    assert.deepEqual([...reading.depth.data], levels);
    assert.ok(reading.warnings.some(({ code }) => code === "bytes-swapped"));
  });

  test("what browsers must not see: 16 bits to the last", async () => {
    const { depth } = await read("depth.png", depthPng([[1, 258, 1001, 2]]), { unit: 0.001 });
    assert.deepEqual([...depth.data], [1, 258, 1001, 2]);
  });
});

describe("units", () => {
  const row = (from, step, count = 80) => [Array.from({ length: count }, (_, at) => from + step * at)];
  const unitOf = async (rows, options) => (await read("depth.png", depthPng(rows), options)).depth.unit;

  test("millimetres, TUM's fifths, and SUN's turned bits are told apart", async () => {
    assert.equal(await unitOf(row(812, 7)), 0.001);
    assert.equal(await unitOf(row(5000, 35)), 0.0002);
    assert.equal(await unitOf(row(12_001, 37)), 0.0002);
    const truth = row(1500, 7)[0];
    const sun = await read("depth.png", depthPng([truth.map((value) => ((value << 3) | (value >> 13)) & 0xffff)]));
    assert.deepEqual([...sun.depth.data], truth);
    assert.equal(sun.depth.unit, 0.001);
    assert.match(sun.says, /SUN RGB-D/);
  });

  test("what is told is believed, and is no guess", async () => {
    const reading = await read("depth.png", depthPng(row(5000, 35)), { unit: 0.001 });
    assert.equal(reading.depth.unit, 0.001);
    assert.deepEqual(reading.guessed, []);
    assert.ok(!reading.warnings.some(({ code }) => code === "unit-guessed"));
  });

  test("floats: metres, or millimetres where metres would be too far", async () => {
    const unit = async (values) =>
      (await read("d.npy", npy({ descr: "<f4", shape: [1, values.length], data: new Float32Array(values) }))).depth
        .unit;
    assert.equal(await unit([0.5, 2, 7]), 1);
    assert.equal(await unit([500, 2000, 7000]), 0.001);
    const rendered = await read(
      "d.npy",
      npy({ descr: "<f4", shape: [1, 4], data: new Float32Array([1, 2, 1e10, Infinity]) }),
    );
    assert.match(rendered.says, /50.0 % valid, 1.00 to 2.00 m/);
  });
});

describe("what looks wrong is said", () => {
  const warned = async (bytes, code, pattern, options, name = "file.png") => {
    const { warnings } = await read(name, bytes, options);
    const found = warnings.find((warning) => warning.code === code);
    assert.match(found?.message ?? "", pattern, `${code} in ${JSON.stringify(warnings)}`);
  };
  const grey8 = png({ width: 4, height: 1, depth: 8, colourType: GREY, rows: [[10, 20, 30, 40]] });

  test("8 bits, a guessed unit, depths out of range, holes, disparity, saturation", async () => {
    await warned(grey8, "eight-bits", /too coarse/, { as: "depth" });
    await warned(depthPng([[1000, 2000]]), "unit-guessed", /guessed to be millimetres/, { as: "depth" });
    await warned(depthPng([[1000, 2000]]), "depth-range", /outside 0.1 to 20 m/, { as: "depth", unit: 1 });
    await warned(depthPng([[1000, 0, 0]]), "many-holes", /^67 % of the depth map is missing/, { as: "depth" });
    await warned(depthPng([[600, 700, 2047, 2047]]), "raw-disparity", /2047/, { as: "depth" });
    assert.match((await read("d.png", depthPng([[1000, 65_535]]))).says, /50.0 % valid.*65535 treated as holes/);
  });

  test("files in each other's place", async () => {
    await warned(depthPng([[1000, 2000]]), "files-swapped", /looks like a depth map/, { as: "colour" });
    const coloured = png({ width: 1, height: 1, depth: 8, colourType: RGB, rows: [[1, 2, 3]] });
    await refusedFile(
      read("rgb.png", coloured, { as: "depth" }),
      "rgb.png",
      /colour picture where a depth map .* swapped/,
    );
    await refusedFile(
      read("K.txt", "500 0 320\n0 500 240\n0 0 1\n", { as: "depth" }),
      "K.txt",
      /a text where a depth map/,
    );
    await refusedFile(read("a.png", coloured, { as: "cameras" }), "a.png", /a picture \(PNG\) where cameras/);
  });

  test("by content: masks, grey pictures, depth; names where either would do", async () => {
    const mask = png({ width: 10, height: 1, depth: 1, colourType: GREY, rows: [[0b10000001, 0b01000000]] });
    assert.equal((await read("x.png", mask)).kind, "mask");
    // Drawn masks have soft edges; a name with "mask" makes them masks nevertheless.
    const soft = png({ width: 4, height: 1, depth: 8, colourType: GREY, rows: [[0, 96, 255, 254]] });
    assert.equal((await read("cup-mask.png", soft)).kind, "mask");
    assert.equal((await read("x.png", soft)).kind, "colour");
    assert.equal((await read("x.png", grey8)).kind, "colour");
    assert.equal((await read("depth/1.png", grey8)).kind, "depth");
    assert.equal((await read("x.png", depthPng([[1000, 2000]]))).kind, "depth");
    assert.equal((await read("rgb/1.png", depthPng([[1000, 2000]]))).kind, "colour");
  });

  test("options are checked", async () => {
    await assert.rejects(readRigFile({ name: "a", bytes: grey8 }, { unit: -1 }), {
      code: "option",
      field: "options.unit",
    });
    await assert.rejects(readRigFile({ name: "a", bytes: grey8 }, { as: "cloud" }), {
      code: "option",
      field: "options.as",
    });
    await assert.rejects(readRigFile({ name: "a", bytes: grey8 }, { units: 1 }), {
      code: "option",
      field: "options.units",
      message: /did you mean "unit"/,
    });
    await assert.rejects(readRigFolder([{ name: "a", bytes: grey8 }], { frame: 3 }), {
      code: "option",
      field: "options.frame",
      message: /did you mean "frames"/,
    });
    await assert.rejects(readRigFolder([{ name: "a", bytes: grey8 }], { unit: -1 }), {
      code: "option",
      field: "options.unit",
    });
    await assert.rejects(readRigFile({ name: "a" }), { code: "type" });
  });
});

describe("colour images", () => {
  test("PPM, TIFF, 16-bit PNG: to the bit", async () => {
    for (const name of ["colour-cv.ppm", "colour.tif"]) assert.deepEqual(colours(await readFixture(name)), rgb, name);
    const deep = await readFixture("colour-cv16.png");
    assert.deepEqual(
      colours(deep),
      rgb.map((colour) => colour.map((value) => 257 * value)),
    );
    assert.match(deep.says, /^16x12, 16-bit RGB/);
  });

  test("a TIFF that keeps its channels apart", async () => {
    assert.deepEqual(colours(await readFixture("colour-planes.tif")), rgb);
  });

  for (const [name, tolerance] of [
    ["piz-colours", 0],
    ["pxr24-mixed", 0],
    // The compression is lossy, so the tolerance is the error of OpenEXR's own reader.
    ["dwaa-colours", 0.004],
    ["dwab-colours", 0.004],
  ]) {
    test(`large-${name}.exr`, async () => {
      const { image } = await readFixture(`large-${name}.exr`, { as: "colour" });
      close([...image.data], large((x, y) => [x / 64, y / 64, (x + y) / 128]).flat(), tolerance, name);
    });
  }

  test("EXR is linear; its depth is there for who asks", async () => {
    const { image } = await readFixture("colour-and-depth.exr");
    close(
      [...image.data],
      rgb.flat().map((value) => value / 255),
      5e-4,
    );
    close(metres(await readFixture("colour-and-depth.exr", { as: "depth" })), expected, 1e-6);
  });

  test("JPEG: baseline, progressive, grey", async () => {
    close(colours(await readFixture("colour.jpg")).flat(), rgb.flat(), 12);
    // The chroma has half the resolution.
    close(colours(await readFixture("colour-progressive.jpg")).flat(), rgb.flat(), 40);
    const grey = colours(await readFixture("colour-grey.jpg"));
    close(
      grey.map(([red]) => red),
      rgb.map(([r, g, b]) => 0.299 * r + 0.587 * g + 0.114 * b),
      6,
    );
  });

  test("upright as EXIF says, which is said", async () => {
    const turned = {
      1: (x, y) => [x, y],
      2: (x, y) => [W - 1 - x, y],
      3: (x, y) => [W - 1 - x, H - 1 - y],
      4: (x, y) => [x, H - 1 - y],
      5: (x, y) => [y, x],
      6: (x, y) => [y, H - 1 - x],
      7: (x, y) => [W - 1 - y, H - 1 - x],
      8: (x, y) => [W - 1 - y, x],
    };
    for (const [orientation, from] of Object.entries(turned)) {
      for (const extension of orientation === "6" ? ["png", "tiff", "jpg"] : ["png"]) {
        const reading = await readFixture(`turned-${orientation}.${extension}`);
        const { width, height } = reading.image;
        assert.deepEqual([width, height], orientation >= 5 ? [H, W] : [W, H]);
        const found = colours(reading);
        for (let at = 0; at < found.length; at++) {
          const [x, y] = from(at % width, Math.floor(at / width));
          // JPEG rounds; the other formats must be exact.
          close(found[at], rgb[y * W + x], extension === "jpg" ? 5 : 0, `${orientation} at ${at}`);
        }
        assert.equal(reading.warnings.length, orientation === "1" ? 0 : 1);
      }
    }
  });

  test("colour profiles are brought to sRGB, as Little CMS does it", async () => {
    const truth = colours(await readFixture("colour-wide-by-lcms.png")).flat();
    const found = await readFixture("colour-wide.png");
    close(colours(found).flat(), truth, 2);
    assert.match(found.says, /from the colour profile "A test's own wide colours" to sRGB/);
    assert.equal(found.image.transfer, "srgb");
    assert.match((await readFixture("colour-wide.jpg")).says, /to sRGB/);
    const same = await readFixture("colour-srgb.png");
    assert.deepEqual(colours(same), rgb);
    assert.match(same.says, /sRGB/);
  });

  test("WebP is left to browsers, which is said", async () => {
    await refusedFile(readFixture("colour.webp"), "colour.webp", /browsers only; convert it to PNG/);
  });
});

describe("other people's data", {
  skip: existsSync(new URL("../../../shared/data", import.meta.url)) ? false : "needs ../shared/data",
}, () => {
  const sample = (name, options) =>
    read(
      name,
      new Uint8Array(readFileSync(fileURLToPath(new URL(`../../../shared/data/${name}`, import.meta.url)))),
      options,
    );

  test("depth: units and ranges", async () => {
    const says = {
      "nyu_raw_pair/depth_raw_mm.png":
        /^640x480, 16-bit, read as millimetres \(guessed\), 92\.8 % valid, 1\.39 to 6\.69 m$/,
      "file_formats/TUM_depth.png": /fifths of a millimetre, 5000 to the metre.*80\.8 % valid, 1\.46 to 9\.33 m/,
      "file_formats/SUN_depth.png": /bits rotated by three.*81\.8 % valid, 1\.06 to 9\.87 m/,
      "seven_scenes/frame-000150.depth.png":
        /millimetres.*88\.0 % valid, 0\.94 to 2\.86 m, 65535 treated as holes|millimetres.*88\.0 % valid, 0\.94 to 2\.86 m/,
      "mitten_rgbd/depth_1.png": /5000 to the metre/,
      "rgbd_object/cap_1_1_1_depthcrop.png": /217x156, 16-bit, read as millimetres.*0\.65 to 1\.17 m/,
      "android_rgbd/depth.png": /5000 to the metre.*0\.58 to 0\.62 m/,
    };
    for (const [name, pattern] of Object.entries(says)) assert.match((await sample(name)).says, pattern, name);
  });

  test("an EXR by PIZ", {
    skip: existsSync(new URL("../../../shared/data/exr_piz", import.meta.url)) ? false : "needs ../shared/data/exr_piz",
  }, async () => {
    const { depth, says } = await sample("exr_piz/depth.exr", { as: "depth" });
    assert.deepEqual([depth.width, depth.height], [1024, 768]);
    assert.match(says, /^1024x768, 16-bit float, read as metres \(guessed\), 100\.0 % valid, 2\.51 to/);
  });

  test("colour and masks", async () => {
    for (const name of ["nyu_raw_pair/color_raw.png", "file_formats/TUM_color.png", "file_formats/SUN_color.jpg"]) {
      const { kind, image } = await sample(name);
      assert.deepEqual([kind, image.width, image.height], ["colour", 640, 480], name);
    }
    assert.equal((await sample("rgbd_object/cap_1_1_1_maskcrop.png")).kind, "mask");
  });

  test("cameras and poses", async () => {
    const { cameras, poses } = await sample("nyu_raw_pair/calib.json");
    const calib = JSON.parse(
      readFileSync(fileURLToPath(new URL("../../../shared/data/nyu_raw_pair/calib.json", import.meta.url))),
    );
    assert.deepEqual(
      cameras.map(({ name }) => name),
      ["rgb", "depth"],
    );
    assert.deepEqual([...cameras[0].camera.distortion], calib.rgb.dist_k1k2p1p2k3);
    close(poses[0].pose.rotation, calib.R.flat(), 1e-9);
    close(poses[0].pose.translation, calib.t, 1e-12);
    assert.equal((await sample("seven_scenes/camera-intrinsics.txt")).cameras[0].camera.fx, 585);
    assert.equal((await sample("seven_scenes/frame-000150.pose.txt")).poses.length, 1);
    assert.equal((await sample("mitten_rgbd/calib.json")).cameras.length, 2);
  });
});
