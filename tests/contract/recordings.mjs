// Recordings for tests, made with public writers: messages of ROS 1 and ROS 2, MCAP files, and pictures compressed by image_transport.
import { McapWriter } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter as Ros1Writer } from "@foxglove/rosmsg-serialization";
import { MessageWriter as Ros2Writer } from "@foxglove/rosmsg2-serialization";
import { encode as png } from "fast-png";
import jpeg from "jpeg-js";

const LINE = "=".repeat(80);
/** Definitions as ROS writes them into recordings; `std_msgs/Header` differs between the two generations. */
const PARTS = {
  "std_msgs/Header": {
    ros1: "uint32 seq\ntime stamp\nstring frame_id",
    ros2: "builtin_interfaces/Time stamp\nstring frame_id",
  },
  "builtin_interfaces/Time": { ros2: "int32 sec\nuint32 nanosec" },
  "sensor_msgs/Image": {
    ros1: "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data",
  },
  "sensor_msgs/CompressedImage": { ros1: "std_msgs/Header header\nstring format\nuint8[] data" },
  "sensor_msgs/RegionOfInterest": {
    ros1: "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify",
  },
  "sensor_msgs/CameraInfo": {
    ros1: "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi",
    ros2: "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi",
  },
  "sensor_msgs/PointField": { ros1: "uint8 FLOAT32=7\nstring name\nuint32 offset\nuint8 datatype\nuint32 count" },
  "sensor_msgs/PointCloud2": {
    ros1: "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
  },
  "geometry_msgs/Vector3": { ros1: "float64 x\nfloat64 y\nfloat64 z" },
  "geometry_msgs/Quaternion": { ros1: "float64 x\nfloat64 y\nfloat64 z\nfloat64 w" },
  "geometry_msgs/Transform": { ros1: "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation" },
  "geometry_msgs/TransformStamped": {
    ros1: "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform",
  },
  "tf2_msgs/TFMessage": { ros1: "geometry_msgs/TransformStamped[] transforms" },
  "std_msgs/String": { ros1: "string data" },
  "std_msgs/Float32": { ros1: "float32 data" },
};

/** A type's definition, followed by those of its members. */
export function definitionOf(type, generation) {
  const textOf = (name) => PARTS[name][generation] ?? PARTS[name].ros1;
  const found = [];
  const visit = (name) => {
    for (const [, member] of textOf(name).matchAll(/^([a-z_0-9]+\/\w+)/gm)) {
      if (found.includes(member)) continue;
      found.push(member);
      visit(member);
    }
  };
  visit(type);
  return [textOf(type), ...found.map((name) => `${LINE}\nMSG: ${name}\n${textOf(name)}`)].join("\n");
}

const writers = new Map();
/** A message's bytes. `message` has the names of ROS 2; for ROS 1 they are replaced by its older names. */
export function encoded(type, message, generation) {
  const key = `${generation} ${type}`;
  if (!writers.has(key)) {
    const definition = parse(definitionOf(type, generation), { ros2: generation === "ros2" });
    writers.set(key, generation === "ros2" ? new Ros2Writer(definition) : new Ros1Writer(definition));
  }
  return writers.get(key).writeMessage(generation === "ros2" ? message : older(message));
}

function older(value) {
  if (typeof value !== "object" || value === null || ArrayBuffer.isView(value)) return value;
  if (Array.isArray(value)) return value.map(older);
  if ("nanosec" in value) return { sec: value.sec, nsec: value.nanosec };
  return Object.fromEntries(
    Object.entries(value).map(([name, member]) => [/^[dkrp]$/.test(name) ? name.toUpperCase() : name, older(member)]),
  );
}

const stampOf = (time) => ({ sec: Math.floor(time), nanosec: Math.round((time % 1) * 1e9) });
export const headerOf = (time, frame) => ({ seq: 0, stamp: stampOf(time), frame_id: frame });

/** RGB without alpha. */
function rgbOf({ width, height, data }) {
  const rgb = new Uint8Array(3 * width * height);
  for (let pixel = 0; pixel < width * height; pixel++)
    for (let channel = 0; channel < 3; channel++) rgb[3 * pixel + channel] = data[4 * pixel + channel];
  return rgb;
}

