// Malformed and odd files of a rig: each a clear error that names file and reason, in bounded time and memory.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { crc32, deflateSync } from "node:zlib";
import { BimodalError, readRigFile } from "../../pkg/rig.js";
import { npy, png } from "./support.mjs";
import { fixture, refusedFile, text } from "./rig-support.mjs";

const MEGABYTE = 2 ** 20;
/** The issue's bounds. */
const MOST_MILLISECONDS = 1000;
const MOST_MEMORY = 2 ** 30;

/**
 * Runs what may be slow, and checks its time: that of this process and not of the clock, since other programs may keep the machine busy;
 * and the best of three, since they also take its caches.
 */
async function inTime(what, run) {
  let spent = Infinity;
  for (let attempt = 0; attempt < 3 && spent > MOST_MILLISECONDS; attempt++) {
    const before = process.cpuUsage();
    await run();
    const { user, system } = process.cpuUsage(before);
    spent = (user + system) / 1000;
  }
  assert.ok(spent <= MOST_MILLISECONDS, `${what}: ${spent} ms`);
}

const bytes = (...parts) => new Uint8Array(Buffer.concat(parts.map((part) => Buffer.from(part))));
const u32 = (...values) =>
  bytes(...values.map((value) => new Uint8Array([value, value >> 8, value >> 16, value >> 24])));
const cut = (name, length) => fixture(name).slice(0, length);
const changed = (name, ...changes) => {
  const file = fixture(name);
  for (const [at, value] of changes) file[at < 0 ? file.length + at : at] = value;
  return file;
};

/** A part of a PNG with its checksum. */
const chunk = (type, data) => {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const frame = Buffer.alloc(8);
  frame.writeUInt32BE(data.length, 0);
  frame.writeUInt32BE(crc32(body), 4);
  return Buffer.concat([frame.subarray(0, 4), body, frame.subarray(4)]);
};
const ihdr = (width, height, depth = 8, type = 2, interlace = 0) => {
  const data = Buffer.alloc(13);
  data.writeUInt32BE(width, 0);
  data.writeUInt32BE(height, 4);
  data.set([depth, type, 0, 0, interlace], 8);
  return chunk("IHDR", data);
};
const pngOf = (...chunks) =>
  bytes(
    "\x89PNG\r\n\x1a\n".split("").map((letter) => letter.charCodeAt(0)),
    ...chunks,
    chunk("IEND", Buffer.alloc(0)),
  );
const idat = (length) => chunk("IDAT", deflateSync(Buffer.alloc(length)));

/** A TIFF of one strip; tags are [tag, value] of one 32-bit number each. */
const tiff = (tags, body = new Uint8Array(0)) => {
  const view = new DataView(new ArrayBuffer(14 + 12 * tags.length));
  view.setUint32(0, 0x002a4949, true);
  view.setUint32(4, 8, true);
  view.setUint16(8, tags.length, true);
  tags.forEach(([tag, value], at) => {
    view.setUint16(10 + 12 * at, tag, true);
    view.setUint16(12 + 12 * at, 4, true);
    view.setUint32(14 + 12 * at, 1, true);
    view.setUint32(18 + 12 * at, value, true);
  });
  return bytes(new Uint8Array(view.buffer), body);
};
const tiffTags = (width, height, more = {}) =>
  Object.entries({
    256: width,
    257: height,
    258: 16,
    259: 1,
    273: 200,
    277: 1,
    278: height,
    279: 2 * width * height,
    ...more,
  }).map(([tag, value]) => [Number(tag), value]);

/** A JPEG of nothing but its marks. */
const jpeg = (width, height, { channels = 3, bits = 8, kind = 0xc0, sampling = 0x11, scans = 1, tail = [] } = {}) =>
  bytes(
    [0xff, 0xd8],
    [0xff, kind, 0, 8 + 3 * channels, bits, height >> 8, height & 255, width >> 8, width & 255, channels],
    Array.from({ length: channels }, (_, at) => [at + 1, sampling, 0]).flat(),
    ...Array.from({ length: scans }, () => [0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0]),
    tail,
    [0xff, 0xd9],
  );

