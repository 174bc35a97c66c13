// Recordings that are malformed on purpose: containers with false records, and valid containers with false messages.
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { bytes, u32 } from "./malformed.mjs";
import { START, frames, recorded } from "./recorded.mjs";
import { FRAMES, headerOf, lz4Frame, matroska, mcap } from "./recordings.mjs";
import { text } from "./rig-support.mjs";

const fixture = (name) =>
  new Uint8Array(readFileSync(fileURLToPath(new URL(`../fixtures/recordings/${name}`, import.meta.url))));
const copy = (buffer) => Uint8Array.from(buffer);
/** A changed copy of a file. */
const changed = (file, change) => {
  const own = copy(file);
  change(new DataView(own.buffer), own);
  return own;
};

const plain = () => mcap(recorded({}, 2));
const packed = (compression, data) => () =>
  mcap(recorded({}, 2), { compressChunk: (chunk) => ({ compression, compressedData: data(chunk) }) });

/** The records of a kind in an undamaged MCAP file, by their opcode: [offset, length]. */
function recordsOf(file, wanted) {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const found = [];
  for (let at = 8; at + 9 < file.length - 8; ) {
    const length = Number(view.getBigUint64(at + 1, true));
    if (view.getUint8(at) === wanted) found.push([at, length]);
    at += 9 + length;
  }
  return found;
}
const [SCHEMA, CHANNEL, CHUNK] = [0x03, 0x04, 0x06];
/** An MCAP file whose first record of a kind is changed; `at` is the offset of its content. */
const record = (opcode, change, options) => async () => {
  const file = copy(await mcap(recorded({}, 2), options));
  const [first] = recordsOf(file, opcode);
  return changed(file, (view, own) => change(view, first[0] + 9, own, first));
};
const COLOUR = "/camera/color/image_raw";
const DEPTH = "/camera/depth/image_raw";
/** A recording with the messages of a topic changed. */
const messages = (topic, change) => () =>
  mcap(recorded({}, 2).map((each) => (each.topic === topic ? { ...each, message: change(each.message) } : each)));
const cloud = (more) => () =>
  mcap([
    ...recorded({}, 1).filter(({ topic }) => topic !== DEPTH),
    {
      topic: "/points",
      type: "sensor_msgs/PointCloud2",
      time: START + 0.1,
      message: {
        ...{ header: headerOf(START + 0.1, FRAMES.depth), width: 16, height: 12, is_bigendian: false, is_dense: false },
        fields: ["x", "y", "z"].map((name, at) => ({ name, offset: 4 * at, datatype: 7, count: 1 })),
        ...{ point_step: 12, row_step: 192, data: new Uint8Array(12 * 192) },
        ...more,
      },
    },
  ]);
const mkv = () => matroska(frames(2), "{}");
/** Offset of an element's id in a Matroska file. */
const element = (file, id) => Buffer.from(file).indexOf(Buffer.from(id));