export function imageMessage(image, time, frame, encoding = "rgb8") {
  const { width, height } = image;
  const data = rgbOf(image);
  if (encoding === "bgr8") for (let at = 0; at < data.length; at += 3) data.subarray(at, at + 3).reverse();
  return { header: headerOf(time, frame), width, height, encoding, is_bigendian: 0, step: 3 * width, data };
}

export function depthMessage({ width, height, data }, time, frame) {
  const floats = data instanceof Float32Array;
  return {
    header: headerOf(time, frame),
    width,
    height,
    encoding: floats ? "32FC1" : "16UC1",
    is_bigendian: 0,
    step: (floats ? 4 : 2) * width,
    data: new Uint8Array(data.buffer, data.byteOffset, data.byteLength),
  };
}

export const jpegMessage = ({ width, height, data }, time, frame) => ({
  header: headerOf(time, frame),
  format: "rgb8; jpeg compressed bgr8",
  data: new Uint8Array(jpeg.encode({ width, height, data }, 95).data),
});

/** image_transport's compressedDepth: a header of twelve bytes and a PNG. */
export function compressedDepthMessage({ width, height, data }, time, frame, { quantised } = {}) {
  const head = new DataView(new ArrayBuffer(12));
  if (quantised) [4, 8].forEach((at, index) => head.setFloat32(at, quantised[index], true));
  const body = png({ width, height, data, depth: 16, channels: 1 });
  const bytes = new Uint8Array(12 + body.length);
  bytes.set(new Uint8Array(head.buffer));
  bytes.set(body, 12);
  return {
    header: headerOf(time, frame),
    format: `${quantised ? "32FC1" : "16UC1"}; compressedDepth png`,
    data: bytes,
  };
}

export function infoMessage({ fx, fy, cx, cy, distortion = [] }, { width, height }, time, frame, more = {}) {
  return {
    header: headerOf(time, frame),
    width,
    height,
    distortion_model: distortion.length > 5 ? "rational_polynomial" : "plumb_bob",
    d: Array.from(distortion),
    k: [fx, 0, cx, 0, fy, cy, 0, 0, 1],
    r: [1, 0, 0, 0, 1, 0, 0, 0, 1],
    p: [fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0],
    binning_x: 0,
    binning_y: 0,
    roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false },
    ...more,
  };
}

/** The quaternion of a rotation matrix of nine numbers. */
export function quaternionOf(r) {
  const w = Math.sqrt(Math.max(0, 1 + r[0] + r[4] + r[8])) / 2;
  return { x: (r[7] - r[5]) / (4 * w), y: (r[2] - r[6]) / (4 * w), z: (r[3] - r[1]) / (4 * w), w };
}

export const transform = (parent, child, { rotation, translation: [x, y, z] }, time = 0) => ({
  header: headerOf(time, parent),
  child_frame_id: child,
  transform: { translation: { x, y, z }, rotation: quaternionOf(rotation) },
});

export function cloudMessage({ width, height, points }, time, frame) {
  const step = 20; // The fields are x, y, z, four bytes of padding, and intensity.
  const view = new DataView(new ArrayBuffer(step * width * height));
  for (let point = 0; point < width * height; point++)
    for (let axis = 0; axis < 3; axis++) view.setFloat32(step * point + 4 * axis, points[3 * point + axis], true);
  const field = (name, offset) => ({ name, offset, datatype: 7, count: 1 });
  return {
    header: headerOf(time, frame),
    width,
    height,
    fields: [field("x", 0), field("y", 4), field("z", 8), field("intensity", 16)],
    is_bigendian: false,
    point_step: step,
    row_step: step * width,
    data: new Uint8Array(view.buffer),
    is_dense: false,
  };
}

