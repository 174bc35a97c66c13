// Small depth maps, pictures, masks and scans in the formats of products, by the keys of js/rig/formats/catalogue.
import { zipSync } from "fflate";
import { H, W, fixture, millimetres, text } from "./rig-support.mjs";
import { spinning } from "./scanners.mjs";
import { npy, png } from "./support.mjs";

const made = (file, name = file, options) => ({ name, bytes: fixture(file), ...(options && { options }) });
const join = (...parts) =>
  new Uint8Array(
    Buffer.concat(parts.map((part) => Buffer.from(part.buffer ?? part, part.byteOffset, part.byteLength))),
  );
const levels = Uint16Array.from(millimetres);
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
/** Size of depth maps, large enough for a table or a colour code to be recognised. */
const [COLUMNS, ROWS] = [64, 48];
const depthAt = (x, y) => 900 + 13 * x + 5 * y;
const grid = (value) => Array.from({ length: ROWS }, (_, y) => Array.from({ length: COLUMNS }, (_, x) => value(x, y)));

/** Metres in CARLA's code: 24 bits of 1000 m, with the lowest byte in red. */
const carla = (x, y) => {
  const code = Math.round(((2 + 0.05 * x + 0.02 * y) / 1000) * (2 ** 24 - 1));
  return [code & 255, (code >> 8) & 255, code >> 16];
};
const levelsOf = (value) => [value >> 8, value & 255];
const maps = {
  "depth-png": made("depth-cv.png"),
  "depth-kitti": {
    name: "proj_depth/groundtruth/image_02/0000000005.png",
    bytes: png({
      width: COLUMNS,
      height: ROWS,
      depth: 16,
      colourType: 0,
      rows: grid((x, y) => levelsOf(256 * 4 + 40 * x + 7 * y)).map((row) => row.flat()),
    }),
    options: { as: "depth" },
  },
  "depth-carla": {
    name: "depth/0001.png",
    bytes: png({ width: COLUMNS, height: ROWS, depth: 8, colourType: 2, rows: grid(carla).map((row) => row.flat()) }),
  },
  "depth-pgm": made("depth-cv.pgm"),
  "depth-pfm": made("depth-cv.pfm"),
  "depth-tiff": made("depth-16-zlib.tif"),
  "depth-exr": made("depth-zip.exr"),
  "depth-exr-others": made("large-dwaa-depth.exr"),
  "depth-npy": { name: "depth.npy", bytes: npy({ descr: "<u2", shape: [H, W], data: levels }) },
  "depth-npz": {
    name: "frame.npz",
    bytes: zipSync({ "depth.npy": npy({ descr: "<u2", shape: [H, W], data: levels }) }),
  },
  "depth-table": {
    name: "depth.csv",
    bytes: text(
      grid(depthAt)
        .map((row) => row.join(","))
        .join("\n"),
    ),
  },
  "depth-raw": { name: "depth.raw", bytes: bytesOf(levels), options: { size: [W, H] } },
  "depth-colmap": {
    name: "stereo/depth_maps/0001.png.geometric.bin",
    bytes: join(
      text(`${W}&${H}&1&`),
      Float32Array.from(millimetres, (value) => value / 1000),
    ),
  },
  "cloud-pcd": made("cloud-binary.pcd"),
  "cloud-ply": made("cloud-binary.ply"),
};

const images = {
  "colour-png": made("colour-srgb.png"),
  "colour-jpeg": made("colour.jpg"),
  "colour-turned": made("turned-6.jpg"),
  "colour-ppm": made("colour-cv.ppm"),
  "colour-tiff": made("colour.tif"),
  "colour-exr": made("large-piz-colours.exr"),
  "colour-webp": made("colour.webp"),
  "colour-heic": {
    name: "IMG_0001.HEIC",
    bytes: join(new Uint8Array([0, 0, 0, 24]), text("ftypheic"), new Uint8Array(16)),
  },
  mask: {
    name: "mask_0001.png",
    bytes: png({ width: COLUMNS, height: ROWS, depth: 8, colourType: 0, rows: grid((x) => (x > 20 ? 255 : 0)) }),
  },
};

