// Depth in many common formats: read correctly, or refused with the file's kind and a remedy.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { crc32 } from "node:zlib";
import { readRigFile } from "../../pkg/rig.js";
import { inTime } from "./malformed.mjs";
import { H, W, close, metres, millimetres, read, refusedFile } from "./rig-support.mjs";
import { npy } from "./support.mjs";

const expected = millimetres.map((value) => value / 1000);
const inMetres = (tolerance) => (reading) => close(metres(reading), expected, tolerance);
const isMillimetres = inMetres(1e-9);
const says = async (code, pattern, name, bytes, options) => {
  const { warnings } = await read(name, bytes, options);
  const found = warnings.find((each) => each.code === code && pattern.test(each.message));
  assert.ok(found, JSON.stringify(warnings));
  assert.ok(found.isDoubt);
};
const refused = (name, bytes, reason, options) => refusedFile(read(name, bytes, options), name, reason);
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
const swapped = (array) => {
  const bytes = bytesOf(array).slice();
  const size = array.BYTES_PER_ELEMENT;
  for (let at = 0; at < bytes.length; at += size) bytes.subarray(at, at + size).reverse();
  return bytes;
};

describe(".npy of every type, order and shape", () => {
  const kinds = {
    "<u2": new Uint16Array(millimetres),
    ">u2": swapped(new Uint16Array(millimetres)),
    "<i2": new Int16Array(millimetres),
    "<i4": new Int32Array(millimetres),
    ">i4": swapped(new Int32Array(millimetres)),
    "<u4": new Uint32Array(millimetres),
    "<i8": new BigInt64Array(millimetres.map(BigInt)),
    ">u8": swapped(new BigUint64Array(millimetres.map(BigInt))),
    "<f8": new Float64Array(expected),
    ">f4": swapped(new Float32Array(expected)),
  };
  for (const [descr, data] of Object.entries(kinds))
    test(descr, async () => inMetres(1e-6)(await read("depth.npy", npy({ descr, shape: [H, W], data }))));

  test("half floats, with infinity where nothing was seen", async () => {
    // 1, 1.5, 2 and infinity.
    const data = new Uint16Array([0x3c00, 0x3e00, 0x4000, 0x7c00]);
    assert.deepEqual(metres(await read("depth.npy", npy({ descr: "<f2", shape: [2, 2], data }))), [1, 1.5, 2, 0]);
  });

  test("negative whole numbers are holes", async () => {
    const data = new Int32Array([1000, -1, 1200, 1300]);
    assert.deepEqual(metres(await read("depth.npy", npy({ descr: "<i4", shape: [2, 2], data }))), [1, 0, 1.2, 1.3]);
  });

  test("axes of length 1, as tensors have them", async () => {
    const data = new Float32Array(expected);
    for (const shape of [
      [1, H, W],
      [H, W, 1],
      [1, 1, H, W],
      [1, H, W, 1],
    ])
      inMetres(1e-6)(await read("depth.npy", npy({ descr: "<f4", shape, data })));
  });

  test("a cloud with its axes first", async () => {
    const plane = (value) => Array.from({ length: H * W }, (_, at) => value(at % W, Math.floor(at / W)));
    const data = new Float32Array([...plane((x) => x - 7.5), ...plane((_, y) => y - 5.5), ...plane(() => 10)]);
    const { depth } = await read("cloud.npy", npy({ descr: "<f4", shape: [3, H, W], data }));
    assert.deepEqual([depth.width, depth.height], [W, H]);
    assert.deepEqual([...depth.points.slice(3 * (W + 2), 3 * (W + 3))], [-5.5, -4.5, 10]);
  });

  test("what is no picture is named", async () => {
    const list = new Float32Array(3 * 150).fill(1);
    await refused("points.npy", npy({ descr: "<f4", shape: [150, 3], data: list }), /150 points .*unorganised/);
    await refused("a.npy", npy({ descr: "|O", shape: [1], data: list }), /Python objects/);
    await refused(
      "a.npy",
      npy({ descr: "<f4", shape: [5, H, W], data: new Float32Array(5 * H * W) }),
      /stack of 5 pictures/,
    );
    const fields = npy({ descr: "<f4", shape: [H, W], data: list });
    const structured = Buffer.from(fields).toString("latin1").replace("'<f4'", "[('z', '<f4')]");
    await refused("a.npy", new Uint8Array(Buffer.from(structured, "latin1")), /structured array/);
  });
});