const pcd = (changes, body = "") => {
  const lines = {
    VERSION: "0.7",
    FIELDS: "x y z",
    SIZE: "4 4 4",
    TYPE: "F F F",
    COUNT: "1 1 1",
    WIDTH: "2",
    HEIGHT: "2",
    VIEWPOINT: "0 0 0 1 0 0 0",
    POINTS: "4",
    DATA: "ascii",
    ...changes,
  };
  return bytes(
    text(
      Object.entries(lines)
        .map(([key, value]) => `${key} ${value}\n`)
        .join(""),
    ),
    body,
  );
};
const ply = (count, body, more = "", format = "ascii") =>
  bytes(
    text(
      `ply\nformat ${format} 1.0\n${more}element vertex ${count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`,
    ),
    body,
  );
const laughs = "abcdefghij"
  .split("")
  .map(
    (key, at) =>
      `${key}: &${key} [${Array(9)
        .fill(at === 0 ? "1" : `*${"abcdefghij"[at - 1]}`)
        .join(", ")}]`,
  )
  .join("\n");
const exr = (changes, name = "depth-zip.exr") => {
  const file = fixture(name);
  const at = (name) => Buffer.from(file).indexOf(name) + name.length;
  changes(file, new DataView(file.buffer), at);
  return file;
};

/** Where the table of an EXR of several blocks is: it points behind its own end. */
function blocksAt(view) {
  for (let at = 0; at + 8 < view.byteLength; at++) {
    const first = view.getUint32(at, true);
    if (first > at && first < at + 200 && (first - at) % 8 === 0 && view.getUint32(at + 4, true) === 0) return at;
  }
  throw new Error("no table");
}

/** The first block once more in place of the second. */
const twice = (_, view) => view.setUint32(blocksAt(view) + 8, view.getUint32(blocksAt(view), true), true);

/** Where the table of an EXR's one block is, which stands right behind it. */
function table(view) {
  for (let at = 0; at + 8 < view.byteLength; at++)
    if (view.getUint32(at, true) === at + 8 && view.getUint32(at + 4, true) === 0) return at;
  throw new Error("no table");
}

/** The same file by another compression, as its header says. */
const packed = (name, compression) => {
  const file = fixture(name);
  const at = Buffer.from(file).indexOf("compression\0compression\0") + "compression\0compression\0".length;
  file[at + 4] = compression;
  return file;
};

/** An EXR whose first block inflates to two megabytes. */
function bombOf(name) {
  const file = fixture(name);
  const view = new DataView(file.buffer);
  const from = Number(view.getBigUint64(blocksAt(view), true));
  const bomb = deflateSync(Buffer.alloc(2 * MEGABYTE));
  return bytes(file.subarray(0, from + 4), u32(bomb.length), bomb, new Uint8Array(30_000));
}

/** A frame of ZSTD that declares so many bytes and holds none. */
const zstdOf = (declared) => bytes([0x28, 0xb5, 0x2f, 0xfd, 0xa0], u32(declared), [1, 0, 0]);

/** The header of a blob of LERC, of the second version. */
const lercOf = ({ width = 4, height = 4, block = 8, length = 100 }) =>
  bytes(text("Lerc2 "), u32(2, height, width, width * height, block, length, 3), new Uint8Array(100)).slice(0, 100);