/** File name, a function that makes its bytes, and a pattern for the error, or the code of a warning if the rest is usable. */
export const RECORDINGS = [
  ["empty.mcap", async () => new Uint8Array(0), /not a supported recording/],
  ["magic.mcap", async () => bytes([0x89], text("MCAP0\r\n")), /holds no messages/],
  ["noise.mcap", async () => bytes([0x89], text("MCAP0\r\n"), new Uint8Array(4000).fill(0xa5)), /is too large/],
  ["middle.mcap", async () => (await plain()).subarray(0, 2000), /holds no messages/],
  ["chunk-crc.mcap", record(CHUNK, (view, at) => view.setUint32(at + 24, 0x12345678, true)), /Incorrect chunk CRC/],
  ["chunk-length.mcap", record(CHUNK, (view, at) => view.setBigUint64(at - 8, 2n ** 63n, true)), /is too large/],
  [
    "channel.mcap",
    record(CHANNEL, (view, at) => view.setUint16(at + 2, 999, true), { chunks: false }),
    "transform-missing",
  ],
  [
    "names.mcap",
    record(SCHEMA, (view, at) => view.setUint32(at + 2, 0xffffffff, true), { chunks: false }),
    /exceeds bounds/,
  ],
  ["lz4.mcap", packed("lz4", (chunk) => lz4Frame(chunk).fill(0xff, 20, 60)), /CRC|LZ4/],
  [
    "lz4-bomb.mcap",
    packed("lz4", () =>
      bytes(u32(0x184d2204), [0x60, 0x70, 0x73], u32(8), [0x1f, 0, 1, 0, 255, 255, 255, 255], u32(0)),
    ),
    /damaged \(LZ4\)/,
  ],
  ["zstd.mcap", packed("zstd", () => new Uint8Array(100)), /invalid zstd/],
  ["other.mcap", packed("brotli", (chunk) => chunk), /Unsupported compression brotli/],

  [
    "image-size.mcap",
    messages(COLOUR, (m) => ({ ...m, width: 2 ** 31 - 1, height: 2 ** 31 - 1 })),
    /2147483647x2147483647/,
  ],
  ["image-short.mcap", messages(COLOUR, (m) => ({ ...m, data: m.data.subarray(0, 10) })), /10 of 576 bytes/],
  ["image-encoding.mcap", messages(COLOUR, (m) => ({ ...m, encoding: "" })), /stored as ""/],
  ["depth-none.mcap", messages(DEPTH, (m) => ({ ...m, data: new Uint8Array(m.data.length) })), /no valid depth/],
  [
    "depth-zero.mcap",
    messages(DEPTH, (m) => ({ ...m, width: 0, height: 0, data: new Uint8Array(0) })),
    /invalid size 0x0/,
  ],
  [
    "info.mcap",
    messages("/camera/color/camera_info", (m) => ({ ...m, k: m.k.map(() => NaN), p: m.p.map(() => NaN) })),
    "colour-camera-missing",
  ],
  [
    "turn.mcap",
    messages("/tf_static", ({ transforms }) => ({
      transforms: transforms.map((each) => ({
        ...each,
        transform: { ...each.transform, rotation: { x: 0, y: 0, z: 0, w: 0 } },
      })),
    })),
    /quaternion has the length 0\.00/,
  ],
  ["cloud-step.mcap", cloud({ point_step: 0 }), /beyond the bytes of its point/],
  [
    "cloud-field.mcap",
    cloud({ fields: [{ name: "x", offset: 0xfffffff0, datatype: 7, count: 1 }] }),
    /beyond the bytes of its point/,
  ],
  ["cloud-size.mcap", cloud({ width: 2 ** 31, height: 2 ** 31 - 1 }), /2147483648x2147483647/],
  [
    "cloud-type.mcap",
    cloud({ fields: ["x", "y", "z"].map((name) => ({ name, offset: 0, datatype: 99, count: 1 })) }),
    /no floating-point field x/,
  ],

  ["head.bag", async () => text("#ROSBAG V2.0\n"), /rosbag reindex/],
  [
    "open.bag",
    async () => changed(fixture("depth-none.bag"), (view) => view.setBigUint64(26, 0n, true)),
    /rosbag reindex/,
  ],
  ["cut.bag", async () => fixture("depth-none.bag").subarray(0, 6000), /rosbag reindex/],
  [
    "record.bag",
    async () => changed(fixture("depth-none.bag"), (view) => view.setUint32(13, 0xfffffff0, true)),
    /rosbag reindex/,
  ],
  ["bz2.bag", async () => changed(fixture("depth-bz2.bag"), (_, own) => own.fill(0xa5, 4300, 4500)), /Data error/],
  ["lz4.bag", async () => changed(fixture("walk-lz4.bag"), (_, own) => own.fill(0xff, 4400, 4500)), /LZ4/],

  ["head.mkv", async () => mkv().subarray(0, 40), /holds no pictures/],
  ["cut.mkv", async () => mkv().subarray(0, 700), /depth maps/],
  ["zero.mkv", async () => bytes([0x1a, 0x45, 0xdf, 0xa3, 0x80], new Uint8Array(500)), /holds no pictures/],
  [
    "size.mkv",
    async () =>
      changed(mkv(), (_, own) =>
        own.fill(0xfe, element(own, [0x16, 0x54, 0xae, 0x6b]) + 5, element(own, [0x16, 0x54, 0xae, 0x6b]) + 12),
      ),
    /holds no pictures/,
  ],
  [
    "codec.mkv",
    async () => changed(mkv(), (_, own) => own.set(text("V_NONE/AT/ALL/"), element(own, text("V_MS/VFW")))),
    /V_NONE/,
  ],
  ["calibration.mkv", async () => matroska(frames(2), '{"CalibrationInformation": {"Cameras": [{'), "file-left-out"],
  [
    "pictures.mkv",
    async () =>
      changed(mkv(), (_, own) => {
        for (
          let at = element(own, [0xff, 0xd8, 0xff]);
          at >= 0 && at < own.length;
          at = Buffer.from(own).indexOf(Buffer.from([0xff, 0xd8, 0xff]), at + 1)
        )
          own[at + 1] = 0;
      }),
    /JPEG is damaged/,
  ],
];