/** A ZIP archive of some files, deflated or stored. */
function zip(files, isPacked) {
  const [locals, central] = [[], []];
  let at = 0;
  for (const [name, content] of Object.entries(files)) {
    const body = isPacked ? deflateRawSync(content) : Buffer.from(content);
    const head = Buffer.alloc(30);
    head.write("PK\x03\x04", 0, "latin1");
    head.writeUInt16LE(isPacked ? 8 : 0, 8);
    head.writeUInt16LE(name.length, 26);
    locals.push(head, Buffer.from(name), body);
    const entry = Buffer.alloc(46);
    entry.write("PK\x01\x02", 0, "latin1");
    entry.writeUInt16LE(isPacked ? 8 : 0, 10);
    entry.writeUInt32LE(crc32(content), 16);
    entry.writeUInt32LE(body.length, 20);
    entry.writeUInt32LE(content.length, 24);
    entry.writeUInt16LE(name.length, 28);
    entry.writeUInt32LE(at, 42);
    central.push(entry, Buffer.from(name));
    at += 30 + name.length + body.length;
  }
  const end = Buffer.alloc(22);
  end.write("PK\x05\x06", 0, "latin1");
  end.writeUInt16LE(Object.keys(files).length, 10);
  end.writeUInt32LE(at, 16);
  return new Uint8Array(Buffer.concat([...locals, ...central, end]));
}

describe(".npz", () => {
  const depth = npy({ descr: "<u2", shape: [H, W], data: new Uint16Array(millimetres) });
  const rgb = npy({ descr: "|u1", shape: [H, W, 3], data: new Uint8Array(3 * H * W).fill(9) });
  for (const isPacked of [false, true])
    test(`the array that is called depth, ${isPacked ? "deflated" : "stored"}`, async () => {
      const reading = await read("frame.npz", zip({ "rgb.npy": rgb, "depth.npy": depth }, isPacked));
      isMillimetres(reading);
      assert.match(reading.says, /its array "depth"/);
    });

  test("the only array; none that is told; an archive of something else", async () => {
    isMillimetres(await read("frame.npz", zip({ "arr_0.npy": depth }, true)));
    await refused("frame.npz", zip({ "arr_0.npy": depth, "arr_1.npy": depth }, true), /2 arrays \(arr_0, arr_1\)/);
    await refused("a.zip", zip({ "a.txt": depth }, true), /ZIP archive .*unpack/);
  });

  const doubles = (values, shape) => npy({ descr: "<f8", shape, data: new Float64Array(values) });
  const camera = { "mtx.npy": doubles([611.4312345678901, 0, 324.81, 0, 610.97, 236.44, 0, 0, 1], [3, 3]) };

  test("OpenCV's calibration, to all of its digits", async () => {
    const arrays = {
      ...camera,
      "dist.npy": doubles([0.1, -0.2, 0.001, 0.002, 0.05], [1, 5]),
      "rvecs.npy": doubles(Array(36).fill(0.3), [12, 3, 1]),
    };
    const { cameras, poses } = await read("calib.npz", zip(arrays, true));
    assert.equal(cameras.length, 1);
    assert.equal(cameras[0].camera.fx, 611.4312345678901);
    assert.deepEqual(cameras[0].camera.distortion, [0.1, -0.2, 0.001, 0.002, 0.05]);
    assert.deepEqual(poses, []);
  });

  test("matrices by names: two cameras and the pose between them, stored by columns", async () => {
    const byColumns = npy({
      descr: "<f8",
      shape: [4, 4],
      fortran: true,
      data: new Float64Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.015, -0.001, 0.002, 1]),
    });
    const arrays = { "K_color.npy": camera["mtx.npy"], "T_depth_to_color.npy": byColumns };
    const { cameras, poses } = await read("rig.npz", zip(arrays, false));
    assert.equal(cameras.length, 1);
    assert.deepEqual(poses[0].pose.translation, [0.015, -0.001, 0.002]);
    assert.deepEqual([poses[0].from, poses[0].to], ["depth", "color"]);
  });

  test("a depth map beside its intrinsics stays a depth map", async () => {
    isMillimetres(await read("frame.npz", zip({ "depth.npy": depth, ...camera }, true)));
  });

  test("a damaged one", async () => {
    const whole = zip({ "depth.npy": depth }, true);
    await refused("frame.npz", whole.slice(0, -30), /damaged or cut off/);
    whole[whole.length - 22 - 55 + 16] ^= 1;
    await refused("frame.npz", whole, /checksum/);
  });
});