/** File, bytes, what the error has to say, and options where it needs some. */
const FILES = [
  ["empty.png", new Uint8Array(0), /it is empty/],
  ["spaces.txt", text(" \n\t "), /nothing in it but spaces/],
  ["large.bin", new Uint8Array(65 * MEGABYTE), /65 MB large; up to 64 MB/],
  ["noise.bin", new Uint8Array([0, 1, 2, 3, 255]), /format is not known here/],
  ["a.gif", text("GIF89a\x00\x01"), /a GIF; save it as PNG/],
  ["a.bmp", text("BM\x00\x01"), /a BMP; save it as PNG/],
  ["a.npz", text("PK\x03\x04...."), /ZIP archive .* unpack/],
  ["a.mat", text("MATLAB 5.0 MAT-file\x00\x01"), /\.npy/],
  ["a.pkl", new Uint8Array([0x80, 4, 0x95, 0, 0]), /pickle of Python/],
  ["a.bag", text("#ROSBAG V2.0\n\x00\x01"), /recording of ROS/],
  ["a.heic", new Uint8Array([0, 0, 0, 24, ...text("ftypheic"), 0, 1]), /HEIC/],
  ["page.html", text("<!doctype html><html><body>404</body></html>"), /document type/],
  ["readme.txt", text("Some words: of no: use"), /none of the forms/],

  [
    "signature.png",
    png({ width: 1, height: 1, depth: 8, colourType: 2, rows: [[1, 2, 3]] }).slice(0, 8),
    /cut off: its end is missing/,
  ],
  ["cut.png", cut("depth-cv.png", 60), /PNG is cut off/],
  ["checksum.png", changed("depth-cv.png", [-16, 0x55]), /checksum of its part IDAT is wrong/],
  ["none.png", pngOf(ihdr(0, 5), idat(1)), /0x5 pixels/],
  ["wide.png", pngOf(ihdr(5000, 1), idat(15_001)), /5000x1 pixels large; up to 4096/],
  ["promises.png", pngOf(ihdr(4096, 4096, 16, 6), idat(100)), /cannot inflate to/],
  ["bomb.png", pngOf(ihdr(8, 8), idat(20 * MEGABYTE)), /inflates to more than the 200 bytes/],
  ["stored.png", pngOf(ihdr(8, 8), chunk("IDAT", Buffer.alloc(MEGABYTE))), /longer compressed than not/],
  ["short.png", pngOf(ihdr(8, 8), idat(150)), /inflates to 150 of 200 bytes/],
  ["type.png", pngOf(ihdr(8, 8, 8, 5), idat(200)), /of the type 5/],
  ["filter.png", pngOf(ihdr(1, 1), chunk("IDAT", deflateSync(Buffer.from([9, 1, 2, 3])))), /PNG is damaged .*filter/],
  ["headless.png", pngOf(idat(200)), /no header/],
  ["bits.png", pngOf(ihdr(8, 8, 1, 0, 1), idat(20)), /interlaced with fewer than 8 bits/],
  ["palette.png", pngOf(ihdr(1, 1, 8, 3), chunk("PLTE", Buffer.alloc(3 * 300)), idat(2)), /more than 256 colours/],

  [
    "cut.npy",
    npy({ descr: "<f4", shape: [4, 4], data: new Float32Array(16) }).slice(0, 150),
    /cut off: \d+ of 64 bytes/,
  ],
  ["large.npy", npy({ descr: "<f4", shape: [100_000, 100_000], data: new Float32Array(1) }), /cut off/],
  ["complex.npy", npy({ descr: "<c8", shape: [1, 1], data: new Float32Array(2) }), /type "<c8"/],
  ["volume.npy", npy({ descr: "<f4", shape: [2, 2, 2, 2], data: new Float32Array(16) }), /4 axes/],
  ["wide.npy", npy({ descr: "|u1", shape: [1, 5000], data: new Uint8Array(5000) }), /5000x1 pixels large/],
  [
    "two.npy",
    npy({ descr: "<f4", shape: [1, 1, 2], data: new Float32Array(2) }),
    /1 channel and a cloud 3, not 2/,
    { as: "depth" },
  ],
  [
    "holes.npy",
    npy({ descr: "<f4", shape: [1, 3], data: new Float32Array([0, -1, NaN]) }),
    /no pixel of it holds a depth/,
  ],

  ["cut.pgm", text("P5\n4 4\n65535\nabc"), /PGM is cut off: 3 of 32 bytes/],
  ["words.pgm", text("P2\nfour 4\n255\n"), /"four" where a width is needed/],
  ["level.pgm", text("P2\n2 1\n255\n1 300\n"), /its level 1 is "300"/],
  ["few.pgm", text("P2\n2 2\n255\n1 2 3\n"), /cut off: 3 of 4 levels/],
  ["most.ppm", text("P6\n1 1\n70000\nabcdef"), /levels go up to 70000/],
  ["huge.ppm", text("P6\n4000 4000\n255\nabc"), /cut off: 3 of 48000000 bytes/],
  ["endless.ppm", text("P6\n999999999 1\n255\n"), /999999999x1 pixels/],
  ["map.pam", text("P7\nWIDTH 1\nENDHDR\n"), /netpbm's kind P7/],
  ["cut.pfm", text("Pf\n4 4\n-1.0\nabc"), /PFM is cut off/],
  ["scale.pfm", text("Pf\n1 1\n0\nabcd"), /no scale/],

  ["head.tif", text("II*\x00"), /beyond its own end/],
  ["nowhere.tif", bytes([0x49, 0x49, 42, 0], u32(0xffffff)), /beyond its own end/],
  ["cut.tif", cut("depth-float-zlib.tif", 300), /TIFF|beyond its own end/],
  ["big.tif", cut("depth-bigtiff.tif", 40), /beyond its own end/],
  ["tags.tif", bytes([0x49, 0x49, 43, 0, 8, 0, 0, 0], u32(16, 0, 0xffffffff, 0xffff)), /TIFF has \d+ tags/],
  ["kind.tif", changed("depth-16-None.tif", [2, 44]), /not known here/],
  ["zstd.tif", tiff(tiffTags(4096, 4096, { 259: 50000, 273: 110, 279: 8 }), zstdOf(2 ** 31)), /damaged|cut off/],
  ["lerc.tif", tiff(tiffTags(4, 4, { 259: 34887, 273: 110, 279: 100 }), lercOf({ width: 2 ** 15 })), /kind of LERC/],
  [
    "lerc-none.tif",
    tiff(tiffTags(4, 4, { 259: 34887, 273: 110, 279: 100 }), lercOf({ length: 0 })),
    /beyond its own end/,
  ],
  ["lerc-block.tif", tiff(tiffTags(4, 4, { 259: 34887, 273: 110, 279: 100 }), lercOf({ block: 0 })), /kind of LERC/],
  ["lzma.tif", tiff(tiffTags(4, 4, { 259: 34925, 279: 20 }), new Uint8Array(200)), /compressed by LZMA/],
  ["promises.tif", tiff(tiffTags(4096, 4096)), /cut off: \d+ of \d+ bytes/],
  ["wide.tif", tiff(tiffTags(70_000, 1)), /70000x1 pixels large/],
  ["fat.tif", tiff(tiffTags(4096, 4096, { 258: 64, 277: 4, 339: 3 })), /too much/],
  ["strips.tif", tiff(tiffTags(100, 100, { 278: 1 })), /lists 1 parts of its pixels; 100 are needed/],
  ["rows.tif", tiff(tiffTags(4, 4, { 278: 0 })), /strips of no rows/],
  ["lzw.tif", tiff(tiffTags(4, 4, { 259: 5, 279: 20 }), new Uint8Array(200).fill(0xff)), /TIFF is damaged/],
  ["bits.tif", tiff(tiffTags(4, 4, { 258: 12 })), /12-bit samples/],
  ["predictor.tif", tiff(tiffTags(4, 4, { 317: 7 })), /predictor 7/],
  ["palette.tif", tiff(tiffTags(4, 4, { 262: 3 })), /palette/],

  ["cut.exr", cut("depth-zip.exr", 250), /EXR|beyond its own end/],
  ["b44.exr", fixture("large-b44.exr"), /compressed by B44/],
  ["dwa.exr", fixture("large-dwaa-depth.exr"), /DWA, of which R, G, B and Y are read/],
  ["types.exr", packed("colour-and-depth.exr", 4), /channels of different types/],
  ["piz.exr", changed("large-piz-half.exr", [-200, 0], [-201, 0], [-202, 0], [-700, 255]), /EXR|damaged/],
  ["order.exr", exr(twice, "large-pxr24-float.exr"), /a block of it is missing/],
  ["bomb.exr", bombOf("large-pxr24-float.exr"), /inflates to more than the 4096 bytes/],
  ["tiled.exr", exr((file) => (file[5] = 2)), /tiled/],
  [
    "window.exr",
    exr((_, view, at) => view.setInt32(at("dataWindow\0box2i\0") + 12, 100_000, true)),
    /100001x12 pixels large/,
  ],
  ["block.exr", exr((_, view) => view.setInt32(table(view) + 12, 2 ** 30, true)), /damaged in its block 0/],
  ["table.exr", exr((_, view) => view.setUint32(table(view) + 4, 255, true)), /beyond its own end/],

  ["cut.ply", ply(4, "1 2 3\n"), /PLY is cut off/],
  ["end.ply", text("ply\nformat ascii 1.0\nelement vertex 4\n"), /header has no end/],
  ["words.ply", ply(192, "1 2 three ".repeat(192)), /"three" where a number is needed/],
  ["many.ply", ply(999_999_999, "1 2 3\n"), /999999999 points/],
  ["type.ply", text("ply\nformat ascii 1.0\nelement vertex 1\nproperty colour x\nend_header\n"), /type "colour"/],
  ["format.ply", ply(1, "", "", "utf8"), /format "utf8"/],
  ["unorganised.ply", ply(3, "1 2 3 4 5 6 7 8 9"), /3 points are not in rows and columns/],
  [
    "grid.ply",
    text(
      "ply\nformat ascii 1.0\nobj_info num_cols 1\nobj_info num_rows 1\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement range_grid 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n1 7\n",
    ),
    /grid names the point 7 of 1/,
  ],
  ["behind.ply", ply(4, "1 2 -3\n".repeat(4), "obj_info num_cols 2\nobj_info num_rows 2\n"), /behind the camera/],
  ["cut.pcd", pcd({}, "1 2 3 4"), /PCD is cut off/],
  ["data.pcd", text("VERSION 0.7\nFIELDS x y z\n"), /no DATA/],
  ["fields.pcd", pcd({ FIELDS: "a b c" }, "1 2 3 ".repeat(4)), /no x of floats/],
  ["sizes.pcd", pcd({ SIZE: "4 4" }), /a size, a type and a count/],
  ["points.pcd", pcd({ POINTS: "5" }), /5 points in 2x2/],
  ["many.pcd", pcd({ WIDTH: "99999", HEIGHT: "99999", POINTS: "999999999" }), /PCD says|points/],
  ["unorganised.pcd", pcd({ WIDTH: "4", HEIGHT: "1" }), /not in rows and columns/],
  ["packed.pcd", pcd({ DATA: "binary_compressed" }, u32(10, 999)), /999 bytes long, and 48 are needed/],
  [
    "back.pcd",
    pcd({ DATA: "binary_compressed" }, bytes(u32(4, 48), [0x3f, 0xff, 0xff, 0xff])),
    /damaged or cut off in its compressed points/,
  ],
  [
    "promises.pcd",
    pcd(
      { WIDTH: "2048", HEIGHT: "2048", POINTS: String(2 ** 22), DATA: "binary_compressed" },
      bytes(u32(4, 12 * 2 ** 22), [0, 1, 2, 3]),
    ),
    /compressed points/,
  ],

  ["head.jpg", new Uint8Array([0xff, 0xd8, 0xff, 0xe0]), /no pixels/],
  ["cut.jpg", cut("colour.jpg", 700), /JPEG is cut off: its end is missing/],
  ["promises.jpg", jpeg(4096, 4096), /cannot hold 4096x4096/],
  ["wide.jpg", jpeg(60_000, 10), /60000x10 pixels large/],
  ["cmyk.jpg", fixture("colour-cmyk.jpg"), /CMYK/],
  ["lossless.jpg", jpeg(8, 8, { kind: 0xc3 }), /lossless/],
  ["twelve.jpg", jpeg(8, 8, { bits: 12 }), /12 bits/],
  ["scans.jpg", jpeg(8, 8, { scans: 100 }), /more than 64 scans/],
  ["parts.jpg", bytes([0xff, 0xd8], ...Array(6000).fill([0xff, 0xe1, 0, 2])), /more than 5000 parts/],
  ["sampling.jpg", jpeg(8, 8, { sampling: 0xf0 }), /sampling factors/],
  ["tables.jpg", jpeg(8, 8, { tail: new Array(50).fill(7) }), /JPEG is damaged/],
  ["a.webp", fixture("colour.webp"), /browsers only/],
  ["cut.webp", cut("colour.webp", 20), /WebP is cut off/],

  ["cut.json", cut("open3d-intrinsic.json", 60), /JSON is damaged or cut off/],
  ["else.json", text('{"a": [1, 2, {"b": 3}]}'), /neither a camera .* nor a motion/],
  ["deep.json", text("[".repeat(MEGABYTE) + "]".repeat(MEGABYTE)), /damaged|nested deeper/],
  ["deep-objects.json", text('{"a":'.repeat(200_000) + "1" + "}".repeat(200_000)), /damaged|nested deeper/],
  [
    "names.json",
    text(JSON.stringify(Object.fromEntries(Array.from({ length: 100_000 }, (_, at) => [`K_${at}`, at])))),
    /neither a camera/,
  ],
  ["many.json", text(`[${'{"a":{}},'.repeat(60_000)}{}]`), /more than 50000/],
  ["focal.json", text('{"fx": -500, "fy": 500, "cx": 320, "cy": 240}'), /focal lengths -500 and 500/],
  ["half.json", text('{"fx": 500, "cx": 320}'), /without fy and cy/],
  [
    "side.yaml",
    text("image_width: 640\ncamera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}\n"),
    /only one side of its images: a width of 640/,
  ],
  ["rotation.json", text('{"R": [[1,0,0],[0,1,0],[0,0,2]], "t": [0,0,0]}'), /its rotation is none/],
  ["translation.json", text('{"R": [[1,0,0],[0,1,0],[0,0,1]], "t": [0,0]}'), /its t has 2 numbers/],
  [
    "quaternion.json",
    text('{"rotation": {"x":0,"y":0,"z":0,"w":2}, "translation": {"x":0,"y":0,"z":0}}'),
    /quaternion has the length 2/,
  ],
  ["laughs.yaml", text(laughs), /none of the forms|neither a camera/],
  ["cut.yaml", cut("opencv.yaml", 150), /as YAML|neither a camera/],
  ["twice.yaml", text("K: 1\nK: 2\n"), /as YAML/],
  ["nested.yaml", text(`K: ${"[".repeat(40)}${"]".repeat(40)}`), /as YAML: nesting/],
  ["aliases.yaml", text(`x: &a 1\ny: [${Array(65).fill("*a").join(", ")}]`), /as YAML/],
  ["open.yaml", text(`K: [${"1,".repeat(2 ** 17 - 8)}`), /as YAML/],
  ["words.yaml", text(`K: [${"a\n".repeat(2 ** 17 - 8)}`), /as YAML/],
  [
    "omni.yaml",
    text("cam0:\n  camera_model: omni\n  intrinsics: [1, 2, 3, 4, 5]\n  distortion_model: radtan\n"),
    /Kalibr's model "omni"/,
  ],
  ["four.yaml", text("cam0:\n  camera_model: pinhole\n  intrinsics: [1, 2, 3]\n"), /3 intrinsics/],
  [
    "K.yaml",
    text("camera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 500, 240, 1, 1, 1]\n"),
    /no matrix of intrinsics/,
  ],
  [
    "tilt.yaml",
    text(`K: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nD: [${Array(14).fill("0.1").join(", ")}]\n`),
    /thin-prism or tilt/,
  ],
  ["cut.xml", cut("opencv.xml", 300), /XML is cut off/],
  ["entities.xml", text('<!DOCTYPE a [<!ENTITY a "b">]><a>&a;</a>'), /document type/],
  ["close.xml", text("<a><b></a></b>"), /closes <a>/],
  ["deep.xml", text("<a>".repeat(100_000)), /nested deeper/],
  ["wide.xml", text(`<a>${"<b/>".repeat(200_000)}</a>`), /more than 100000 elements/],
  ["attributes.xml", text(`<a ${"b".repeat(MEGABYTE)}`), /more than 4096 characters/],
  ["alike.xml", text(`<a>${"x<b/>".repeat(90_000)}</a>`), /neither a camera/],
  ["tag.xml", text('<a b="'), /cut off within a tag/],
  ["K.txt", text("500 0 320\n0 500 240\n"), /6 numbers in 2 rows/],
  ["transposed.txt", text("500 0 0\n0 500 0\n320 240 1\n"), /transposed/],
  ["nan.txt", text("500 0 nan\n0 500 240\n0 0 1\n"), /nan, inf/],
  ["mirror.txt", text("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n"), /mirrors/],
  ["last.txt", text("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n"), /not in 0 0 0 1/],
  ["numbers.txt", text("1.5 ".repeat(500_000)), /more than 200000 numbers/],
  // No number, of many digits: where digits match in two ways, that takes the square of their number.
  ["digits.txt", text(`${"1".repeat(200_000)}${"e".repeat(200_000)}`), /in none of the forms/],
  ["digits.json", text(`{"fx":"${"1".repeat(200_000)}x","fy":1,"cx":1,"cy":1}`), /fx|camera/],
  ["digits.yaml", text(`fx: ${"1".repeat(200_000)}x\nfy: 1\ncx: 1\ncy: 1\n`), /fx|camera|none/],
  ["cameras.txt", text("1 PINHOLE 640 480 500 320 240\n"), /needs 4 numbers, and has 3/],
  ["model.txt", text("1 FOV 640 480 500 500 320 240 0.1\n"), /model FOV/],
  ["line.txt", text("1 PINHOLE 640 480 500 500 320 240\nno camera\n"), /a line that is no camera/],
  [
    "streams.txt",
    text('Extrinsic from "Depth" To "Color" :\n Rotation Matrix:\n 1 0 0\n'),
    /from "Depth" to "Color" have 3 numbers/,
  ],
  ["publisher.txt", text("static_transform_publisher 1 2 3\n"), /3 numbers/],
  ["publisher2.txt", text("static_transform_publisher without numbers\n"), /no numbers follow/],
  ["long.txt", text("a: ".padEnd(600_000, "b")), /in none of the forms/],
  ["quotes.txt", text(`"${"\\".repeat(300_000)}`), /none of the forms/],
];

describe("malformed and odd files", () => {
  test(`there are ${FILES.length}, each with a name of its own`, () => {
    assert.ok(FILES.length >= 60);
    assert.equal(new Set(FILES.map(([name]) => name)).size, FILES.length);
  });

  for (const [name, content, reason, options] of FILES) {
    test(`${name}: ${reason.source}`, async () => {
      await inTime(name, () => refusedFile(readRigFile({ name, bytes: content }, options), name, reason));
    });
  }
});

describe("files changed at random", () => {
  /** Mulberry32: the same cases in each run. */
  function generator(seed) {
    let state = seed >>> 0;
    return () => {
      state = (state + 0x6d2b79f5) >>> 0;
      let mixed = Math.imul(state ^ (state >>> 15), state | 1);
      mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
      return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
    };
  }

  const CASES = 120;
  const KINDS = ["colour", "depth", "mask", "cameras", "poses", undefined, undefined, undefined];
  const BYTES = [0, 255, 127, 128, 45, 48, 57, 10];

  /** Cut off, with bits and bytes changed (headers more than bodies), or with something put in between. */
  function mutated(file, random) {
    const below = (count) => Math.floor(random() * count);
    if (random() < 0.3) return file.slice(0, below(file.length));
    const copy =
      random() < 0.1 ? bytes(file.subarray(0, 40), new Uint8Array(below(9)), file.subarray(40)) : file.slice();
    for (let change = 1 + below(5); change > 0; change--) {
      const at = below(random() < 0.5 ? Math.min(copy.length, 200) : copy.length);
      copy[at] = random() < 0.5 ? copy[at] ^ (1 << below(8)) : BYTES[below(BYTES.length)];
    }
    return copy;
  }

  const folder = fileURLToPath(new URL("../fixtures/rig", import.meta.url));
  // Folders beside them hold what the writers wrote.
  const names = readdirSync(folder, { withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map(({ name }) => name)
    .sort();

  test(`${CASES * names.length} cases end in a reading or in a BimodalError that names the file`, async () => {
    const random = generator(15);
    let [read, refused] = [0, 0];
    for (const name of names) {
      const file = fixture(name);
      for (let index = 0; index < CASES; index++) {
        const as = KINDS[Math.floor(random() * KINDS.length)];
        const content = mutated(file, random);
        await inTime(`${name}, case ${index}`, async () => {
          try {
            const reading = await readRigFile({ name, bytes: content }, as && { as });
            assert.ok(reading.says.length > 0 && Array.isArray(reading.warnings));
            read++;
          } catch (error) {
            assert.ok(
              error instanceof BimodalError && error.code === "file" && error.message.includes(name),
              `${name}, case ${index}: ${error.stack}`,
            );
            refused++;
          }
        });
      }
    }
    assert.ok(read > 500 && refused > 5000, `${read} read, ${refused} refused`);
  });
});

test("no file took a gigabyte", () => {
  const most = 1024 * process.resourceUsage().maxRSS;
  assert.ok(most < MOST_MEMORY, `${(most / MEGABYTE).toFixed(0)} MB`);
});
