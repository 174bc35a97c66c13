// More pictures and clouds that are malformed on purpose: inverted windows, tables that point at themselves, excessive colour counts.
import { deflateSync } from "node:zlib";
import { MEGABYTE, bytes, chunk, exr, idat, ihdr, jpeg, pcd, ply, pngOf, tiff, tiffTags, u32 } from "./malformed.mjs";
import { fixture, text } from "./rig-support.mjs";

/** A complete JPEG with a segment inserted after its first marker. */
const withSegment = (mark, content) => {
  const file = fixture("colour.jpg");
  const length = content.length + 2;
  return bytes(file.subarray(0, 2), [0xff, mark, length >> 8, length & 255], content, file.subarray(2));
};
const small = (...before) =>
  pngOf(
    ihdr(2, 2, 8, 2),
    ...before,
    chunk("IDAT", deflateSync(Buffer.from([0, 9, 9, 9, 9, 9, 9, 0, 9, 9, 9, 9, 9, 9]))),
  );
const be32 = (...values) =>
  Buffer.from(values.flatMap((value) => [value >>> 24, value >> 16, value >> 8, value].map((byte) => byte & 255)));
const swappedTiff = () => {
  const file = tiff(tiffTags(4, 4), new Uint8Array(200));
  file.set([0x4d, 0x4d]);
  return file;
};

