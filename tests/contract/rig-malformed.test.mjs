// Malformed and odd files of a rig: each gives a clear error with file and reason, in bounded time and memory.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { deflateSync } from "node:zlib";
import { readRigFile } from "../../pkg/rig.js";
import { openRecording } from "../../pkg/rig-recordings.js";
import { PICTURES } from "./malformed-pictures.mjs";
import { BINARIES, CALIBRATIONS } from "./malformed-products.mjs";
import { RECORDINGS } from "./malformed-recordings.mjs";
import {
  MEGABYTE,
  assertSmall,
  bombOf,
  bytes,
  changed,
  chunk,
  cut,
  exr,
  idat,
  ihdr,
  inRoom,
  inTime,
  jpeg,
  laughs,
  lercOf,
  packed,
  pcd,
  ply,
  pngOf,
  table,
  tiff,
  tiffTags,
  twice,
  u32,
  zstdOf,
} from "./malformed.mjs";
import { codes, fixture, refusedFile, text } from "./rig-support.mjs";
import { npy, png } from "./support.mjs";

/** File name, bytes, a pattern for the error, and options if needed. */
const FILES = [
  ["empty.png", new Uint8Array(0), /it is empty/],
  ["spaces.txt", text(" \n\t "), /it is empty or has only spaces/],
  ["large.bin", new Uint8Array(65 * MEGABYTE), /65 MB large; up to 64 MB/],
  ["noise.bin", new Uint8Array([0, 1, 2, 3, 255]), /format is not supported/],
  ["a.gif", text("GIF89a\x00\x01"), /a GIF; save it as PNG/],
  ["a.bmp", text("BM\x00\x01"), /a BMP; save it as PNG/],
  ["a.npz", text("PK\x03\x04...."), /ZIP archive .* unpack/],
  ["a.mat", text("MATLAB 5.0 MAT-file\x00\x01"), /\.npy/],
  ["a.pkl", new Uint8Array([0x80, 4, 0x95, 0, 0]), /pickle of Python/],
  ["a.bag", text("#ROSBAG V2.0\n\x00\x01"), /recording of ROS/],
  ["a.heic", new Uint8Array([0, 0, 0, 24, ...text("ftypheic"), 0, 1]), /HEIC/],
  ["page.html", text("<!doctype html><html><body>404</body></html>"), /document type/],
  ["readme.txt", text("Some words: of no: use"), /an unknown format/],
  ["notes.txt", text("Date: Monday\nPlace: the lab\nFrames: 12\n"), /: it is text in an unknown format$/],
  ["list.txt", text("- bring the board\n- 2 lamps\n"), /: it is text in an unknown format$/],
  ["settings.yaml", text("exposure: 5\ngain: 2\ndepths: [1, 2]\n"), /it is YAML, but holds neither a camera/],

  [
    "signature.png",
    png({ width: 1, height: 1, depth: 8, colourType: 2, rows: [[1, 2, 3]] }).slice(0, 8),
    /cut off: its end is missing/,
  ],
  ["cut.png", cut("depth-cv.png", 60), /PNG is cut off/],
  ["checksum.png", changed("depth-cv.png", [-16, 0x55]), /checksum of its chunk IDAT is wrong/],
  ["none.png", pngOf(ihdr(0, 5), idat(1)), /invalid size 0x5/],
  ["wide.png", pngOf(ihdr(5000, 1), idat(15_001)), /5000x1 pixels; up to 4096/],
  ["promises.png", pngOf(ihdr(4096, 4096, 16, 6), idat(100)), /cannot inflate to/],
  ["bomb.png", pngOf(ihdr(8, 8), idat(20 * MEGABYTE)), /inflates to more than the 200 bytes/],
  ["stored.png", pngOf(ihdr(8, 8), chunk("IDAT", Buffer.alloc(MEGABYTE))), /longer than the raw/],
  ["short.png", pngOf(ihdr(8, 8), idat(150)), /inflates to 150 of 200 bytes/],
  ["type.png", pngOf(ihdr(8, 8, 8, 5), idat(200)), /unknown colour type 5/],
  ["filter.png", pngOf(ihdr(1, 1), chunk("IDAT", deflateSync(Buffer.from([9, 1, 2, 3])))), /PNG is damaged: .*filter/],
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
  ["wide.npy", npy({ descr: "|u1", shape: [1, 5000], data: new Uint8Array(5000) }), /5000x1 pixels/],
  [
    "two.npy",
    npy({ descr: "<f4", shape: [1, 1, 2], data: new Float32Array(2) }),
    /1 channel and a cloud 3, not 2/,
    { as: "depth" },
  ],
  ["holes.npy", npy({ descr: "<f4", shape: [1, 3], data: new Float32Array([0, -1, NaN]) }), /no valid depth/],

  ["cut.pgm", text("P5\n4 4\n65535\nabc"), /PGM is cut off: 3 of 32 bytes/],
  ["words.pgm", text("P2\nfour 4\n255\n"), /"four" where a width is needed/],
  ["level.pgm", text("P2\n2 1\n255\n1 300\n"), /its level 1 is "300"/],
  ["few.pgm", text("P2\n2 2\n255\n1 2 3\n"), /cut off: 3 of 4 levels/],
  ["most.ppm", text("P6\n1 1\n70000\nabcdef"), /maximum level is 70000/],
  ["huge.ppm", text("P6\n4000 4000\n255\nabc"), /cut off: 3 of 48000000 bytes/],
  ["endless.ppm", text("P6\n999999999 1\n255\n"), /999999999x1 pixels/],
  ["map.pam", text("P7\nWIDTH 1\nENDHDR\n"), /netpbm's P7/],
  ["cut.pfm", text("Pf\n4 4\n-1.0\nabc"), /PFM is cut off/],
  ["scale.pfm", text("Pf\n1 1\n0\nabcd"), /no scale/],

  ["head.tif", text("II*\x00"), /lies beyond its end/],
  ["nowhere.tif", bytes([0x49, 0x49, 42, 0], u32(0xffffff)), /lies beyond its end/],
  ["cut.tif", cut("depth-float-zlib.tif", 300), /TIFF|lies beyond its end/],
  ["big.tif", cut("depth-bigtiff.tif", 40), /lies beyond its end/],
  ["tags.tif", bytes([0x49, 0x49, 43, 0, 8, 0, 0, 0], u32(16, 0, 0xffffffff, 0xffff)), /TIFF has \d+ tags/],
  ["kind.tif", changed("depth-16-None.tif", [2, 44]), /not supported/],
  ["zstd.tif", tiff(tiffTags(4096, 4096, { 259: 50000, 273: 110, 279: 8 }), zstdOf(2 ** 31)), /damaged|cut off/],
  ["lerc.tif", tiff(tiffTags(4, 4, { 259: 34887, 273: 110, 279: 100 }), lercOf({ width: 2 ** 15 })), /kind of LERC/],
  [
    "lerc-none.tif",
    tiff(tiffTags(4, 4, { 259: 34887, 273: 110, 279: 100 }), lercOf({ length: 0 })),
    /lies beyond its end/,
  ],
  ["lerc-block.tif", tiff(tiffTags(4, 4, { 259: 34887, 273: 110, 279: 100 }), lercOf({ block: 0 })), /kind of LERC/],
  ["lzma.tif", tiff(tiffTags(4, 4, { 259: 34925, 279: 20 }), new Uint8Array(200)), /compressed with LZMA/],
  ["promises.tif", tiff(tiffTags(4096, 4096)), /cut off: \d+ of \d+ bytes/],
  ["wide.tif", tiff(tiffTags(70_000, 1)), /70000x1 pixels/],
  ["fat.tif", tiff(tiffTags(4096, 4096, { 258: 64, 277: 4, 339: 3 })), /too large/],
  ["strips.tif", tiff(tiffTags(100, 100, { 278: 1 })), /lists 1 strips or tiles; 100 are needed/],
  ["rows.tif", tiff(tiffTags(4, 4, { 278: 0 })), /strips without rows/],
  ["lzw.tif", tiff(tiffTags(4, 4, { 259: 5, 279: 20 }), new Uint8Array(200).fill(0xff)), /TIFF is damaged/],
  ["bits.tif", tiff(tiffTags(4, 4, { 258: 12 })), /12-bit samples/],
  ["predictor.tif", tiff(tiffTags(4, 4, { 317: 7 })), /predictor 7/],
  ["palette.tif", tiff(tiffTags(4, 4, { 262: 3 })), /palette/],

  ["cut.exr", cut("depth-zip.exr", 250), /EXR|lies beyond its end/],
  ["b44.exr", cut("large-b44.exr", 600), /EXR is cut off or damaged/],
  ["dwa.exr", cut("large-dwaa-depth.exr", 1500), /EXR is cut off or damaged/],
  ["types.exr", packed("colour-and-depth.exr", 4), /mixed types/],
  ["piz.exr", changed("large-piz-half.exr", [-200, 0], [-201, 0], [-202, 0], [-700, 255]), /EXR|damaged/],
  ["order.exr", exr(twice, "large-pxr24-float.exr"), /one of its blocks is missing/],
  ["bomb.exr", bombOf("large-pxr24-float.exr"), /inflates to more than the 4096 bytes/],
  ["tiled.exr", exr((file) => (file[5] = 2)), /tiled/],
  [
    "window.exr",
    exr((_, view, at) => view.setInt32(at("dataWindow\0box2i\0") + 12, 100_000, true)),
    /100001x12 pixels/,
  ],
  ["block.exr", exr((_, view) => view.setInt32(table(view) + 12, 2 ** 30, true)), /damaged in its block 0/],
  ["table.exr", exr((_, view) => view.setUint32(table(view) + 4, 255, true)), /lies beyond its end/],

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
    /grid refers to point 7 of 1/,
  ],
  ["behind.ply", ply(4, "1 2 -3\n".repeat(4), "obj_info num_cols 2\nobj_info num_rows 2\n"), /behind the camera/],
  ["cut.pcd", pcd({}, "1 2 3 4"), /PCD is cut off/],
  ["data.pcd", text("VERSION 0.7\nFIELDS x y z\n"), /no DATA/],
  ["fields.pcd", pcd({ FIELDS: "a b c" }, "1 2 3 ".repeat(4)), /no floating-point field x/],
  ["sizes.pcd", pcd({ SIZE: "4 4" }), /size, type and count/],
  ["points.pcd", pcd({ POINTS: "5" }), /5 points in 2x2/],
  ["many.pcd", pcd({ WIDTH: "99999", HEIGHT: "99999", POINTS: "999999999" }), /PCD declares|points/],
  ["unorganised.pcd", pcd({ WIDTH: "4", HEIGHT: "1" }), /not in rows and columns/],
  ["packed.pcd", pcd({ DATA: "binary_compressed" }, u32(10, 999)), /999 bytes of points, but 48 are needed/],
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
  ["wide.jpg", jpeg(60_000, 10), /60000x10 pixels/],
  ["cmyk.jpg", fixture("colour-cmyk.jpg"), /CMYK/],
  ["lossless.jpg", jpeg(8, 8, { kind: 0xc3 }), /lossless/],
  ["twelve.jpg", jpeg(8, 8, { bits: 12 }), /12 bits/],
  ["scans.jpg", jpeg(8, 8, { scans: 100 }), /more than 64 scans/],
  ["parts.jpg", bytes([0xff, 0xd8], ...Array(6000).fill([0xff, 0xe1, 0, 2])), /more than 5000 segments/],
  ["sampling.jpg", jpeg(8, 8, { sampling: 0xf0 }), /sampling factors/],
  ["tables.jpg", jpeg(8, 8, { tail: new Array(50).fill(7) }), /JPEG is damaged/],
  ["a.webp", fixture("colour.webp"), /browsers only/],
  ["cut.webp", cut("colour.webp", 20), /WebP is cut off/],

  ["cut.json", cut("open3d-intrinsic.json", 60), /JSON is damaged or cut off/],
  ["else.json", text('{"a": [1, 2, {"b": 3}]}'), /neither a camera .* nor a transform/],
  ["deep.json", text("[".repeat(MEGABYTE) + "]".repeat(MEGABYTE)), /damaged|nested deeper/],
  ["deep-objects.json", text('{"a":'.repeat(200_000) + "1" + "}".repeat(200_000)), /damaged|nested deeper/],
  [
    "names.json",
    text(JSON.stringify(Object.fromEntries(Array.from({ length: 100_000 }, (_, at) => [`K_${at}`, at])))),
    /neither a camera/,
  ],
  ["many.json", text(`[${'{"a":{}},'.repeat(60_000)}{}]`), /more than 50000/],
  ["focal.json", text('{"fx": -500, "fy": 500, "cx": 320, "cy": 240}'), /focal lengths -500 and 500/],
  ["half.json", text('{"fx": 500, "cx": 320}'), /fx and cx, but not fy and cy/],
  [
    "side.yaml",
    text("image_width: 640\ncamera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}\n"),
    /only the width of its images, 640/,
  ],
  ["rotation.json", text('{"R": [[1,0,0],[0,1,0],[0,0,2]], "t": [0,0,0]}'), /its matrix is not a rotation/],
  ["translation.json", text('{"R": [[1,0,0],[0,1,0],[0,0,1]], "t": [0,0]}'), /its t has 2 numbers/],
  [
    "quaternion.json",
    text('{"rotation": {"x":0,"y":0,"z":0,"w":2}, "translation": {"x":0,"y":0,"z":0}}'),
    /quaternion has the length 2/,
  ],
  ["laughs.yaml", text(laughs), /an unknown format|neither a camera/],
  ["cut.yaml", cut("opencv.yaml", 150), /as YAML|neither a camera/],
  ["twice.yaml", text("K: 1\nK: 2\n"), /as YAML/],
  ["nested.yaml", text(`K: ${"[".repeat(40)}${"]".repeat(40)}`), /as YAML: nesting/],
  ["aliases.yaml", text(`x: &a 1\ny: [${Array(65).fill("*a").join(", ")}]`), /as YAML/],
  ["open.yaml", text(`K: [${"1,".repeat(2 ** 17 - 8)}`), /as YAML/],
  ["words.yaml", text(`K: [${"a\n".repeat(2 ** 17 - 8)}`), /as YAML/],
  [
    "omni.yaml",
    text("cam0:\n  camera_model: omni\n  intrinsics: [1, 2, 3, 4, 5]\n  distortion_model: radtan\n"),
    /the model "omni"/,
  ],
  ["four.yaml", text("cam0:\n  camera_model: pinhole\n  intrinsics: [1, 2, 3]\n"), /3 intrinsics/],
  [
    "K.yaml",
    text("camera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 500, 240, 1, 1, 1]\n"),
    /not a matrix of intrinsics/,
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
  ["nan.txt", text("500 0 nan\n0 500 240\n0 0 1\n"), /it has nan or inf/],
  ["mirror.txt", text("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n"), /mirrors/],
  ["last.txt", text("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n"), /not in 0 0 0 1/],
  ["numbers.txt", text("1.5 ".repeat(500_000)), /more than 200000 numbers/],
  // Many digits that form no number. A pattern that can match digits in two ways would take time quadratic in their number.
  ["digits.txt", text(`${"1".repeat(200_000)}${"e".repeat(200_000)}`), /in an unknown format/],
  ["digits.json", text(`{"fx":"${"1".repeat(200_000)}x","fy":1,"cx":1,"cy":1}`), /fx|camera/],
  ["digits.yaml", text(`fx: ${"1".repeat(200_000)}x\nfy: 1\ncx: 1\ncy: 1\n`), /fx|camera|none/],
  ["cameras.txt", text("1 PINHOLE 640 480 500 320 240\n"), /needs 4 numbers, but has 3/],
  ["model.txt", text("1 FOV 640 480 500 500 320 240 0.1\n"), /model FOV/],
  ["line.txt", text("1 PINHOLE 640 480 500 500 320 240\nno camera\n"), /a line that is not a camera/],
  [
    "streams.txt",
    text('Extrinsic from "Depth" To "Color" :\n Rotation Matrix:\n 1 0 0\n'),
    /from "Depth" to "Color" have 3 numbers/,
  ],
  ["publisher.txt", text("static_transform_publisher 1 2 3\n"), /3 numbers/],
  ["publisher2.txt", text("static_transform_publisher without numbers\n"), /no numbers follow/],
  ["long.txt", text("a: ".padEnd(600_000, "b")), /in an unknown format/],
  ["quotes.txt", text(`"${"\\".repeat(300_000)}`), /an unknown format/],
];

const ALL = [...FILES, ...PICTURES, ...CALIBRATIONS, ...BINARIES];

/** Checks that a reading is refused with a BimodalError "file" that names the file and matches the pattern, or has this warning. */
async function isTold(reading, name, outcome) {
  if (outcome instanceof RegExp) return refusedFile(reading, name, outcome);
  const { warnings } = await reading;
  assert.ok(codes({ warnings }).includes(outcome), JSON.stringify(warnings));
}
const titled = (name, outcome) => `${name}: ${outcome instanceof RegExp ? outcome.source : outcome}`;

describe("malformed and odd files", () => {
  test(`there are ${ALL.length} and ${RECORDINGS.length} recordings, each with a name of its own`, () => {
    assert.ok(ALL.length >= 280 && RECORDINGS.length >= 35);
    const names = [...ALL, ...RECORDINGS].map(([name]) => name);
    assert.equal(new Set(names).size, names.length);
  });

  for (const [name, content, outcome, options] of ALL)
    test(titled(name, outcome), () =>
      inRoom(name, () => inTime(name, () => isTold(readRigFile({ name, bytes: content }, options), name, outcome))),
    );

  for (const [name, make, outcome] of RECORDINGS)
    test(titled(name, outcome), async () => {
      const content = await make();
      const reading = async () => (await openRecording({ name, content })).read();
      await inRoom(name, () => inTime(name, () => isTold(reading(), name, outcome)));
    });
});

test("no file took a gigabyte", assertSmall);