describe("what is not read is named, with the way out", () => {
  const heads = {
    "scan.e57": ["ASTM-E57\x01\x00", /E57.*unorganised.*PCD, PLY or LAS/],
    "rec.oni": ["NI10\x01\x00", /OpenNI.*export/],
    "rec.svo": ["SVO\x00\x01", /ZED.*export/],
    "rec.klg": ["\x0a\x00\x00\x00", /ElasticFusion.*export/],
    "scene.sens": ["\x04\x00\x00\x00\x11", /ScanNet.*SensReader/],
    "rec.mkv": ["\x1a\x45\xdf\xa3\x01", /Matroska/],
    "0.depth": ["bvx2\x01\x02", /LZFSE.*Record3D/],
    "mesh.glb": ["glTF\x02\x00", /mesh \(glTF\)/],
    "scan.fls": ["\x01\x02\x03\x00", /manufacturer's format/],
    "IMG_1.dng": ["II*\x00\x08\x00", /raw photograph.*develop/],
    "a.hdr": ["#?RADIANCE\n", /Radiance's HDR; save it as EXR/],
    "a.xz": ["\xfd7zXZ\x00", /xz; unpack/],
    "mesh.obj": ["# made\nmtllib a.mtl\no Cube\nv 1 2 3\nv 1 2 4\nf 1 2 3\n", /Wavefront's OBJ.*render a depth map/],
    "mesh.stl": ["solid a\n facet normal 0 0 1\n  outer loop\n", /STL/],
    "mesh.gltf": ['{"scene": 0, "asset": {"generator": "x", "version": "2.0"}}', /mesh \(glTF\)/],
    "mesh.off": ["OFF\n8 6 12\n0 0 0\n", /OFF/],
    "noise.bin": ["\x00\x01\x02\xff", /not supported; .*raw data without a header, give its size/],
  };
  for (const [name, [head, reason]] of Object.entries(heads))
    test(name, () => refused(name, new Uint8Array(Buffer.from(head, "latin1")), reason));

  const points = (columns, first = "") =>
    first +
    Array.from({ length: 40 }, (_, at) => Array.from({ length: columns }, (_, k) => at + k / 7).join(" ")).join("\n");
  test("points as text: XYZ, PTS, CloudCompare's, PTX", async () => {
    await refused("a.xyz", points(3), /list of points as text \(3 numbers each\).*unorganised/);
    await refused("a.pts", points(7, "40\n"), /list of points/);
    await refused("a.asc", points(6, "//X Y Z R G B\n"), /list of points/);
    await refused(
      "a.ptx",
      `20\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n${points(4)}`,
      /PTX.*z forward/,
    );
  });

  test("trajectories and matrices are no points", async () => {
    const tum = Array.from({ length: 40 }, (_, at) => `${at}.5 ${at} 0 0 0 0 0 1`).join("\n");
    assert.equal((await read("groundtruth.txt", tum)).poses.length, 40);
    const log = Array.from({ length: 10 }, (_, at) => `0 0 ${at}\n1 0 0 ${at}\n0 1 0 0\n0 0 1 0\n0 0 0 1`).join("\n");
    assert.equal((await read("trajectory.log", log)).poses.length, 10);
  });
});

describe("depth maps without a format", () => {
  const [columns, rows] = [32, 24];
  const values = Array.from({ length: columns * rows }, (_, at) => (at % 29 === 0 ? 0 : 900 + at));
  const table = (separator, format = String, ending = "\n") =>
    Array.from({ length: rows }, (_, row) =>
      values
        .slice(row * columns, (row + 1) * columns)
        .map(format)
        .join(separator),
    ).join(ending);
  const wanted = values.map((value) => value / 1000);
  const isTable = (reading) => {
    assert.deepEqual([reading.kind, reading.depth.width, reading.depth.height], ["depth", columns, rows]);
    close(metres(reading), wanted, 1e-6);
  };

  test("tables: commas, spaces of numpy.savetxt, semicolons with decimal commas, nan", async () => {
    isTable(await read("depth.csv", table(",")));
    isTable(await read("depth.csv", table(",", String, ",\r\n")));
    isTable(
      await read(
        "depth.txt",
        table(" ", (value) => (value / 1000).toExponential(18)),
      ),
    );
    isTable(
      await read(
        "depth.csv",
        table(";", (value) => (value / 1000).toFixed(4).replace(".", ",")),
      ),
    );
    isTable(
      await read(
        "depth.csv",
        table("\t", (value) => (value === 0 ? "nan" : String(value))),
      ),
    );
  });

  test("the numbers that pandas gives rows and columns are none of the depths", async () => {
    const head = ["", ...Array(columns).keys()].join(",");
    const body = table(",")
      .split("\n")
      .map((line, row) => `${row},${line}`);
    isTable(await read("depth.csv", [head, ...body].join("\n")));
  });

  test("a table of more numbers than are read, in little time", async () => {
    const line = Buffer.from(`${"1,".repeat(2047)}1\n`);
    const bytes = new Uint8Array(Buffer.concat(Array(1100).fill(line)));
    await inTime("large.csv", () => refused("large.csv", bytes, /more numbers than 1920x1080 pixels/));
  });

  test("a table with a row too short", () =>
    refused("depth.csv", `${table(",")}\n1,2,3`, /3 columns in row 25, but 32 in the rows before/));

  test("raw pixels of a given size; without it the sizes that would fit are named", async () => {
    const raw = (array) => read("depth.raw", bytesOf(array), { size: [columns, rows] });
    isTable(await raw(new Uint16Array(values)));
    isTable(await raw(new Float32Array(wanted)));
    isTable(await raw(new Uint32Array(values)));
    await refused(
      "depth.raw",
      bytesOf(new Uint16Array(640 * 480).fill(7)),
      /640x480 of 16 bits would have its 614400 bytes/,
    );
    await refused("depth.raw", bytesOf(new Uint16Array(values)), /not 30x20 pixels of 1, 2, 4 or 8 bytes/, {
      size: [30, 20],
    });
    await assert.rejects(readRigFile({ name: "a.raw", bytes: new Uint8Array(2) }, { size: [1, 0] }), {
      code: "option",
      field: "options.size",
    });
  });

  test("COLMAP's depth maps, whose scale is no metre's; its normal maps", async () => {
    const map = (head, array) => new Uint8Array([...Buffer.from(head), ...bytesOf(array)]);
    const bytes = map(`${columns}&${rows}&1&`, new Float32Array(wanted));
    isTable(await read("0001.png.geometric.bin", bytes));
    await says("unit-guessed", /COLMAP.*scale/, "0001.png.geometric.bin", bytes);
    await refused("0001.bin", map("2&1&3&", new Float32Array(6)), /normals/);
    await refused("0001.bin", bytes.slice(0, 500), /cut off/);
  });
});