const SCAN = spinning({ lasers: 16, step: 2 });
const COUNT = SCAN.ring.length;
const interleaved = (...others) =>
  Float32Array.from({ length: COUNT * (3 + others.length) }, (_, at) => {
    const [point, column] = [Math.floor(at / (3 + others.length)), at % (3 + others.length)];
    return column < 3 ? SCAN.points[3 * point + column] : others[column - 3](point);
  });
const ring = (point) => SCAN.ring[point];
const half = () => 0.5;

function las() {
  const view = new DataView(new ArrayBuffer(227 + 20 * COUNT));
  [..."LASF"].forEach((letter, at) => view.setUint8(at, letter.charCodeAt(0)));
  view.setUint8(24, 1);
  view.setUint8(25, 2);
  view.setUint16(94, 227, true);
  view.setUint32(96, 227, true);
  view.setUint16(105, 20, true);
  view.setUint32(107, COUNT, true);
  for (let axis = 0; axis < 3; axis++) view.setFloat64(131 + 8 * axis, 0.001, true);
  for (let point = 0; point < COUNT; point++)
    for (let axis = 0; axis < 3; axis++)
      view.setInt32(227 + 20 * point + 4 * axis, Math.round(1000 * SCAN.points[3 * point + axis]), true);
  return new Uint8Array(view.buffer);
}
const head = (first, more = []) => join(text(first), new Uint8Array([...more, ...Array(32).fill(0)]));
const scans = {
  "scan-pcd": {
    name: "scan.pcd",
    bytes: join(
      text(
        `VERSION 0.7\nFIELDS x y z ring\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH ${COUNT}\nHEIGHT 1\nPOINTS ${COUNT}\nDATA binary\n`,
      ),
      interleaved(ring),
    ),
  },
  "scan-ply": {
    name: "scan.ply",
    bytes: join(
      text(
        `ply\nformat binary_little_endian 1.0\nelement vertex ${COUNT}\n${["x", "y", "z", "scalar_Intensity"].map((name) => `property float ${name}\n`).join("")}end_header\n`,
      ),
      interleaved(half),
    ),
  },
  "scan-las": { name: "scan.las", bytes: las() },
  "scan-laz": made("scan-1.laz"),
  "scan-kitti": { name: "velodyne/000000.bin", bytes: bytesOf(interleaved(half)) },
  "scan-nuscenes": {
    name: "LIDAR_TOP__1532402927647951.pcd.bin",
    bytes: bytesOf(interleaved((point) => point % 256, ring)),
  },
  "scan-xyz": {
    name: "scan.xyz",
    bytes: text(
      Array.from({ length: COUNT }, (_, at) => [...SCAN.points.subarray(3 * at, 3 * at + 3)].join(" ")).join("\n"),
    ),
  },
  "scan-columns": {
    name: "frame.csv",
    bytes: text(
      [
        '"intensity","laser_id","timestamp","Points_m_XYZ:0","Points_m_XYZ:1","Points_m_XYZ:2"',
        ...Array.from({ length: COUNT }, (_, at) =>
          [at % 100, SCAN.ring[at], 3600000 + at, ...SCAN.points.subarray(3 * at, 3 * at + 3)].join(","),
        ),
      ].join("\n"),
    ),
  },
  "scan-npy": { name: "scan.npy", bytes: npy({ descr: "<f4", shape: [COUNT, 4], data: interleaved(half) }) },
  "scan-e57": { name: "scan.e57", bytes: head("ASTM-E57") },
  "scan-pcap": { name: "scan.pcap", bytes: head("", [0xd4, 0xc3, 0xb2, 0xa1]) },
  "scan-ouster": { name: "scan.osf", bytes: head("", [16, 0, 0, 0, 79, 83, 70, 33]) },
  "scan-livox": { name: "scan.lvx", bytes: head("livox_tech") },
};

export const PICTURE_SAMPLES = { ...maps, ...images, ...scans };