/** An MCAP file as rosbag2 writes it; `messages` are { topic, type, time, message } or have their own `bytes`. */
export async function mcap(messages, { generation = "ros2", compressChunk, chunks = true, cut = 0 } = {}) {
  const parts = [];
  const writable = {
    position: () => BigInt(parts.reduce((sum, part) => sum + part.length, 0)),
    write: async (bytes) => void parts.push(bytes.slice()),
  };
  const writer = new McapWriter({ writable, useChunks: chunks, chunkSize: 1_000_000, compressChunk });
  await writer.start({ profile: generation, library: "test" });
  const channels = new Map();
  for (const { topic, type, time, message, bytes, encoding, schemaEncoding } of messages) {
    if (!channels.has(topic)) {
      const name = generation === "ros2" ? type.replace("/", "/msg/") : type;
      const definition = type in PARTS ? definitionOf(type, generation) : "string data";
      const schemaId = await writer.registerSchema({
        name,
        encoding: schemaEncoding ?? `${generation}msg`,
        data: new TextEncoder().encode(definition),
      });
      const messageEncoding = encoding ?? (generation === "ros2" ? "cdr" : "ros1");
      channels.set(topic, await writer.registerChannel({ topic, schemaId, messageEncoding, metadata: new Map() }));
    }
    const at = BigInt(Math.round(time * 1e9));
    const data = bytes ?? encoded(type, message, generation);
    await writer.addMessage({ channelId: channels.get(topic), sequence: 0, logTime: at, publishTime: at, data });
  }
  await writer.end();
  const whole = Buffer.concat(parts);
  // The file ends as if a power failure had cut it off.
  return whole.subarray(0, whole.length - cut);
}

/** An LZ4 frame whose blocks consist of literals and of runs, encoded as copies of their first byte. */
export function lz4Frame(data) {
  const out = [0x04, 0x22, 0x4d, 0x18, 0x60, 0x70, 0x73];
  const length = (value) =>
    value < 15 ? [] : [...Array(Math.floor((value - 15) / 255)).fill(255), (value - 15) % 255];
  for (let from = 0; from < data.length; from += 2 ** 22) {
    const block = [];
    const part = data.subarray(from, from + 2 ** 22);
    let [anchor, at] = [0, 0];
    const literals = (until, run) => {
      const count = until - anchor;
      block.push((Math.min(15, count) << 4) | (run ? Math.min(15, run - 4) : 0), ...length(count));
      for (let i = anchor; i < until; i++) block.push(part[i]);
      if (run) block.push(1, 0, ...length(run - 4));
    };
    while (at < part.length - 16) {
      let run = 1;
      while (at + run < part.length - 16 && part[at + run] === part[at]) run++;
      if (run > 8) {
        literals(at + 1, run - 1);
        anchor = at + run;
      }
      at += run;
    }
    literals(part.length);
    out.push(...[0, 8, 16, 24].map((shift) => (block.length >>> shift) & 255));
    for (const byte of block) out.push(byte);
  }
  return Uint8Array.from([...out, 0, 0, 0, 0]);
}

/** A Zstandard frame with uncompressed blocks. */
export function zstdFrame(data) {
  const parts = [
    Uint8Array.of(0x28, 0xb5, 0x2f, 0xfd, 0xa0, ...[0, 8, 16, 24].map((shift) => (data.length >>> shift) & 255)),
  ];
  const most = 2 ** 17;
  for (let from = 0; from < data.length; from += most) {
    const part = data.subarray(from, from + most);
    const head = (part.length << 3) | (from + most >= data.length ? 1 : 0);
    parts.push(Uint8Array.of(head & 255, (head >> 8) & 255, head >> 16), part);
  }
  return new Uint8Array(Buffer.concat(parts));
}

export const FRAMES = { colour: "camera_color_optical_frame", depth: "camera_depth_optical_frame" };
const IDENTITY = { rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: [0, 0, 0] };