/** File name, bytes, and a pattern for the error, or the code of a warning if the rest of the file is usable. */
export const PICTURES = [
  [
    "length.png",
    bytes(pngOf().subarray(0, 8), be32(0x7fffffff), text("IHDR"), new Uint8Array(64)),
    /in its chunk "IHDR"/,
  ],
  [
    "negative.png",
    bytes(pngOf().subarray(0, 8), be32(0xffffffff), text("IHDR"), new Uint8Array(64)),
    /in its chunk "IHDR"/,
  ],
  ["twice.png", pngOf(ihdr(2, 2), ihdr(4000, 4000), idat(14)), /cannot inflate to the 48004000/],
  ["interlace.png", pngOf(ihdr(8, 8, 8, 2, 7), idat(200)), /an unknown compression, filter or interlace method/],
  ["depth.png", pngOf(ihdr(8, 8, 7, 0), idat(200)), /7 bits per channel/],
  ["sixteen.png", pngOf(ihdr(8, 8, 16, 3), chunk("PLTE", Buffer.alloc(3)), idat(200)), /16 bits per channel/],
  ["colours.png", pngOf(ihdr(1, 1, 8, 3), idat(2)), /palette is missing/],
  [
    "index.png",
    pngOf(ihdr(1, 1, 8, 3), chunk("PLTE", Buffer.alloc(3)), chunk("IDAT", deflateSync(Buffer.from([0, 200])))),
    /no colour 200/,
  ],
  [
    "profile.png",
    small(chunk("iCCP", Buffer.concat([Buffer.from("p\0\0"), deflateSync(Buffer.alloc(200, 0xff))]))),
    "colour-profile-ignored",
  ],

  ["icc.jpg", withSegment(0xe2, bytes(text("ICC_PROFILE\0"), [1, 255], new Uint8Array(100))), "colour-profile-ignored"],
  ["huffman.jpg", withSegment(0xc4, new Uint8Array(17).fill(255)), /Huffman/],
  ["quantum.jpg", withSegment(0xdb, [0x0f, 1, 2]), /damaged or cut off/],
  ["none.jpg", jpeg(8, 8, { channels: 0 }), /0 channels/],
  ["tall.jpg", jpeg(8, 0), /invalid size 8x0/],
  ["segment.jpg", bytes([0xff, 0xd8, 0xff, 0xe0, 0, 0]), /no pixels/],

  ["order.tif", swappedTiff(), /format is not supported/],
  ["circle.tif", bytes(tiff(tiffTags(4, 4, { 330: 8, 34665: 8 }), u32(8)), new Uint8Array(300)), /no valid depth/],
  ["samples.tif", tiff(tiffTags(4, 4, { 277: 65_535 }), new Uint8Array(300)), /65535 channels/],
  ["none.tif", tiff(tiffTags(4, 4, { 258: 0 }), new Uint8Array(300)), /0-bit samples/],
  ["jpeg.tif", tiff(tiffTags(4, 4, { 259: 7, 279: 20 }), new Uint8Array(300)), /compressed with JPEG/],
  ["tile.tif", tiff(tiffTags(4, 4, { 322: 0, 323: 0, 324: 200, 325: 32 }), new Uint8Array(300)), /invalid size 0x0/],
  ["complex.tif", tiff(tiffTags(4, 4, { 339: 6 }), new Uint8Array(300)), /samples of format 6/],
  ["negative.tif", tiff(tiffTags(0xffffffff, 0xffffffff), new Uint8Array(300)), /4294967295x4294967295/],

  [
    "inside-out.exr",
    exr((_, view, at) => view.setInt32(at("dataWindow\0box2i\0") + 12, -100, true)),
    /invalid size -99x12/,
  ],
  [
    "overflow.exr",
    exr((_, view, at) => {
      view.setInt32(at("dataWindow\0box2i\0") + 4, -(2 ** 31), true);
      view.setInt32(at("dataWindow\0box2i\0") + 12, 2 ** 31 - 1, true);
    }),
    /4294967296x12/,
  ],
  ["attribute.exr", exr((_, view, at) => view.setInt32(at("channels\0chlist\0"), -1, true)), /in its header/],
  [
    "attribute-size.exr",
    exr((_, view, at) => view.setInt32(at("channels\0chlist\0"), 2 ** 31 - 1, true)),
    /in its header/,
  ],
  ["compression.exr", exr((file, _, at) => (file[at("compression\0compression\0") + 4] = 99)), /unknown method/],
  ["version.exr", exr((file) => (file[4] = 99)), /unknown version 99/],
  ["parts.exr", exr((file) => (file[5] = 0x10)), /several parts/],
  ["deep.exr", exr((file) => (file[5] = 0x08)), /deep/],

  ["size.pfm", text("Pf\n-4 4\n-1.0\n"), /"-4" where a width/],
  ["nan.pfm", text("Pf\n4 4\nnan\n"), /no scale/],
  ["huge.pfm", text("Pf\n1e9 1e9\n-1.0\n"), /"1e9" where a width/],
  ["comment.pgm", text(`P5\n${"# more\n".repeat(50_000)}`), /where a width is needed/],
  ["levels.pgm", text("P5\n4 4\n-1\n"), /"-1" where a maximum/],

  [
    "list.ply",
    bytes(
      text("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uint float x\nend_header\n"),
      u32(0xffffffff),
    ),
    /no x, y and z/,
  ],
  [
    "count.ply",
    text("ply\nformat ascii 1.0\nelement vertex -1\nproperty float x\nend_header\n"),
    /the invalid count "-1"/,
  ],
  ["nan.ply", ply(300, "nan nan nan\n".repeat(300)), /no measured point/],
  ["header.ply", text(`ply\n${"comment x\n".repeat(200_000)}`), /header has no end/],
  [
    "properties.ply",
    text(
      `ply\nformat ascii 1.0\nelement vertex 1\n${Array.from({ length: 20_000 }, (_, at) => `property float p${at}`).join("\n")}\nend_header\n1\n`,
    ),
    /more than 100 properties/,
  ],
  [
    "endian.ply",
    bytes(
      text(
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
      ),
      new Uint8Array(47),
    ),
    /47 of 48 bytes/,
  ],
  ["negative.pcd", pcd({ SIZE: "-4 4 4" }), /x with the invalid size -4/],
  ["count.pcd", pcd({ COUNT: "1 1 1000000000" }), /count 1000000000/],
  ["type.pcd", pcd({ TYPE: "X X X" }, "1 2 3 ".repeat(4)), /no floating-point field x/],
  ["width.pcd", pcd({ WIDTH: "nan", HEIGHT: "1e9" }), /WIDTH "nan"/],
  [
    "distance.pcd",
    pcd({ DATA: "binary_compressed" }, bytes(u32(4, 48), [0xff, 0xff, 0xff, 0xff])),
    /compressed points/,
  ],
  ["long.pcd", text(`VERSION 0.7\nFIELDS ${"x ".repeat(500_000)}\n`), /no DATA/],
  ["nan.pcd", pcd({ WIDTH: "300", HEIGHT: "1", POINTS: "300" }, "nan nan nan\n".repeat(300)), /no measured point/],
  ["noise.png", bytes(pngOf().subarray(0, 8), new Uint8Array(MEGABYTE).fill(0xa5)), /cut off or damaged in its chunk/],
];