/** The messages of a depth camera's driver for a sequence of frames: pictures, intrinsics, transforms. */
export function driver(frames, pose, { start = 1_700_000_000, every = 0.5, late = 0.004, compress = false } = {}) {
  const [first] = frames;
  const messages = [
    {
      topic: "/tf_static",
      type: "tf2_msgs/TFMessage",
      time: start,
      message: {
        transforms: [
          transform("camera_link", FRAMES.colour, IDENTITY),
          // The transforms lead from the depth camera through the rig's frame to the colour camera's frame.
          transform("camera_link", FRAMES.depth, pose),
        ],
      },
    },
  ];
  const add = (topic, type, time, message) => messages.push({ topic, type, time, message });
  frames.forEach(({ image, depth }, index) => {
    const time = start + 0.1 + every * index;
    const other = time + late;
    add(
      "/camera/color/camera_info",
      "sensor_msgs/CameraInfo",
      time,
      infoMessage(first.image.camera, image, time, FRAMES.colour),
    );
    add(
      "/camera/depth/camera_info",
      "sensor_msgs/CameraInfo",
      time,
      infoMessage(first.depth.camera, depth, time, FRAMES.depth),
    );
    if (compress) {
      add(
        "/camera/color/image_raw/compressed",
        "sensor_msgs/CompressedImage",
        time,
        jpegMessage(image, time, FRAMES.colour),
      );
      add(
        "/camera/depth/image_raw/compressedDepth",
        "sensor_msgs/CompressedImage",
        other,
        compressedDepthMessage(depth, other, FRAMES.depth),
      );
    } else {
      add("/camera/color/image_raw", "sensor_msgs/Image", time, imageMessage(image, time, FRAMES.colour));
      add("/camera/depth/image_raw", "sensor_msgs/Image", other, depthMessage(depth, other, FRAMES.depth));
    }
    add("/chatter", "std_msgs/String", other, { data: `frame ${index}` });
  });
  return messages;
}

/** An EBML element: its id, its size in eight bytes (all ones if unknown), and its content. */
function element(id, content, isOpen = false) {
  const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content;
  const head = [];
  for (let rest = id; rest > 0; rest = Math.floor(rest / 256)) head.unshift(rest % 256);
  const size = isOpen
    ? Array(7).fill(255)
    : [6, 5, 4, 3, 2, 1, 0].map((place) => Math.floor(bytes.length / 256 ** place) % 256);
  return Buffer.concat([Uint8Array.from([...head, 1, ...size]), bytes]);
}
const whole = (value, width = 4) =>
  Uint8Array.from({ length: width }, (_, at) => Math.floor(value / 256 ** (width - 1 - at)) % 256);

/** A track as k4arecorder writes it: with a Windows codec, named in its header. */
function videoTrack(number, name, code, { width, height }) {
  const header = new Uint8Array(40);
  header.set(new TextEncoder().encode(code), 16);
  const video = element(0xe0, Buffer.concat([element(0xb0, whole(width)), element(0xba, whole(height))]));
  const parts = [
    element(0xd7, whole(number, 1)),
    element(0x536e, name),
    element(0x86, "V_MS/VFW/FOURCC"),
    element(0x63a2, header),
    video,
  ];
  return element(0xae, Buffer.concat(parts));
}

/** A Matroska file with an Azure Kinect's tracks and calibration; blocks single or in groups, clusters of known or unknown size. */
export function matroska(frames, calibration, { groups = false, isOpen = false } = {}) {
  const [{ image, depth }] = frames;
  const tracks = [
    videoTrack(1, "COLOR", "MJPG", image),
    videoTrack(2, "DEPTH", "b16g", depth),
    videoTrack(3, "IR", "b16g", depth),
  ];
  const file = [element(0x466e, "calibration.json"), element(0x465c, calibration)];
  const block = (track, late, data) => {
    const content = Buffer.concat([Uint8Array.of(0x80 | track, late >> 8, late & 255, 0), data]);
    return groups ? element(0xa0, element(0xa1, content)) : element(0xa3, content);
  };
  const clusters = frames.map(({ image, depth }, index) => {
    const high = Uint8Array.from({ length: 2 * depth.data.length }, (_, at) =>
      at % 2 === 0 ? depth.data[at >> 1] >> 8 : depth.data[at >> 1] & 255,
    );
    const blocks = [block(1, 0, jpegMessage(image, 0, "").data), block(2, 1, high), block(3, 1, high)];
    return element(0x1f43b675, Buffer.concat([element(0xe7, whole(500 * index)), ...blocks]), isOpen);
  });
  const segment = [
    element(0x1549a966, element(0x2ad7b1, whole(1_000_000))),
    element(0x1654ae6b, Buffer.concat(tracks)),
    element(0x1941a469, element(0x61a7, Buffer.concat(file))),
    ...clusters,
  ];
  return Buffer.concat([
    element(0x1a45dfa3, element(0x4282, "matroska")),
    element(0x18538067, Buffer.concat(segment), isOpen),
  ]);
}
